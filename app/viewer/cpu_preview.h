// Previews by the engine's own compositor, and the layers at a pixel of them. In: the splats that a preview
// draws. Out: the frame in motion, or the light of each layer at a pixel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gl/preview_layer.h"
#include "render/render.h"

namespace astrosplat {

/// For machines whose OpenGL is drawn by the processor anyway, where it is the faster of the two. The same
/// splats as GlPreview draws.
class CpuPreview {
  public:
    /// Renders the layers' splats into an image that stays valid until the next call. Splats are not split up
    /// by level of detail. Throws Cancelled.
    const Image& draw(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                      const Progress& progress = {});

  private:
    RenderCache cache_;
    Image frame_, backdrop_;
};

/// Of each of the layers, which must have their splats, the light that arrives from it within a pixel of
/// (x, y), or where that is more the light that it keeps from arriving: dust and holdouts are seen by what
/// they hide. 0 outside the frame.
std::vector<float> light_of_layers(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                   std::int64_t x, std::int64_t y);

/// Indices of the layers whose light is more than a fiftieth of the brightest one's, brightest first.
std::vector<std::size_t> seen_layers(const std::vector<float>& light);

/// The layer that a click selects: the brightest, or `behind` the next one after the selected layer, after
/// the last one the first again. None where nothing is seen.
std::optional<std::size_t> clicked_layer(const std::vector<std::size_t>& seen, std::size_t selected,
                                         bool behind);

}  // namespace astrosplat
