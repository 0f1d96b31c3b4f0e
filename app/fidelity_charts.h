// The drawings of a fidelity report, to be put into a page: images and small vector graphics. In:
// images of linear light and ratios. Out: HTML text; colours of lines and letters are the page's
// (fidelity_page.html).
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "fidelity/front.h"

namespace astrosplat {

/// "data:image/png;base64,...": the image as displayed.
std::string image_url(const Image& linear);

/// The same of displayed value a minus b, mean of the channels: orange where a is brighter, blue where it
/// is darker, full at a tenth of white.
std::string difference_url(const Image& a, const Image& b);

/// The grid of cells, each orange or blue by how much more or less light it has, full at a tenth; hatched
/// where the reference is dark. `aspect`: the picture's width over its height.
std::string cell_map(const FluxRatios& flux, double aspect);

/// Power ratio over scale, one line for each front view.
std::string power_chart(const std::vector<const FrontFidelity*>& fronts);

}  // namespace astrosplat
