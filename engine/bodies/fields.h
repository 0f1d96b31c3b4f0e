// How thick a layer is and where its middle lies, as smooth fields over a picture (DEPTH 4). In: the
// picture's light without its stars. Out: one-channel images, in texels, halved as often as their smoothness
// allows.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// How often the fields of a picture are halved: twice at a width of 1920, more for larger ones.
int field_halvings(const Image& brightest);

/// The scale height at every pixel of a layer whose typical one is `height`: .55 to 2.2 times it, more where
/// the picture is bright over a wide area: H min(.55 + 1.65 (G_40 * m / its 99.5 %)^5, 2.2), rising by at
/// most .3 a px, so that a bulge is no taller than it is wide. (DEPTH 4 has 1.6 and the power 1.5, which made
/// a slab of whole inner disks and a tower of a small bulge.)
Image thickness_field(const Image& brightest, double height);

/// How far a body stands out, 0 to `depth`: the root of the picture's brightness over wide areas, 0 on empty
/// sky. Nowhere steeper than `steepest`; what is steeper looks like drapery.
Image relief_field(const Image& brightest, double depth, double steepest);

/// Lowers what rises above a neighbour by more than `steepest` a px.
void limit_slope(Image& image, double steepest);

}  // namespace astrosplat
