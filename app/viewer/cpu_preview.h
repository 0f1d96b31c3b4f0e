// The frame in motion, drawn by the engine's own compositor: for machines whose OpenGL is drawn by the
// processor anyway, where it is the faster of the two. Same shares and same compensation as GlPreview.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gl/preview.h"
#include "render/render.h"

namespace astrosplat {

/// A layer as it was drawn last.
struct KeptLayer {
    std::shared_ptr<const SplatSet> set;  // what `rows` was cut from
    SplatSet rows;                        // its first ones
    std::optional<Shading> shading;       // what `shaded` was made with
    ShadedSplats shaded;
};

class CpuPreview {
  public:
    /// Renders into an image that stays valid until the next call. Splats are not split up by level of
    /// detail. Throws as GlPreview::draw does.
    const Image& draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                      const Environment* environment, int width, int height, float pixel_filter);
    /// Splats of the last draw, before the look dropped any.
    std::int64_t shown() const { return shown_; }
    /// Of each layer of the last draw: the share of the shown splats that the look kept, 0..1.
    std::vector<double> kept() const;

  private:
    KeptLayer& layer_at(std::size_t index, const std::shared_ptr<const SplatSet>& set);

    std::vector<KeptLayer> layers_;
    RenderCache cache_;
    Image frame_, backdrop_;
    std::int64_t shown_ = 0;
};

}  // namespace astrosplat
