// Which layers are seen at a pixel, for clicks that select one. In: the splats that a preview draws and a
// pixel. Out: how much of what is seen there is due to each layer.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gl/preview.h"

namespace astrosplat {

/// A frame as a preview draws it.
struct PreviewView {
    Camera camera;
    const Environment* environment = nullptr;
    std::int64_t width = 0, height = 0;  // px
    float pixel_filter = 0.5f;           // px
};

/// Of each of the layers, which must have their splats, the light that arrives from it within a pixel of
/// (x, y), or where that is more the light that it keeps from arriving: dust and holdouts are seen by what
/// they hide. 0 outside the frame.
std::vector<float> light_of_layers(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                   std::int64_t x, std::int64_t y);

/// Places of the layers that can be told from black beside the brightest, brightest first.
std::vector<std::size_t> seen_layers(const std::vector<float>& light);

/// The layer that a click selects: the brightest, or `behind` the next one after the selected layer, after
/// the last one the first again. None where nothing is seen.
std::optional<std::size_t> clicked_layer(const std::vector<std::size_t>& seen, std::size_t selected,
                                         bool behind);

}  // namespace astrosplat
