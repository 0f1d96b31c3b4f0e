// The splats that are about to be folded: up to 128 at a time, in total order, value by value.
#pragma once

#include "core/buffer.h"
#include "render/bin_rects.h"
#include "render/fold.h"
#include "render/footprint.h"

namespace astrosplat {

/// A set of the splats of a batch.
struct SplatBits {
    static constexpr int size = 128;
    std::uint64_t low = 0, high = 0;
    bool any() const { return (low | high) != 0; }
    SplatBits& operator|=(const SplatBits& other) {
        low |= other.low;
        high |= other.high;
        return *this;
    }
    /// Takes out the first; `size` when there is none. Without branches, which would be unpredictable.
    int take_first() {
        const std::uint64_t in_high = std::uint64_t{0} - std::uint64_t{low == 0};  // all bits or none
        const std::uint64_t word = low | (high & in_high), rest = word & (word - 1);
        low = rest & ~in_high;
        high = (rest & in_high) | (high & ~in_high);
        return std::countr_zero(word) + int(in_high & 64);
    }
};

/// How a splat's opacity s hides what lies behind it, under the general fold.
enum class Hiding : std::uint8_t {
    plain,         // s, of all channels
    proportional,  // s times the occlusion colour
    clamped,       // that, at most 1 a channel: a screen splat brighter than white
    absorbing,     // 1 - (1 - s)^occlusion
};

struct SplatBatch {
    static constexpr int size = SplatBits::size;
    static constexpr int none = size;         // a place after them for a splat without light
    static constexpr int places = size + 16;  // rows of arrays stay aligned
    static constexpr int blocks = TilePlanes::cell_blocks * TilePlanes::cell_blocks;
    int count = 0;
    bool is_faint = false;  // no splat's opacity comes near 1: s needs no clamping
    // Of the whole frame; from `count` to the next whole vector they touch nothing.
    const float* x_px = nullptr;
    const float* y_px = nullptr;
    const float* reach_px = nullptr;
    const std::uint32_t* index = nullptr;   // in the job's splats
    const float* toward[3] = {};            // onto the sphere: directions, of length focal_px
    alignas(64) SplatBits touches[blocks];  // splats that may have weight in the block
    std::uint16_t layer[places];
    std::uint8_t linear_in_distance[places];  // as in FootprintTable
    Hiding hiding[places];

    // The weight, as in Footprint.
    alignas(64) float cubic[places][4][FootprintNode::segments];  // [splat][power][segment]
    alignas(64) float lo[places];
    alignas(64) float scale[places];
    alignas(64) float edge_gain[places];
    alignas(64) float weight_gain[places];  // amplitude alone, for coverage
    // Outline::shaped: what offsets are mapped by, as in ShapedFootprint.
    alignas(64) float map_xx[places], map_xy[places], map_yy[places];
    // Outline::sphere_shaped: which are not round, and what their offsets are mapped by,
    // as in SphereFootprint.
    std::uint8_t shaped[places];
    alignas(64) float row[2][3][places];
    float per_square = 0.0f;  // 1 / (2 focal_px)^2

    alignas(64) float opacity[places];       // times the footprint's amplitude
    alignas(64) float color[3][places];      // 0 for holdouts
    alignas(64) float occlusion[4][places];  // o per channel; [3] for alpha
    alignas(64) float shows[places];         // 0 for holdouts
    alignas(64) float depth[places];         // scene units along the view axis

    // Inputs of the weights, while they are prepared.
    alignas(64) float radius_px[places];
    alignas(64) std::int32_t node[places];    // of the footprint table: the one before the radius
    alignas(64) float node_share[places];     // of the next one
    alignas(64) float alpha[places];          // opacity as the splat has it
    alignas(64) float moments[3][places][4];  // of FootprintMoments, four by four
};

/// The footprints of a tile's splats; each kind takes those before it, with the same bits.
enum class Outline {
    soft,           // round
    flat,           // round, some flat inside
    shaped,         // some not round
    sphere,         // round on the sphere, not on the frame
    sphere_shaped,  // some not round there, either
};
constexpr bool is_onto_sphere(Outline outline) { return outline >= Outline::sphere; }

/// Values that are the same for all layers, if any are.
struct FoldCommon {
    const FootprintTable* footprints = nullptr;  // the one table of all layers, or null
    bool screen = false;                         // all are screens
};

/// Directions, or points of the sphere, value by value.
struct Directions {
    Buffer<float> x, y, z;
    void resize(std::size_t size) {
        x.resize(size);
        y.resize(size);
        z.resize(size);
    }
};

/// Those of a tile's splats that may touch a cell.
struct CellSplats {
    Discs discs;
    Directions toward;            // onto the sphere only
    Buffer<std::uint32_t> index;  // in the job's splats
    std::size_t count = 0;
    void resize(std::size_t size) {
        discs.resize(size);
        index.resize(size);
    }
    /// Forgets those before `begin`.
    void keep_from(std::size_t begin) {
        const auto keep = [&](auto& values) {
            std::copy(values.data() + begin, values.data() + count, values.data());
        };
        keep(discs.x_px);
        keep(discs.y_px);
        keep(discs.reach_px);
        if (!toward.x.empty()) keep(toward.x), keep(toward.y), keep(toward.z);
        keep(index);
        count -= begin;
    }
};

/// Memory of one thread that folds.
struct FoldScratch {
    Discs discs;  // of the tile, in order
    Directions toward;
    CellSplats found;
    SplatBatch batch{};
};

}  // namespace astrosplat
