// The picture in motion, drawn by the engine's own compositor: for machines whose OpenGL is drawn by the
// processor anyway, where it is the faster of the two. Same shares and same compensation as GlPreview.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gl/preview.h"
#include "viewer/preview_budget.h"

namespace astrosplat {

class CpuPreview {
  public:
    CpuPreview();
    ~CpuPreview();
    /// Renders into an image that stays valid until the next call. Splats are not split up by level of
    /// detail. Throws as GlPreview::draw does.
    const Image& draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                      const Environment* environment, int width, int height, float pixel_filter);
    /// Splats of the last draw, before the look dropped any.
    std::int64_t shown() const;
    /// Of each layer of the last draw: the share of the shown splats that the look kept, 0..1.
    std::vector<double> kept() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
