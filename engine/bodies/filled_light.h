// Light of a shell that is on neither of its walls: that of compact bright cores inside, and that of the dark
// sky around. In: the picture's light without its stars. Out: fields like those of fields.h, of how much of
// each column's light that is and how deep it reaches.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// On the walls a core would be seen twice, with a column between, and the sky would be a sheet with the
/// picture's own straight edges.
struct FilledLight {
    Image core_share, sky_share;  // 0..1 of a column's light
    Image core_reach;             // texels, half the depth
};

/// A core is what an opening by lines takes away, a fifth of the width long, in the best of twelve
/// directions: filaments survive it. It is as deep as it is wide. The sky is what lies outside of the
/// silhouette of surfaces.h.
FilledLight find_filled_light(const Image& brightest);

}  // namespace astrosplat
