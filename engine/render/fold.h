// The fold: a tile's splats, near to far, into its pixels (DESIGN 7). Each pixel is one left fold in
// total order with a transmittance per channel; vector code through Highway, the same bits on every
// instruction set.
//
// A tile is made of cells of 32 x 32 px, a cell of 8 x 8 blocks of 4 x 4 px. Splats are prepared 128 at a
// time; then each block folds those of them that touch it, with its pixels in registers.
#pragma once

#include "camera/lens.h"
#include "core/buffer.h"
#include "core/image.h"
#include "core/progress.h"
#include "render/footprint.h"
#include "render/frame.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// How the splats of a blend group go together; the simpler folds give the bits of the general one with
/// less work.
enum class FoldKind {
    over,     // all layers over: one transmittance for all channels
    add,      // all layers add: nothing hides anything
    general,  // any mix of over, add, screen, hybrid, absorb and holdout
    lighten,  // the brightest splat per channel; alpha as over
};

/// A layer as the fold needs it.
struct FoldLayer {
    const FootprintTable* footprints = nullptr;
    Blend blend = Blend::over;
    bool holdout = false;
    glm::vec3 absorb{1.0f};  // exponents of Blend::absorb
    bool absorbs = false;    // as in RenderLayer
};

struct FoldSettings {
    FoldKind kind = FoldKind::general;
    float stop = 0.0f;  // a pixel takes nothing more once all its transmittances are below
    bool aovs = false;  // also depth, coverage, count and each layer's light; kinds general and lighten only
    Lens lens{};
};

/// One blend group's result over one tile, plane by plane; a plane holds cell after cell, block after block,
/// so that a block's 16 pixels are one cache line.
struct TilePlanes {
    static constexpr int widest_px = 128;  // largest tile
    static constexpr int block_px = 4, block_pixels = block_px * block_px;
    static constexpr int cell_blocks = 8, cell_px = cell_blocks * block_px, cell_pixels = cell_px * cell_px;
    std::int64_t x0 = 0, y0 = 0;  // px of the whole frame
    int width = 0, height = 0;    // px in use
    int cell_columns = 0, cell_rows = 0;
    Buffer<float> color[3];  // light towards the eye
    Buffer<float> alpha;
    Buffer<float> transmittance[4];  // r, g, b, alpha; FoldKind::over uses the first alone, add none
    Buffer<float> held;              // alpha taken away by holdouts
    Buffer<float> depth_sum;         // sum of alpha shares times depth, scene units
    Buffer<float> uncovered;         // product of 1 - weight
    Buffer<float> count;
    std::vector<Buffer<float>> layer_light;  // 4 planes a layer: r, g, b, alpha
    Buffer<float> toward[3];                 // onto the sphere: what set_directions sets

    /// Clears to "nothing yet" for a tile; `layer_count` layers' light is kept when settings.aovs.
    void reset(const Region& tile, const FoldSettings& settings, std::size_t layer_count);
    /// Place of a pixel in every plane, x, y from the tile's corner.
    std::size_t at(int x, int y) const {
        const int cell = y / cell_px * cell_columns + x / cell_px;
        const int block = y % cell_px / block_px * cell_blocks + x % cell_px / block_px;
        const int pixel = y % block_px * block_px + x % block_px;
        return std::size_t(cell * cell_pixels + block * block_pixels + pixel);
    }
};

/// The splats and pixels to be folded.
struct FoldJob {
    std::span<const ScreenSplat* const> splats;  // near to far
    std::span<const FoldLayer> layers;
    const FoldSettings& settings;
    const Progress& progress;
    std::span<const Shape> shapes = {};  // of splats that are not round; empty: all are
};

/// Folds the splats into the planes. Throws Cancelled.
void fold(const FoldJob& job, TilePlanes& planes);

}  // namespace astrosplat
