// A layer's splats before any look: what generation or a splat file gives. Structure of arrays, layer space;
// and sets made of some of the rows of another.
#pragma once

#include <bitset>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <tuple>

#include "core/bounds.h"
#include "core/buffer.h"
#include "splats/harmonics.h"

namespace astrosplat {

/// In which pixels the light of stars was measured, where those of a picture are meant. Without either side
/// the light of a star is that over all pixels of any frame, as seen from the layer's origin. Else it is that
/// over the pixels of a picture, of which a frame's own may be more or fewer: they are squares of these sides
/// at the star, as they are for the splats that the same picture was made into.
struct StarPixels {
    glm::dvec3 from{0.0};    // layer space: where rays meet
    double side_at_1 = 0.0;  // scene units, at a distance of 1 from there
    double side = 0.0;       // scene units, at any distance: rays are parallel
    bool are_known() const { return side_at_1 > 0.0 || side > 0.0; }
    bool operator==(const StarPixels&) const = default;
};

/// Facts about a set as a whole.
struct SplatSetFacts {
    glm::dvec3 spacing{0.0};    // scene units between lattice neighbours per axis; 0: on none, or unknown
    double max_distance = 0.0;  // scene units; x = 1 by default: the source's, or a file's largest distance
    bool generated = false;     // from meshes; else from a file
    bool divided = false;       // colours were divided by alpha by the source
    std::int64_t test_positions = 0;  // lattice positions looked at, 0 for files
    std::int64_t zero_alpha = 0;      // positions dropped because their alpha is exactly 0
    bool absorbs = false;             // splats of colours below 0 absorb: see color
    /// Colours are light summed over all pixels, as seen from the origin; see is_direction.
    bool stars = false;
    bool display_harmonics = false;  // harmonics give display values (sRGB); else linear light
    StarPixels star_pixels;          // of stars: over which pixels; else without a meaning
    std::string credit;              // from the inputs' metadata
    std::string origin;            // what is measured and what is invented (source/origin.h); empty: unknown
    bool of_this_machine = false;  // pictures were reduced for want of free memory: not to be kept
    std::string recipe;            // of an entry of the cache: what made it (sets/recipe.h)

    bool is_on_lattice() const { return spacing.x > 0.0; }
};

/// Arrays either have size() entries or are empty ("not known"); position, color, alpha, distance and id are
/// always there. Splats are in ascending order of id (see sort_by_id), so an index stands for an id in ties.
struct SplatSet : SplatSetFacts {
    Buffer<glm::vec3> position;  // scene units, layer space
    /// Linear light, straight; below 0 in a set that absorbs: -exponents (blend.glsl).
    Buffer<glm::vec3> color;
    Buffer<float> alpha;         // 0..1
    Buffer<float> distance;      // scene units from the mesh surface, >= 0; 0 where a file has none
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

    std::int64_t size() const { return std::int64_t(position.size()); }
};

/// The columns by number, in the order of splat_columns. Those from uv on are optional.
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
constexpr bool is_optional(SplatColumn column) { return column >= SplatColumn::uv; }

template <class T>
struct SplatColumnRow {
    SplatColumn column;
    const char* name;
    Buffer<T> SplatSet::*array;
};

/// The one list of the columns. Native files store them in this order.
inline constexpr std::tuple splat_columns{
    SplatColumnRow{SplatColumn::position, "position", &SplatSet::position},
    SplatColumnRow{SplatColumn::color, "color", &SplatSet::color},
    SplatColumnRow{SplatColumn::alpha, "alpha", &SplatSet::alpha},
    SplatColumnRow{SplatColumn::distance, "distance", &SplatSet::distance},
    SplatColumnRow{SplatColumn::id, "id", &SplatSet::id},
    SplatColumnRow{SplatColumn::uv, "uv", &SplatSet::uv},
    SplatColumnRow{SplatColumn::normal, "normal", &SplatSet::normal},
    SplatColumnRow{SplatColumn::mesh, "mesh", &SplatSet::mesh},
    SplatColumnRow{SplatColumn::radius, "radius", &SplatSet::radius},
    SplatColumnRow{SplatColumn::face, "face", &SplatSet::face},
    SplatColumnRow{SplatColumn::scale, "scale", &SplatSet::scale},
    SplatColumnRow{SplatColumn::rotation, "rotation", &SplatSet::rotation},
    SplatColumnRow{SplatColumn::harmonics, "harmonics", &SplatSet::harmonics}};
inline constexpr std::size_t splat_column_count = std::tuple_size_v<decltype(splat_columns)>;
static_assert(sizeof(SplatSet) == sizeof(SplatSetFacts) + splat_column_count * sizeof(Buffer<float>),
              "every array of a set has its row");
static_assert(std::apply(
                  [](const auto&... row) {
                      std::size_t number = 0;
                      return ((std::size_t(row.column) == number++) && ...);
                  },
                  splat_columns),
              "the rows are numbered as the columns are");

/// Calls visit(pointer to member, SplatColumn) for every column.
template <class Visit>
void for_each_column(Visit visit) {
    std::apply([&](const auto&... row) { (visit(row.array, row.column), ...); }, splat_columns);
}

constexpr std::size_t index_of(SplatColumn column) { return std::size_t(column); }

constexpr const char* name_of(SplatColumn column) {
    const auto names = [](const auto&... row) { return std::array{row.name...}; };
    return std::apply(names, splat_columns)[index_of(column)];
}

/// Which columns a set or a file has.
using SplatColumns = std::bitset<splat_column_count>;  // by index_of()

/// Their names, in the order in which they are reported: what is always there first, the id last.
std::vector<std::string> column_names(const SplatColumns& columns);

/// Bytes of one splat in the columns for which `wanted` says so.
template <class Wanted>
std::size_t bytes_per_splat(Wanted wanted) {
    std::size_t bytes = 0;
    for_each_column([&]<class T>(Buffer<T> SplatSet::*, SplatColumn column) {
        if (wanted(column)) bytes += sizeof(T);
    });
    return bytes;
}

/// Which of the columns that a set can do without are wanted: unread pages cost as much as others.
struct OptionalColumns {
    bool uv = true, normal = true, mesh = true, face = false;
};

constexpr bool is_wanted(SplatColumn column, const OptionalColumns& wanted) {
    return column == SplatColumn::uv       ? wanted.uv
           : column == SplatColumn::normal ? wanted.normal
           : column == SplatColumn::mesh   ? wanted.mesh
           : column == SplatColumn::face   ? wanted.face
                                           : true;
}

/// Gives back the memory of columns that are not wanted.
void drop_columns(SplatSet& set, const OptionalColumns& wanted);

/// Gives back the memory of all splats; what is known of the set as a whole stays.
void drop_splats(SplatSet& set);

/// Ids of sets that were made of pictures: from these bits on the number of the picture, that of the band,
/// which of the faces that show it, which of the band's sizes; below, the place within the band. Ids of
/// lattices and rows of files do not reach that far.
inline constexpr int picture_bit = 56, band_bit = 48, instance_bit = 42, size_bit = 40;
inline constexpr std::uint64_t star_band = 255, dust_band = 254, spike_band = 253;

constexpr std::uint64_t band_of(std::uint64_t id) { return id >> band_bit & 255; }
constexpr bool is_star(std::uint64_t id) { return band_of(id) == star_band; }
constexpr bool is_spike(std::uint64_t id) { return band_of(id) == spike_band; }
/// As it was before the picture and the face were added.
constexpr std::uint64_t id_in_picture(std::uint64_t id) {
    return id & ~(~std::uint64_t{0} << picture_bit | std::uint64_t{63} << instance_bit);
}

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

/// A set of these rows, in their order.
SplatSet take_rows(const SplatSet& set, const Buffer<std::int64_t>& rows);

/// Of `size` rows cut into `count` even stretches, one of the i-th by chance: every n-th row of a lattice
/// would be a pattern. The same at every call.
std::int64_t sampled_row(std::int64_t size, std::int64_t count, std::int64_t i);

/// Those rows of all stretches, ascending; all rows where `count` is not less than `size`.
Buffer<std::int64_t> sampled_rows(std::int64_t size, std::int64_t count);

/// At most `count` rows, spread evenly over the set's own order.
SplatSet sample_rows(const SplatSet& set, std::int64_t count);

}  // namespace astrosplat
