// Gaussians of all file formats. In: numbers as a file stores them, and the nodes that place them. Out: room
// for a set, and rows as the program draws them.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Columns of a set of Gaussians; harmonics where they are `directional`.
SplatColumns gaussian_set_columns(bool directional);

/// Room for `count` Gaussians, with harmonics of 0 where they are `directional`; distance is 0, id the row.
/// Throws InputError where the memory of `what` is not there.
SplatSet room_for_gaussians(std::int64_t count, bool directional, const std::string& what);

/// How a node changes what it holds.
struct GaussianPlacement {
    double scale = 1.0;
    glm::dmat3 turn{1.0};  // orthonormal columns; may mirror
    glm::dvec3 place{0.0};
    bool turns = false;
};

/// Empty where the matrix scales axes differently: a Gaussian and its harmonics would become others.
std::optional<GaussianPlacement> gaussian_placement(const glm::dmat4& world);

/// Moves rows [begin, end), whose numbers are a file's: positions, scales (not their logarithms), rotations
/// and harmonics.
void place_gaussians(SplatSet& set, std::size_t begin, std::size_t end, const GaussianPlacement& placement);

/// Whether any of the parts of a file has harmonics beyond degree 0.
template <class Part>
bool is_directional(const std::vector<Part>& parts) {
    return std::ranges::any_of(parts, [](const Part& part) { return part.degree > 0; });
}

/// How a file stores its numbers.
struct GaussianNumbers {
    bool trained = false;   // scales as logarithms, opacities as logits: what training works with
    bool display = true;    // harmonics give display values (sRGB); else linear light
    bool filtered = false;  // trained, and radius is Mip-Splatting's filter_3D, which widens each
};

/// `set` has position, alpha, scale, rotation of any length, id, distance, and harmonics or, where the file
/// has none but degree 0, its coefficients in color. Turns stored numbers into those that a SplatSet has, and
/// makes radius and color. Rows with numbers that are not finite, or without a rotation, are left out and
/// counted in a warning; opacities are clamped to 0..1.
SplatSet finish_gaussians(SplatSet set, const GaussianNumbers& numbers, const fs::path& file);

/// A set of parts that have a count and a degree of their harmonics: read(part, first, set) fills the rows
/// from `first` on, with the numbers that finish_gaussians wants. Throws InputError, Cancelled.
template <class Part, class Read>
SplatSet read_gaussian_parts(const std::vector<Part>& parts, const GaussianNumbers& numbers,
                             const fs::path& file, const Progress& progress, const Read& read) {
    std::int64_t count = 0;
    for (const Part& part : parts) count += part.count;
    SplatSet set = room_for_gaussians(count, is_directional(parts), "splats of " + file.string());
    std::size_t first = 0;
    for (const Part& part : parts) {
        progress.check();
        read(part, first, set);
        first += std::size_t(part.count);
    }
    return finish_gaussians(std::move(set), numbers, file);
}

/// Radius of a Gaussian, as SplatSet::scale says.
float gaussian_radius(const glm::vec3& scale);

}  // namespace astrosplat
