// The fold: a tile's splats, sorted near to far, into its pixels (DESIGN 7). Each pixel is one left fold in
// total order with a transmittance per channel; vector code through Highway, the same bits on every
// instruction set.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/buffer.h"
#include "core/image.h"
#include "core/progress.h"
#include "render/footprint.h"
#include "render/layer_render.h"
#include "render/screen_splat.h"

namespace astrosplat {

/// How the splats of a blend group go together; the simpler folds give the bits of the general one with less
/// work.
enum class FoldKind {
    over,     // all layers over: one transmittance for all channels
    add,      // all layers add: nothing hides anything
    general,  // any mix of over, add, screen, hybrid and holdout
    lighten,  // the brightest splat per channel; alpha as over
};

/// What the fold needs to know of a layer.
struct FoldLayer {
    const FootprintTable* footprints = nullptr;
    Blend blend = Blend::over;
    bool holdout = false;
};

struct FoldSettings {
    FoldKind kind = FoldKind::general;
    float stop = 0.0f;  // a pixel takes nothing more once all its transmittances are below
    bool aovs = false;  // also depth, coverage, count and each layer's light; kinds general and lighten only
    float focal_px = 1.0f, center_x_px = 0.0f, center_y_px = 0.0f;  // depth of a splat from its distance
    bool orthographic = false;
};

/// One blend group's result over one tile, plane by plane. Rows are padded so that vectors may run over their
/// end.
struct TilePlanes {
    static constexpr int widest_px = 128;     // largest tile
    static constexpr int widest_vector = 16;  // floats
    std::int64_t x0 = 0, y0 = 0;              // px of the whole picture
    int width = 0, height = 0;                // px in use
    int stride = 0;                           // floats between rows
    Buffer<float> color[3];                   // light towards the eye
    Buffer<float> alpha;
    Buffer<float> transmittance[4];  // r, g, b, alpha; FoldKind::over uses the first alone, add none
    Buffer<float> held;              // alpha taken away by holdouts
    Buffer<float> depth_sum;         // sum of alpha shares times depth, scene units
    Buffer<float> uncovered;         // product of 1 - weight
    Buffer<float> count;
    std::vector<Buffer<float>> layer_light;  // 4 planes a layer: r, g, b, alpha

    /// Clears to "nothing yet" for a tile; `layer_count` layers' light is kept when settings.aovs.
    void reset(const Region& tile, int tile_px, const FoldSettings& settings, std::size_t layer_count);
    std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * stride + x); }
};

/// Sorts near to far: radix sort on depth, ties by in_front_of.
class SplatSorter {
  public:
    void sort(std::vector<ScreenSplat>& splats, const Progress& progress);

  private:
    std::vector<std::uint64_t> keys_, other_;
    std::vector<ScreenSplat> sorted_;
};

/// Folds `splats` (near to far) into the planes.
void fold(std::span<const ScreenSplat> splats, std::span<const FoldLayer> layers,
          const FoldSettings& settings, const Progress& progress, TilePlanes& planes);

}  // namespace astrosplat
