// Stars on the frame. In: a point-spread function, and the splats of a layer of stars. Out: screen splats of
// fixed size in output pixels whose light is the stars', together with those of other layers.
#pragma once

#include <vector>

#include "render/footprint.h"
#include "render/project.h"

namespace astrosplat {

/// The dots that a star's image is made of, the core first; `footprint` is that of a gaussian falloff.
///
/// Moffat's (1 + r^2)^-b and a spike's e^-|x| are mixtures of gaussians, by the gamma distribution of their
/// inverse variance and the exponential one of their variance; here in steps of a factor of two. The core's
/// gaussian and the pixel filter's together have the deviation core_px, as far as the filter is not wider.
std::vector<StarDot> star_dots(const StarPsf& psf, const FootprintTable& footprint);

/// As project() does. A star at r from the layer's origin and c from the eye has (r / c)^2 of its colour as
/// light over all pixels, c no less than near and near_fade; at infinity just its colour. Wings and spikes
/// whose peak is below 2^-14 of scene light are left out with a soft edge, their light goes to the core. Onto
/// the sphere cores and wings are round there; spikes point and are as long as on a flat frame, in px of this
/// one, at the star.
void project_stars(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
                   Buffer<ScreenSplat>& out, Buffer<Shape>& shapes);

/// Largest light of a pixel of the layer's stars.
float largest_star_light(const LayerProjection& layer);

}  // namespace astrosplat
