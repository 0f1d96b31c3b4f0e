// The frame in motion, drawn by the engine's own compositor: for machines whose OpenGL is drawn by the
// processor anyway, where it is the faster of the two. The same splats as GlPreview draws.
#pragma once

#include <vector>

#include "gl/preview.h"
#include "render/render.h"

namespace astrosplat {

class CpuPreview {
  public:
    /// Renders the layers' splats into an image that stays valid until the next call. Splats are not split up
    /// by level of detail. Throws Cancelled.
    const Image& draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                      const Environment* environment, int width, int height, float pixel_filter,
                      const Progress& progress = {});

  private:
    RenderCache cache_;
    Image frame_, backdrop_;
};

}  // namespace astrosplat
