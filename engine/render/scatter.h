// Scatter: screen splats into the picture's tiles, in one pass over the shaded splats and one write of each
// record.
//
// Chunks of splats are projected in cache, sorted there by bin and appended to a store of slabs. A bin is a
// square of tiles of one blend group: small splats go to bins of one tile, larger ones to bins of 2x2, 4x4,
// ... tiles, so that no splat is written more than nine times however large it is. A tile later collects its
// records from the bins above it.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/progress.h"
#include "render/project.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// Memory for records, kept between frames.
class SplatStore {
  public:
    /// Space for `count` records in one piece. Thread-safe.
    ScreenSplat* take(std::int64_t count);
    /// Forgets all records but keeps the memory.
    void clear();
    /// Gives the memory back when more than `bytes` are held.
    void shrink(std::int64_t bytes);
    std::int64_t bytes() const;

  private:
    std::mutex mutex_;
    std::vector<Buffer<ScreenSplat>> slabs_;
    std::size_t slab_ = 0;     // being filled
    std::int64_t filled_ = 0;  // records of it in use
};

/// The tiles of the part of the picture being rendered, px of the whole picture.
struct TileGrid {
    std::int64_t x0 = 0, y0 = 0, width = 0, height = 0;  // px
    int tile_px = 32;
    bool first_band = true, last_band = true;  // of the bands that a memory limit asks for
    std::int64_t columns() const { return (width + tile_px - 1) / tile_px; }
    std::int64_t rows() const { return (height + tile_px - 1) / tile_px; }
    std::int64_t tiles() const { return columns() * rows(); }
};

/// All records of one frame (or band), by bin.
class TileBins {
  public:
    TileBins(const TileGrid& grid, int groups);

    /// Projects and scatters every layer; group_of_layer[i] is the blend group of layer i.
    void scatter(std::span<const LayerProjection> layers, std::span<const int> group_of_layer,
                 SplatStore& store, const Progress& progress);

    /// Records of a tile and group whose square of support touches the tile, in no meaningful order.
    void collect(std::int64_t tile, int group, const Progress& progress, std::vector<ScreenSplat>& out) const;

    const TileGrid& grid() const { return grid_; }
    std::int64_t records() const;    // written, a splat once per bin it touches
    std::int64_t instances() const;  // splats (children counted one by one), each in one band only
    double footprint_px() const;     // sum of their footprints' areas, square px

  private:
    struct Level {
        std::int64_t first_bin = 0, columns = 0, rows = 0;
    };
    struct Segment {  // one chunk's records, sorted by bin
        const ScreenSplat* records = nullptr;
        std::int64_t first_bin = 0;
        std::vector<std::uint32_t> offsets;  // of first_bin, first_bin + 1, ...; one more at the end
        std::int64_t instances = 0;
        double footprint_px = 0.0;
    };
    struct BinRect {
        std::int64_t first_bin;                // of the level
        std::int32_t columns, x0, y0, x1, y1;  // inclusive columns and rows
    };
    struct Scratch {  // of one worker
        std::vector<ScreenSplat> splats;
        std::vector<BinRect> rects;
        std::vector<std::uint32_t> cursor;
    };
    BinRect bins_of(const ScreenSplat& splat, float support_px, int group) const;
    void add_segment(Scratch& scratch, const LayerProjection& layer, int group, SplatStore& store,
                     std::vector<Segment>& out) const;

    TileGrid grid_;
    int groups_ = 1;
    std::int64_t bins_per_group_ = 0;
    std::vector<Level> levels_;
    std::vector<std::vector<Segment>> segments_;  // by chunk
};

/// Screen splats that the layers will take, estimated from every 64th block.
std::int64_t estimate_records(std::span<const LayerProjection> layers, const TileGrid& grid,
                              const Progress& progress);

}  // namespace astrosplat
