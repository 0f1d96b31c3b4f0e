// The positions of a lattice one by one, as DESIGN 4 says: what place_block is compared with.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "core/shared_maths.h"
#include "generate/lattice.h"

namespace astrosplat {

/// Position of lattice id before jitter; corners come first, then centres.
inline glm::dvec3 lattice_position(const Lattice& lattice, std::uint64_t id) {
    const auto corners = static_cast<std::uint64_t>(lattice.corners());
    const bool centre = id >= corners;
    const std::uint64_t index = centre ? id - corners : id;
    const auto nx = static_cast<std::uint64_t>(lattice.n.x + (centre ? 0 : 1));
    const auto ny = static_cast<std::uint64_t>(lattice.n.y + (centre ? 0 : 1));
    const double half = centre ? 0.5 : 0.0;
    return {lattice_coordinate(lattice, 0, static_cast<double>(index % nx) + half),
            lattice_coordinate(lattice, 1, static_cast<double>(index / nx % ny) + half),
            lattice_coordinate(lattice, 2, static_cast<double>(index / nx / ny) + half)};
}

/// Displacement of a position by jitter: half_range * uniform[-1, 1) per axis, hashed from (seed, id).
inline glm::dvec3 jitter_offset(std::uint64_t id, std::uint32_t seed, const glm::dvec3& half_range) {
    const auto low = static_cast<std::uint32_t>(id), high = static_cast<std::uint32_t>(id >> 32);
    const auto random = [&](std::uint32_t purpose) {
        return 2.0 * static_cast<double>(shared::as_uniform(shared::as_hash(seed, low, high, purpose))) - 1.0;
    };
    return {half_range.x * random(shared::PURPOSE_JITTER_X), half_range.y * random(shared::PURPOSE_JITTER_Y),
            half_range.z * random(shared::PURPOSE_JITTER_Z)};
}

/// The two together, jitter in half voxels.
inline glm::dvec3 jittered_position(const Lattice& lattice, std::uint64_t id, double jitter,
                                    std::uint32_t seed) {
    return lattice_position(lattice, id) + jitter_offset(id, seed, lattice.spacing() * (0.5 * jitter));
}

}  // namespace astrosplat
