// What Gaussians of all file formats have in common. In: their numbers, read. Out: a set as the program draws
// it.
#pragma once

#include <filesystem>

#include "splats/splat_set.h"

namespace astrosplat {

/// How a file stores its numbers.
struct GaussianNumbers {
    bool trained = false;  // scales as logarithms, opacities as logits: what training works with
    bool display = true;   // harmonics give display values (sRGB); else linear light
};

/// `set` has position, alpha, scale, rotation of any length, id, distance, and harmonics or, where the file
/// has none but degree 0, its coefficients in color. Turns stored numbers into those that a SplatSet has, and
/// makes radius and color. Rows with numbers that are not finite, or without a rotation, are left out and
/// counted in a warning; opacities are clamped to 0..1.
SplatSet finish_gaussians(SplatSet set, const GaussianNumbers& numbers, const std::filesystem::path& file);

/// Radius of a Gaussian, as SplatSet::scale says.
float gaussian_radius(const glm::vec3& scale);

}  // namespace astrosplat
