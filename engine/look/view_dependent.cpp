#include "look/view_dependent.h"

#include <cassert>
#include <cmath>

#include "core/color.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/quaternion.h"

namespace astrosplat {
namespace {

constexpr std::int64_t splats_per_chunk = 1 << 14;

/// The rows of the set that the splats are: both are in ascending order of id, and no row is there twice.
Buffer<std::uint32_t> rows_of(const SplatSet& set, const ShadedSplats& shaded) {
    Buffer<std::uint32_t> rows(shaded.id.size());
    std::size_t row = 0;
    for (std::size_t i = 0; i < rows.size(); ++i, ++row) {
        while (set.id[row] != shaded.id[i]) ++row;
        rows[i] = static_cast<std::uint32_t>(row);
    }
    return rows;
}

/// What makes the ball of the radius the ellipsoid of three standard deviations.
glm::mat3 shape_of(const SplatSet& set, std::size_t row) {
    if (!(set.radius[row] > 0.0f)) return glm::mat3(0.0f);
    glm::dmat3 m = matrix_of_quaternion(glm::dvec4(set.rotation[row]));
    for (int k = 0; k < 3; ++k) m[k] *= 3.0 * double(set.scale[row][k]) / double(set.radius[row]);
    return glm::mat3(m);
}

}  // namespace

Buffer<glm::vec3> seen_colors(const SplatSet& set, const SeenFrom& from, const Progress& progress) {
    assert(!set.harmonics.empty());
    claim_memory(set.size() * static_cast<std::int64_t>(sizeof(glm::vec3)), "colours by direction");
    Buffer<glm::vec3> colors(set.harmonics.size());
    parallel_chunks(set.size(), splats_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        for (std::int64_t i = begin; i < end; ++i) {
            glm::dvec3 d = from.along;
            if (d == glm::dvec3(0.0)) {
                d = glm::dvec3(set.position[i]) - from.eye;
                const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
                d = length > 0.0 ? d / length : glm::dvec3(0.0, 0.0, -1.0);
            }
            glm::vec3 color = color_towards(set.harmonics[i], glm::vec3(d));
            if (set.display_harmonics)
                for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(real::srgb_to_linear(color[k]));
            colors[i] = color;
        }
    });
    return colors;
}

void add_shapes(const SplatSet& set, ShadedSplats& shaded) {
    assert(holds_gaussians(set));
    if (shaded.stretch.capacity() < shaded.position.size())
        claim_memory(shaded.size() * static_cast<std::int64_t>(sizeof(glm::mat3)), "shapes of splats");
    shaded.stretch.resize(shaded.position.size());
    if (shaded.size() == set.size()) {
        parallel_each(shaded.stretch.size(), splats_per_chunk,
                      [&](std::size_t i) { shaded.stretch[i] = shape_of(set, i); });
        return;
    }
    const Buffer<std::uint32_t> rows = rows_of(set, shaded);
    parallel_each(rows.size(), splats_per_chunk,
                  [&](std::size_t i) { shaded.stretch[i] = shape_of(set, rows[i]); });
}

void encode_colors(ShadedSplats& shaded) {
    parallel_each(shaded.color.size(), splats_per_chunk, [&](std::size_t i) {
        for (int k = 0; k < 3; ++k)
            shaded.color[i][k] = static_cast<float>(real::linear_to_srgb(shaded.color[i][k]));
    });
    shaded.encoded = true;
}

}  // namespace astrosplat
