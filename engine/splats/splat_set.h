// A layer's splats before any look: what generation or a splat file gives. Structure of arrays, layer space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>

#include "core/bounds.h"
#include "core/buffer.h"
#include "splats/harmonics.h"
#include "splats/star_pixels.h"

namespace astrosplat {

/// What is known of a set as a whole.
struct SplatSetFacts {
    glm::dvec3 spacing{0.0};    // scene units between lattice neighbours per axis; 0: on none, or unknown
    double max_distance = 0.0;  // scene units; x = 1 by default: the source's, or a file's largest distance
    bool generated = false;     // from meshes; else from a file
    bool divided = false;       // colours were divided by alpha by the source
    std::int64_t test_positions = 0;  // lattice positions looked at, 0 for files
    std::int64_t zero_alpha = 0;      // positions dropped because their alpha is exactly 0
    bool absorbs = false;             // splats of colours below 0 absorb: see color
    bool stars =
        false;  // colours are light summed over all pixels, as seen from the origin; see is_direction
    bool display_harmonics = false;  // harmonics give display values (sRGB); else linear light
    StarPixels star_pixels;          // of stars: over which pixels; else without a meaning
    std::string credit;              // from the inputs' metadata
    bool of_this_machine = false;    // pictures were reduced for want of free memory: not to be kept
    std::string recipe;              // of an entry of the cache: what made it (sets/recipe.h)

    bool is_on_lattice() const { return spacing.x > 0.0; }
};

/// Arrays either have size() entries or are empty ("not known"); position, color, alpha, distance and id are
/// always there. Splats are in ascending order of id (see sort_by_id), so an index stands for an id in ties.
struct SplatSet : SplatSetFacts {
    Buffer<glm::vec3> position;  // scene units, layer space
    Buffer<glm::vec3>
        color;               // linear light, straight; below 0 in a set that absorbs: -exponents (blend.glsl)
    Buffer<float> alpha;     // 0..1
    Buffer<float> distance;  // scene units from the mesh surface, >= 0; 0 where a file has none
    Buffer<std::uint64_t> id;    // lattice index, or row number of a file
    Buffer<glm::vec2> uv;        // of the closest point
    Buffer<glm::vec3> normal;    // unit normal of the closest face
    Buffer<std::uint32_t> mesh;  // index of the closest mesh
    Buffer<float> radius;        // scene units; only from files (radiusPP)
    // Of Gaussians, whose radius is three standard deviations of the ball with their shadow (mean square of
    // those along their own axes). Scale, rotation and radius are there together.
    Buffer<glm::vec3> scale;      // standard deviations along their own axes, scene units, >= 0
    Buffer<glm::vec4> rotation;   // of these axes: unit quaternions x y z w
    Buffer<Harmonics> harmonics;  // their colour by direction, of which `color` is the mean
    Buffer<std::uint32_t> face;   // number of the closest triangle, all meshes'; only while columns are made

    std::int64_t size() const { return static_cast<std::int64_t>(position.size()); }
};

/// The columns by number, in the order of for_each_column. Those from uv on are optional.
enum class SplatColumn : std::uint8_t {
    position,
    color,
    alpha,
    distance,
    id,
    uv,
    normal,
    mesh,
    radius,
    face,
    scale,
    rotation,
    harmonics
};
constexpr const char* name_of(SplatColumn column) {
    constexpr const char* names[] = {"position", "color",    "alpha",    "distance", "id",
                                     "uv",       "normal",   "mesh",     "radius",   "face",
                                     "scale",    "rotation", "harmonics"};
    return names[static_cast<std::size_t>(column)];
}
constexpr bool is_optional(SplatColumn column) { return column >= SplatColumn::uv; }

/// Calls visit(pointer to member, SplatColumn) for every column: the one list of them. Native files store
/// them in this order.
template <class Visit>
void for_each_column(Visit visit) {
    visit(&SplatSet::position, SplatColumn::position);
    visit(&SplatSet::color, SplatColumn::color);
    visit(&SplatSet::alpha, SplatColumn::alpha);
    visit(&SplatSet::distance, SplatColumn::distance);
    visit(&SplatSet::id, SplatColumn::id);
    visit(&SplatSet::uv, SplatColumn::uv);
    visit(&SplatSet::normal, SplatColumn::normal);
    visit(&SplatSet::mesh, SplatColumn::mesh);
    visit(&SplatSet::radius, SplatColumn::radius);
    visit(&SplatSet::face, SplatColumn::face);
    visit(&SplatSet::scale, SplatColumn::scale);
    visit(&SplatSet::rotation, SplatColumn::rotation);
    visit(&SplatSet::harmonics, SplatColumn::harmonics);
}

/// Bytes of one splat in the columns for which `wanted` says so.
template <class Wanted>
std::size_t bytes_per_splat(Wanted wanted) {
    std::size_t bytes = 0;
    for_each_column([&]<class T>(Buffer<T> SplatSet::*, SplatColumn column) {
        if (wanted(column)) bytes += sizeof(T);
    });
    return bytes;
}

/// Which of the columns that a set can do without are wanted: pages that nobody reads cost as much as others.
struct OptionalColumns {
    bool uv = true, normal = true, mesh = true, face = false;
};

/// Gives back the memory of columns that are not wanted.
void drop_columns(SplatSet& set, const OptionalColumns& wanted);

/// Gives back the memory of all splats; what is known of the set as a whole stays.
void drop_splats(SplatSet& set);

/// Whether the position of a star stands for a direction: it is infinitely far away.
inline bool is_direction(const glm::vec3& position) {
    constexpr float far = 1e15f;  // scene units
    const auto beyond = [](float x) { return x >= far || x <= -far; };
    return beyond(position.x) || beyond(position.y) || beyond(position.z);
}

/// Whether its splats are Gaussians of their own shapes.
inline bool holds_gaussians(const SplatSet& set) { return !set.scale.empty(); }

/// Bounds of all positions, without directions of stars.
Bounds bounds(const SplatSet& set);

/// Brings all arrays into ascending order of id; stable for equal ids. Cheap when already sorted.
void sort_by_id(SplatSet& set);

/// Asserts that the arrays' sizes agree.
void check_consistent(const SplatSet& set);

}  // namespace astrosplat
