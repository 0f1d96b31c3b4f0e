// How thick a layer is and where its middle lies, as smooth fields over a picture, and the noise that depths
// gather in (DEPTH 4). In: the picture's light without its stars; the size of a band's features. Out: one-
// channel images, in texels, halved as often as their smoothness allows; stacks of octaves for
// depth_kernel.h.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>

#include "bodies/depth_kernel.h"
#include "bodies/placement.h"
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

/// Values for features of 2, 4, 8 ... 128 and 200 texels at a width of 1920; between them linear in the
/// logarithm.
double by_feature(const double (&values)[8], double feature);

/// Gain of the first octave in a disk or between walls, for features of so many texels.
double clump_gain(const Placement& placement, double feature);

/// Octaves from `longest` on by halves, texels, as far down as a feature allows: small things float where
/// their cloud floats. Each has `ratio` times the gain of the one before.
NoiseStack stack(const Placement& placement, double longest, double feature, double first_gain, double ratio);

/// These octaves, in texels at a width of 1920, of a field of their own.
NoiseStack waves(const Placement& placement, std::uint32_t field,
                 std::initializer_list<std::pair<double, double>> wave_and_gain);

}  // namespace astrosplat
