// Sets made for the tests of the look: splats at known distances, and a slab of lattice around a plane.
#pragma once

#include "look/apply.h"
#include "look/shared_look.h"
#include "support/splats.h"

namespace astrosplat::test {

/// A repeatable number in [0, 1): hash of (index, which).
inline float uniform(std::int64_t index, std::uint32_t which) {
    return shared::as_uniform(shared::as_hash(77u, std::uint32_t(index), 0u, 100u + which));
}

/// A set from a file: no lattice, no texture coordinates, radius 0.1.
inline SplatSet file_set(std::int64_t count) {
    SplatSet set;
    set.position.resize(std::size_t(count));
    set.color.resize(std::size_t(count));
    set.alpha.resize(std::size_t(count));
    set.distance.resize(std::size_t(count));
    set.radius.resize(std::size_t(count));
    set.id.resize(std::size_t(count));
    for (std::int64_t n = 0; n < count; ++n) {
        const auto i = std::size_t(n);
        set.position[i] = {8.0f * uniform(n, 0) - 4.0f, uniform(n, 1) - 0.5f, 8.0f * uniform(n, 2) - 4.0f};
        set.color[i] = {uniform(n, 3), uniform(n, 4), uniform(n, 5)};
        set.alpha[i] = uniform(n, 6);
        set.distance[i] = 2.0f * uniform(n, 7);
        set.radius[i] = 0.05f + 0.1f * uniform(n, 8);
        set.id[i] = std::uint64_t(n) * 3u + (std::uint64_t(n) << 33);
    }
    set.max_distance = 2.0;
    return set;
}

/// One splat of a file at a distance, with alpha and grey colour.
inline SplatSet one_splat(float distance, float alpha, float grey) {
    SplatSet set = file_set(1);
    set.position[0] = {1.0f, 2.0f, 3.0f};
    set.color[0] = glm::vec3(grey);
    set.alpha[0] = alpha;
    set.distance[0] = distance;
    set.radius[0] = 0.25f;
    return set;
}

/// The positions that generation keeps of a cubic lattice around the plane y = 0, |x|, |z| <= half, with
/// alpha everywhere.
inline SplatSet slab(double spacing, double half, double max_distance, float alpha) {
    SplatSet set;
    const auto across = std::int64_t(2.0 * half / spacing + 0.5);
    const auto up = std::int64_t(2.0 * max_distance / spacing + 0.5) + 4;
    const auto add = [&](std::int64_t id, double x, double y, double z) {
        const auto moved = [&](std::uint32_t axis) { return spacing * (double(uniform(id, axis)) - 0.5); };
        const glm::dvec3 p(x + moved(0), y + moved(1), z + moved(2));
        const double distance = p.y < 0.0 ? -p.y : p.y;
        if (distance > max_distance) return;
        add_splat(set, glm::vec3(p), glm::vec3(1.0f), alpha);
        set.distance.back() = float(distance);
        set.id.back() = std::uint64_t(id);
    };
    std::int64_t id = 0;
    for (double offset : {0.0, 0.5})
        for (std::int64_t k = 0; k < across; ++k)
            for (std::int64_t j = 0; j < up; ++j)
                for (std::int64_t i = 0; i < across; ++i)
                    add(id++, (double(i) + offset) * spacing - half, (double(j - up / 2) + offset) * spacing,
                        (double(k) + offset) * spacing - half);
    set.spacing = glm::dvec3(spacing);
    set.max_distance = max_distance;
    set.generated = true;
    return set;
}

/// The look applied to one splat, which must be kept.
inline ShadedSplats shade(const SplatSet& set, const Look& look, LookInputs inputs = {}) {
    return apply_look(set, look, inputs);
}

}  // namespace astrosplat::test
