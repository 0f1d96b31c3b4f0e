// Scatter: screen splats into the frame's tiles, in one pass over the shaded splats and one write of
// each record.
//
// Splats are projected a few hundred at a time and appended to bins, where each worker fills blocks of its
// own. A bin is a square of tiles of one blend group: small splats go to bins of one tile, larger ones to
// bins of 2x2, 4x4, ... tiles, so that no splat is written more than nine times however large it is. A tile
// later collects the blocks of the bins above it.
#pragma once

#include <mutex>

#include "core/buffer.h"
#include "core/progress.h"
#include "render/bin_rects.h"
#include "render/project.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// Splats by ScreenSplat::depth, from first to last, both included.
struct DepthRange {
    std::uint32_t first = 0, last = 0xffffffffu;

    bool is_all() const { return first == 0 && last == 0xffffffffu; }
    bool holds(std::uint32_t depth) const { return depth >= first && depth <= last; }
    bool meets(const DepthRange& other) const { return first <= other.last && other.first <= last; }
};

/// A block of a layer that may show, and the depths at which its splats and their children lie.
struct VisibleBlock {
    std::size_t layer, block;
    DepthRange depths;
};

/// Of all layers that come by the block, in the files' order. None that leaves a record in `rect` is missing.
std::vector<VisibleBlock> visible_blocks(std::span<const LayerProjection> layers, const ScreenRect& rect);

/// Thrown where records would take more than they may.
struct StoreFull {};

/// Memory for records and their index, kept between frames.
class SplatStore {
  public:
    /// Space for `count` things in one piece, at the start of a cache line. Thread-safe. Throws StoreFull.
    template <class T>
    T* take(std::int64_t count) {
        return reinterpret_cast<T*>(take_bytes(count * std::int64_t(sizeof(T))));
    }
    /// Forgets everything but keeps the memory.
    void clear();
    /// Gives memory back until at most `bytes` are held.
    void shrink(std::int64_t bytes);
    std::int64_t bytes() const;
    /// Bytes that may be in use from now on; 0: any number.
    void limit(std::int64_t bytes) { limit_ = bytes; }
    std::int64_t limit_bytes() const { return limit_; }
    std::int64_t used_bytes() const { return used_; }

  private:
    std::byte* take_bytes(std::int64_t bytes);

    std::mutex mutex_;
    struct alignas(64) CacheLine {
        std::byte bytes[64];
    };

    std::vector<Buffer<CacheLine>> slabs_;  // of lines: a debug build visits every element of a buffer
    std::size_t slab_ = 0;                  // being filled
    std::int64_t filled_ = 0;               // lines of it in use
    std::int64_t used_ = 0, limit_ = 0;     // bytes
};

/// The tiles of the part of the frame being rendered, px of the whole frame.
struct TileGrid {
    std::int64_t x0 = 0, y0 = 0, width = 0, height = 0;  // px
    int tile_px = 32;
    bool first_band = true, last_band = true;  // of the bands that a memory limit asks for
    std::int64_t columns() const { return (width + tile_px - 1) / tile_px; }
    std::int64_t rows() const { return (height + tile_px - 1) / tile_px; }
    std::int64_t tiles() const { return columns() * rows(); }
};

ScreenRect rect_of(const TileGrid& grid);

/// All records of one frame (or band), by bin.
class TileBins {
  public:
    /// `expected_records` decides how much memory is taken at a time.
    TileBins(const TileGrid& grid, int groups, std::int64_t expected_records);

    /// Projects and scatters the splats of every layer that lie in a slab; group_of_layer[i] is the blend
    /// group of layer i, `blocks` those that visible_blocks() found. Throws StoreFull.
    void scatter(std::span<const LayerProjection> layers, std::span<const int> group_of_layer,
                 const DepthRange& slab, std::span<const VisibleBlock> blocks, SplatStore& store,
                 const Progress& progress);

    /// Where the records of a tile and group lie whose square of support touches the tile (or a tile beside
    /// it), in no meaningful order.
    void collect(std::int64_t tile, int group, std::vector<std::span<const ScreenSplat>>& out) const;

    /// Bytes that the bins' blocks may take where they are nearly empty.
    static std::int64_t least_bytes(const TileGrid& grid, int groups);

    /// Of all tiles.
    std::int64_t records() const;

    /// Records of the fullest tiles of all, so many.
    std::int64_t records_of_fullest(int tiles) const;

    /// Of the splats that come by the block.
    const TieIds& tie_ids() const { return tie_ids_; }

    /// Of the records that are not round.
    std::span<const Shape> shapes() const { return shapes_; }

    const TileGrid& grid() const { return grid_; }
    /// Over the splats; children count one by one, each in one band only.
    struct Sums {
        std::int64_t instances = 0;
        double footprint_px = 0.0;  // sum of their footprints' areas, square px
        // Radii whose footprint nodes are needed; empty (least > largest) without records.
        float least_px = std::numeric_limits<float>::max(), largest_px = 0.0f;
    };
    Sums sums() const;

  private:
    struct Entry {  // a splat in a bin
        std::uint32_t bin, splat;
    };
    struct Block {
        ScreenSplat* records;
        std::uint32_t bin;
    };
    struct Chunk {  // of the splats, for one worker
        std::size_t layer;
        std::int64_t begin, end;
        bool is_block = false;  // number `begin` of the layer's
        std::uint32_t slot = 0;
    };
    struct Writer {  // of one worker
        struct Cursor {
            ScreenSplat* next = nullptr;
            ScreenSplat* end = nullptr;  // of the block
        };
        std::vector<Cursor> cursors;  // by bin
        std::vector<Block> blocks;    // in the order in which they were begun
        ScreenSplat* unused = nullptr;
        ScreenSplat* unused_end = nullptr;
        Buffer<ScreenSplat> splats;  // just projected
        Buffer<Shape> shapes;        // of all it projected
        Buffer<std::int64_t> rest;   // rows that are projected a few at a time
        Discs discs;                 // their supports
        Buffer<BinRect> rects;
        Buffer<Entry> entries;
        ShadedSplats block;          // just made
        Buffer<std::uint64_t> ids;   // of those of its splats that left records
        std::uint32_t last_row = 0;  // of these
    };
    std::vector<Chunk> chunks_of(std::span<const LayerProjection> layers, const DepthRange& slab,
                                 std::span<const VisibleBlock> blocks);
    void scatter_chunk(const LayerProjection& layer, int group, const Chunk& chunk, const DepthRange& slab,
                       Sums& sums, SplatStore& store, Writer& writer, const Progress& progress) const;
    static void number_by_ids(const ShadedSplats& block, std::uint32_t slot, Writer& writer);
    void scatter_block(const LayerProjection& layer, int group, const Chunk& chunk, const DepthRange& slab,
                       Sums& sums, SplatStore& store, Writer& writer, const Progress& progress);
    std::int64_t bins() const { return bins_per_group_ * groups_; }
    void sum_up(const Writer& writer, Sums& sums) const;
    void add_shape(const Shape& shape, float y_px, Sums& sum) const;
    std::span<const Entry> list_entries(const LayerProjection& layer, int group, Writer& writer) const;
    void begin_block(std::uint32_t bin, SplatStore& store, Writer& writer) const;
    void write(std::span<const Entry> entries, SplatStore& store, Writer& writer) const;
    void join_shapes(std::span<Writer> writers);
    std::span<ScreenSplat> records_of(const Writer& writer, const Block& block) const;
    void sort_blocks(std::span<const Writer> writers);

    TileGrid grid_;
    int groups_ = 1;
    std::int64_t bins_per_group_ = 0;
    std::int64_t block_records_ = 0;
    std::vector<BinLevel> levels_;
    Buffer<Shape> shapes_;
    TieIds tie_ids_;
    std::vector<Sums> sums_;                            // by chunk
    std::vector<std::span<const ScreenSplat>> blocks_;  // bin by bin
    std::vector<std::size_t> first_block_;              // of each bin; one more at the end
};

}  // namespace astrosplat
