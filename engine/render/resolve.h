// Resolve: a tile's blend groups and the environment, far to near, into the frame's pixels (DESIGN 7,
// isolated layers).
#pragma once

#include "camera/camera.h"
#include "render/environment.h"
#include "render/fold.h"
#include "render/frame.h"

namespace astrosplat {

/// Layers that are folded together: all that are not isolated, or one isolated layer.
struct BlendGroup {
    std::vector<std::size_t> layers;  // indices into the layers given to render()
    FoldKind kind = FoldKind::general;
    bool isolated = false;
    Blend blend = Blend::over;  // of an isolated layer: how it is composited
    bool holdout = false;       // of an isolated layer
    bool absorbs = false;       // some splats absorb, whatever the blend
    bool encoded = false;       // of an isolated layer: its colours are display values
};

/// Groups from far to near: isolated layers before the first merged one, the merged ones, the isolated after
/// it. `aovs`: more than the beauty is asked for, so every group needs the general fold.
std::vector<BlendGroup> make_groups(std::span<const RenderLayer> layers, bool aovs);

/// One pixel while groups are composited.
struct PixelState {
    float color[3] = {0.0f, 0.0f, 0.0f};
    float alpha = 0.0f;
    float held = 0.0f;  // alpha taken away by holdouts, and where the camera shows nothing
    float depth_sum = 0.0f, depth_weight = 0.0f;
    float uncovered = 1.0f, count = 0.0f;
};

/// Collects a tile's pixels, group by group from the farthest, and writes them into the frame.
class TileResolver {
  public:
    TileResolver(std::span<const RenderLayer> layers, const RenderSettings& settings);

    /// Begins a tile with the environment behind it (null: black, transparent).
    void begin(const TilePlanes& tile, const Camera& camera, const Environment* environment);
    /// Composites a group over what is there.
    void composite(const BlendGroup& group, const TilePlanes& planes);
    /// Writes the pixels to their place in the frame's images, whose corner is (x0, y0) px of the
    /// whole frame.
    void write(const TilePlanes& tile, std::int64_t x0, std::int64_t y0, RenderedFrame& frame) const;
    /// begin, composite and write in one for the only group of a frame without AOVs, if it is not isolated,
    /// before nothing or a backdrop.
    void write_alone(const BlendGroup& group, const TilePlanes& tile, std::int64_t x0, std::int64_t y0,
                     RenderedFrame& frame) const;

  private:
    void begin_with_backdrop(const TilePlanes& tile);

    std::size_t layer_count_;
    RenderSettings settings_;
    bool environment_ = false;
    std::vector<PixelState> pixels_;  // rows of the tile's width
    std::vector<float> light_;        // 4 a layer and pixel, when layers are asked for
};

}  // namespace astrosplat
