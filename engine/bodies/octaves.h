// The noise that depths gather in (DEPTH 4): which octaves a band may follow, and how strongly. In: a
// placement and the size of a band's features. Out: stacks of octaves for depth_kernel.h.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>

#include "bodies/depth_kernel.h"
#include "bodies/placement.h"

namespace astrosplat {

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
