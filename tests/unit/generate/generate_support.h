// Small meshes, one-colour pictures and the slow but plain generation that the tests compare with.
#pragma once

#include <glm/vec4.hpp>

#include "generate/generate.h"
#include "generate/lattice.h"
#include "generate/triangle_tree.h"
#include "support/test.h"

namespace astrosplat {

inline ClosestPoint closest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                        const glm::dvec3& c) {
    return closest_on_triangle(p, triangle_shape(a, b, c));
}

// The positions of a lattice one by one, as DESIGN 4 says: what place_block is compared with.

/// Position of lattice id before jitter; corners come first, then centres.
inline glm::dvec3 lattice_position(const Lattice& lattice, std::uint64_t id) {
    const auto corners = std::uint64_t(lattice.corners());
    const bool centre = id >= corners;
    const std::uint64_t index = centre ? id - corners : id;
    const auto nx = std::uint64_t(lattice.n.x + (centre ? 0 : 1));
    const auto ny = std::uint64_t(lattice.n.y + (centre ? 0 : 1));
    const double half = centre ? 0.5 : 0.0;
    return {lattice_coordinate(lattice, 0, double(index % nx) + half),
            lattice_coordinate(lattice, 1, double(index / nx % ny) + half),
            lattice_coordinate(lattice, 2, double(index / nx / ny) + half)};
}

/// Displacement of a position by jitter: half_range * uniform[-1, 1) per axis, hashed from (seed, id).
inline glm::dvec3 jitter_offset(std::uint64_t id, std::uint32_t seed, const glm::dvec3& half_range) {
    const auto low = std::uint32_t(id), high = std::uint32_t(id >> 32);
    const auto random = [&](std::uint32_t purpose) {
        return 2.0 * double(shared::as_uniform(shared::as_hash(seed, low, high, purpose))) - 1.0;
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

namespace astrosplat::test {

inline Texture flat_texture(const glm::vec4& straight, std::int64_t size = 8) {
    Texture texture;
    texture.image = make_image(size, size, 4);
    for (std::size_t i = 0; i < texture.image.pixels.size(); ++i) {
        const auto c = static_cast<glm::vec4::length_type>(i % 4);
        texture.image.pixels[i] = c == 3 ? straight.a : straight[c] * straight.a;
    }
    return texture;
}

/// Its left half is transparent.
inline Texture half_lit(const glm::vec4& straight = glm::vec4(0.25f, 0.5f, 1.0f, 0.75f)) {
    Texture texture = flat_texture(straight, 64);
    for (std::int64_t y = 0; y < 64; ++y) std::fill_n(texture.image.at(0, y), 4 * 32, 0.0f);
    return texture;
}

inline TexturedMesh textured(Mesh mesh, Texture texture = flat_texture(glm::vec4(1.0f))) {
    TexturedMesh m;
    m.mesh = std::move(mesh);
    m.textures.push_back(std::move(texture));
    return m;
}

inline Lattice lattice_of(const glm::i64vec3& voxels, const std::vector<TexturedMesh>& meshes,
                          double max_distance, std::optional<glm::dvec3> buffer = {}) {
    SourceParams source;
    source.voxels = voxels;
    source.buffer = buffer;
    return make_lattice(source, meshes, max_distance);
}

/// Every position of the lattice against every triangle, one after the other; triangles that a bounding
/// sphere rules out by more than any rounding are not measured.
class Oracle {
  public:
    explicit Oracle(const Mesh& mesh) {
        for (const Mesh::Triangle& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t.position[0]]), b(mesh.positions[t.position[1]]),
                c(mesh.positions[t.position[2]]);
            corners_.push_back({a, b, c});
            const glm::dvec3 m = (a + b + c) / 3.0;
            x_.push_back(m.x), y_.push_back(m.y), z_.push_back(m.z);
            r_.push_back(std::max({glm::length(a - m), glm::length(b - m), glm::length(c - m)}) *
                         (1.0 + 1e-9));
        }
    }

    ClosestPoint closest(const glm::dvec3& p, double max_distance) const {
        ClosestPoint best{max_distance * max_distance, ClosestPoint::none, {}};
        constexpr std::size_t step = 256;
        for (std::size_t begin = 0; begin < r_.size(); begin += step) {
            const std::size_t end = std::min(begin + step, r_.size());
            const double reach = std::sqrt(best.distance_squared) * (1.0 + 1e-9);
            int near_p = 0;
            for (std::size_t i = begin; i < end; ++i)
                near_p += squared(i, p) <= (reach + r_[i]) * (reach + r_[i]);
            if (near_p == 0) continue;
            for (std::size_t i = begin; i < end; ++i) {
                if (squared(i, p) > (reach + r_[i]) * (reach + r_[i])) continue;
                ClosestPoint other = closest_on_triangle(p, corners_[i].a, corners_[i].b, corners_[i].c);
                other.triangle = std::uint32_t(i);
                if (other.distance_squared < best.distance_squared ||
                    (best.triangle == ClosestPoint::none &&
                     other.distance_squared == best.distance_squared)) {
                    best = other;  // in ascending order: ties keep the lower index
                }
            }
        }
        return best;
    }

  private:
    double squared(std::size_t i, const glm::dvec3& p) const {
        const double x = p.x - x_[i], y = p.y - y_[i], z = p.z - z_[i];
        return x * x + y * y + z * z;
    }
    struct Corners {
        glm::dvec3 a, b, c;
    };
    std::vector<Corners> corners_;
    std::vector<double> x_, y_, z_, r_;
};

inline void expect_same_bits(const SplatSet& a, const SplatSet& b) {
    EXPECT_TRUE(same_bits(a.id, b.id));
    EXPECT_TRUE(same_bits(a.position, b.position));
    EXPECT_TRUE(same_bits(a.color, b.color));
    EXPECT_TRUE(same_bits(a.alpha, b.alpha));
    EXPECT_TRUE(same_bits(a.distance, b.distance));
    EXPECT_TRUE(same_bits(a.uv, b.uv));
    EXPECT_TRUE(same_bits(a.normal, b.normal));
    EXPECT_TRUE(same_bits(a.mesh, b.mesh));
    EXPECT_EQ(a.zero_alpha, b.zero_alpha);
}

}  // namespace astrosplat::test
