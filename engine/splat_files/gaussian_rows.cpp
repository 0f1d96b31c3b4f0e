#include "splat_files/gaussian_rows.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/memory.h"
#include "core/quaternion.h"
#include "splats/harmonics.h"

namespace astrosplat {

SplatSet room_for_gaussians(std::int64_t count, bool directional, const std::string& what) {
    claim_memory(count * static_cast<std::int64_t>(bytes_per_splat([&](SplatColumn column) {
                     return !is_optional(column) || column == SplatColumn::radius ||
                            column == SplatColumn::scale || column == SplatColumn::rotation ||
                            (directional && column == SplatColumn::harmonics);
                 })),
                 what);
    SplatSet set;
    const auto size = static_cast<std::size_t>(count);
    set.position.resize(size);
    set.alpha.resize(size);
    set.distance.assign(size, 0.0f);
    set.id.resize(size);
    for (std::size_t i = 0; i < size; ++i) set.id[i] = i;
    set.color.resize(size);
    set.scale.resize(size);
    set.rotation.resize(size);
    if (directional) set.harmonics.assign(size, Harmonics{});
    return set;
}

std::optional<GaussianPlacement> gaussian_placement(const glm::dmat4& world) {
    constexpr double tolerance = 1e-3;
    const glm::dmat3 m(world);
    GaussianPlacement p;
    p.place = glm::dvec3(world[3]);
    p.scale = std::cbrt(std::fabs(glm::determinant(m)));
    p.turn = m / p.scale;
    const glm::dmat3 square = glm::transpose(p.turn) * p.turn;
    bool alike = p.scale > 0.0 && std::isfinite(p.scale);
    for (int i = 0; i < 9; ++i)
        alike = alike && std::fabs(square[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)) < tolerance;
    if (!alike) return std::nullopt;
    for (int i = 0; i < 9; ++i)
        p.turns = p.turns || std::fabs(p.turn[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)) > 1e-9;
    return p;
}

void place_gaussians(SplatSet& set, std::size_t begin, std::size_t end, const GaussianPlacement& placement) {
    // A mirrored Gaussian is the one that the opposite matrix turns.
    const glm::dmat3 proper = glm::determinant(placement.turn) < 0.0 ? -placement.turn : placement.turn;
    const glm::dvec4 by = quaternion_of_matrix(proper);
    for (std::size_t i = begin; i < end; ++i) {
        const glm::dvec3 position(set.position[i]), scale(set.scale[i]);
        set.position[i] = glm::vec3(placement.scale * (placement.turn * position) + placement.place);
        set.scale[i] = glm::vec3(placement.scale * scale);
        if (placement.turns) set.rotation[i] = glm::vec4(quaternion_product(by, set.rotation[i]));
    }
    if (!placement.turns || set.harmonics.empty()) return;
    const HarmonicsTurn turn = harmonics_turn(placement.turn);
    for (std::size_t i = begin; i < end; ++i) set.harmonics[i] = turned(set.harmonics[i], turn);
}

}  // namespace astrosplat
