// Scatter: screen splats into the picture's tiles, in one pass over the shaded splats and one write of each
// record.
//
// Chunks of splats are projected in cache, sorted there by bin and appended to a store of slabs. A bin is a
// square of tiles of one blend group: small splats go to bins of one tile, larger ones to bins of 2x2, 4x4,
// ... tiles, so that no splat is written more than nine times however large it is. A tile later collects its
// records from the bins above it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/progress.h"
#include "render/project.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// Memory for records and their index, kept between frames.
class SplatStore {
  public:
    /// Space for `count` things in one piece, at the start of a cache line. Thread-safe.
    template <class T>
    T* take(std::int64_t count) {
        return reinterpret_cast<T*>(take_bytes(count * static_cast<std::int64_t>(sizeof(T))));
    }
    /// Forgets everything but keeps the memory.
    void clear();
    /// Gives memory back until at most `bytes` are held.
    void shrink(std::int64_t bytes);
    std::int64_t bytes() const;

  private:
    std::byte* take_bytes(std::int64_t bytes);

    std::mutex mutex_;
    std::vector<Buffer<std::byte>> slabs_;
    std::size_t slab_ = 0;     // being filled
    std::int64_t filled_ = 0;  // bytes of it in use
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

    /// Where the records of a tile and group lie whose square of support touches the tile, in no meaningful
    /// order.
    void collect(std::int64_t tile, int group, const Progress& progress,
                 std::vector<std::span<const ScreenSplat>>& out) const;

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
        std::int64_t first_bin = 0, bins = 0;
        const std::uint32_t* offsets = nullptr;  // of first_bin, first_bin + 1, ...; one more at the end
        std::int64_t instances = 0;
        double footprint_px = 0.0;
    };
    struct BinRect {
        std::uint32_t first_bin;  // at x0, y0
        std::uint32_t columns;    // of the level
        std::uint32_t wide, high;
    };
    struct Entry {  // a splat in a bin
        std::uint32_t bin, splat;
    };
    struct Scratch {  // of one worker
        std::vector<ScreenSplat> splats;
        Buffer<Entry> entries;
        std::vector<std::uint32_t> cursor;
    };
    BinRect bins_of(const ScreenSplat& splat, float support_px, int group) const;
    std::int64_t list_entries(Scratch& scratch, const LayerProjection& layer, int group,
                              Segment& segment) const;
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
