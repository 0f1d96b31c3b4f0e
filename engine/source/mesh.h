// Triangle meshes: read from Wavefront OBJ files, three built-in shapes, their measures, planar projections;
// polygons split into triangles. In: a file or a name, a mesh, or corners. Out: a mesh, or numbers.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/bounds.h"
#include "core/progress.h"
#include "source/source.h"

namespace astrosplat {

struct Mesh {
    struct Triangle {
        std::array<std::uint32_t, 3> position;  // indices into positions
        std::array<std::uint32_t, 3> uv;        // indices into uvs; all no_uv where the face has none
        std::uint32_t material = 0;             // index into maps, when maps is not empty
    };
    static constexpr std::uint32_t no_uv = 0xffffffffu;

    std::vector<glm::vec3> positions;      // scene units
    std::vector<glm::vec3> vertex_colors;  // sRGB, 0..1, of each position, where the file has any
    std::vector<glm::vec2> uvs;            // v = 0 is the bottom row
    std::vector<Triangle> triangles;
    std::vector<fs::path> maps;  // map_Kd of each material (empty path: none), resolved to the MTL's folder
    std::vector<std::optional<glm::vec3>> colors;  // Kd of each, linear, as many as maps
    std::string name;                              // the file, for messages
};

/// Bounds of all vertices (also of those no face uses).
Bounds bounds(const Mesh& mesh);

/// Sum of the triangles' areas, square scene units.
double surface_area(const Mesh& mesh);

/// Replaces the uvs by a planar projection over `box` (DESIGN 3): planar-xz u to +x, v to -z; planar-xy u to
/// +x, v to +y; planar-yz u to -z, v to +y. UvMode::mesh leaves the mesh as it is, and throws InputError
/// naming the mesh when a triangle has no uv.
void apply_uv(Mesh& mesh, UvMode mode, const Bounds& box);

/// Turns an outline of (r, y), r >= 0, about the y axis: u runs once around, its middle to +z and growing to
/// +x there; `v` has a value for each point. Lengths are multiplied by `scale`. Where r is 0 the faces
/// without area are left out. An outline that goes up has its faces outward. 128 columns; the seam has its
/// vertices twice.
Mesh revolved(std::span<const glm::dvec2> outline, std::span<const double> v, double scale);

/// Names that stand for shapes instead of files.
inline constexpr std::array<std::string_view, 11> builtin_meshes = {
    "plane", "relief", "sheet",     "disk", "sphere",    "spheroid",
    "shell", "bubble", "hourglass", "ring", "revolution"};
bool is_builtin_mesh(const fs::path& name);

/// "plane": in xz, centred, longer side 10, `aspect` = width / height of the picture, u to +x, v to -z.
/// "disk": radius 5 in xz, uv as the plane's, and the largest circle around the middle of the picture.
/// "sphere": radius 5, equirectangular uv, seen from outside right way round. (The others are
/// in textured_mesh.h.)
Mesh builtin_mesh(const std::string& name, double aspect);

/// The most corners a polygon that is not convex may have: clipping takes cubic time at worst.
inline constexpr std::size_t max_concave_corners = 4096;

/// Triangles of a polygon with n >= 3 corners, as n - 2 triples of indices into `corners`, wound as the
/// polygon is. Convex ones become a fan around corner 0; others lose ears (Meisters 1975) in the plane their
/// normal (Newell's) is closest to. A polygon that crosses itself becomes some n - 2 triangles of its
/// corners. Empty when it is concave and has more than max_concave_corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

/// Reads an OBJ: several objects, quads and polygons, negative indices, map_Kd, Kd, colours of vertices.
/// Faces keep the file's order. A missing MTL is a warning. Throws InputError (file, line where known) for
/// unreadable, truncated or empty files, indices out of range, coordinates that are not finite; Cancelled.
Mesh load_obj(const fs::path& file, const Progress& progress = {});

/// The files besides the OBJ itself that its map_Kd pictures come from: the material libraries that it names
/// and the pictures that those name, as far as they exist. Reads no geometry.
/// Throws InputError, Cancelled.
std::vector<fs::path> obj_materials(const fs::path& file, const Progress& progress = {});

}  // namespace astrosplat
