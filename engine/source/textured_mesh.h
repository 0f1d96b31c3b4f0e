// A mesh together with the pictures that colour it, as generation reads it. Its texture coordinates may be
// projections: planar ones beyond the stretch over a mesh's own box (pictures in scene units, back walls that
// differ from the front), or from the camera that took a picture, back onto the mesh before it (uv =
// "camera"). Built-in shapes beyond plane, disk and sphere are about the origin, 10 scene units across or
// along, normals outward, with texture coordinates. In: a source's keys. Out: meshes; where points are seen
// in a picture.
#pragma once

#include <glm/vec2.hpp>

#include "camera/camera.h"
#include "source/mesh.h"
#include "source/source.h"
#include "source/texture.h"

namespace astrosplat {

/// All of it for one mesh of a source; `box` is that of all its meshes, `aspect` of this one's picture.
/// UvMode::mesh: as apply_uv.
void apply_source_uv(Mesh& mesh, const SourceParams& source, const Bounds& box, double aspect);

/// As one that takes a picture `aspect` px wide and 1 px high. `params` has a position and is not degenerate.
Camera picture_camera(const UvCamera& params, double aspect);

/// The same as parameters, for rendering what it saw.
CameraParams params_of(const Camera& camera);

struct PlaceInPicture {
    glm::dvec2 uv;  // v = 0 is the bottom row; 0..1 within the picture
    double depth;   // scene units before the eye, along the view axis
};

/// Where the picture shows a point; empty for what is not before the eye.
std::optional<PlaceInPicture> place_in_picture(const Camera& camera, const glm::dvec3& point);

/// Scene units from the picture's bottom to its top at a depth.
double picture_height_at(const Camera& camera, double depth);

/// The camera of a picture that is so many times as wide and high, with what this one sees in its middle.
Camera widened(Camera camera, glm::dvec2 times);

/// Gives every vertex the place where the picture shows it, and none to faces not wholly before the eye.
void apply_camera_uv(Mesh& mesh, const Camera& camera);

/// A mesh with one picture per material (exactly one where the texture was named in the scene).
struct TexturedMesh {
    Mesh mesh;
    std::vector<Texture> textures;
    std::optional<Camera> camera;  // uv = "camera": that took the pictures
};

/// Loads the meshes and pictures of a mesh source (paths already resolved). Wrap::automatic is clamp for
/// built-in meshes and planar uv, black for planar uv with a width and for a camera's, repeat for a mesh's
/// own uv. Throws InputError. `readers` are load_texture's.
std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress = {},
                                      const PictureReaders& readers = {});

/// Reads the pictures of meshes again, as `source` says now; it has the meshes that these were loaded for,
/// and their shapes stay. Throws InputError, Cancelled.
void reload_pictures(const SourceParams& source, std::vector<TexturedMesh>& meshes,
                     const Progress& progress = {}, const PictureReaders& readers = {});

/// Bounds of all vertices of all meshes.
Bounds bounds(std::span<const TexturedMesh> meshes);

/// "revolution": the outline of `shape`, from its lower end, v by its length, straight between its points.
/// "hourglass": two closed lobes along y with r = width (waist sin t + (1 - waist) |sin 2t|), y = -5 cos t.
/// "shell": the walls of a hollow ball, radius 5 and 5 (1 - thickness); the inner one looks inward.
/// "bubble": a sphere that is open around +y, up to `opening` degrees from it; v as on the whole sphere.
/// "spheroid": spheres flattened along y, nested at radii whose number per length falls as
/// e^(-concentration r / 5); the outermost has radius 5.
/// "ring": a torus about y, 5 to its outer rim; v around its tube from the inner side.
/// Throws InputError for an outline of fewer than two points.
Mesh turned_shape(const std::string& name, const ShapeParams& shape);
bool is_turned_shape(const std::string& name);

/// The built-in "relief": the plane of the texture's aspect, lifted towards +y by the smoothed brightness of
/// the picture; `height` is a fraction of the plane's width. 256 cells along the longer side.
Mesh relief_mesh(const Texture& texture, double height);

/// "sheet": the same plane, displaced along y by `shape.depth_map`, whose mean channel is the height as
/// stored, or without one by the picture's displayed brightness. Blurred, then stretched to `shape.depth` of
/// the width, half of it on either side. 512 cells along the longer side. Throws InputError where the map
/// cannot be read.
Mesh sheet_mesh(const Texture& texture, const ShapeParams& shape);

}  // namespace astrosplat
