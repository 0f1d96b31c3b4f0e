// Projections are in double; a face's coordinates are affine in the picture, not on the face.
#include "source/textured_mesh.h"

#include <fmt/format.h>

#include <glm/matrix.hpp>

#include "camera/projection.h"
#include "core/error.h"
#include "core/log.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr float displacement = 0.35f;  // of the picture, by noise of 1
constexpr double noise_feature = 0.3;  // of the box's longest side
constexpr std::uint32_t noise_seed = 0x5eedu;

// The axis along which a picture is projected; it reads right from its positive end.
int depth_axis(UvMode mode) { return mode == UvMode::planar_xy ? 2 : mode == UvMode::planar_xz ? 1 : 0; }

// 0 from the middle of the box on forward, 1 at its back.
double backness(const glm::dvec3& p, int axis, const Bounds& box) {
    const double middle = 0.5 * (box.lo[axis] + box.hi[axis]), half = middle - box.lo[axis];
    return half > 0.0 ? std::clamp((middle - p[axis]) / half, 0.0, 1.0) : 0.0;
}

void vary(Mesh& mesh, int axis, const Bounds& box) {
    const glm::dvec3 extent = box.extent();
    const double frequency = 1.0 / (noise_feature * std::max({extent.x, extent.y, extent.z, 1e-12}));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::dvec3 p(mesh.positions[i]);
        const double t = backness(p, axis, box);
        const auto fade = float(real::smoothstep(t));
        const glm::vec3 at((p - box.lo) * frequency);
        mesh.uvs[i].x += displacement * fade * shared::as_noise(at.x, at.y, at.z, noise_seed);
        mesh.uvs[i].y += displacement * fade * shared::as_noise(at.x, at.y, at.z, noise_seed + 1);
    }
}

void mirror(Mesh& mesh, int axis, const Bounds& box) {
    const auto count = std::uint32_t(mesh.uvs.size());
    for (std::uint32_t i = 0; i < count; ++i) mesh.uvs.emplace_back(1.0f - mesh.uvs[i].x, mesh.uvs[i].y);
    for (Mesh::Triangle& triangle : mesh.triangles) {
        glm::dvec3 middle(0.0);
        for (const std::uint32_t corner : triangle.position)
            middle += glm::dvec3(mesh.positions[corner]) / 3.0;
        if (backness(middle, axis, box) > 0.0)
            for (std::uint32_t& uv : triangle.uv) uv += count;
    }
}

// The box over which apply_uv projects a picture, `aspect` = width / height, so that it covers `width` scene
// units about `center`.
Bounds picture_box(UvMode mode, double width, const glm::dvec3& center, double aspect) {
    assert(width > 0.0 && aspect > 0.0);
    const double height = width / aspect;
    glm::dvec3 extent(width, height, height);
    if (mode == UvMode::planar_yz) extent = {0.0, height, width};
    return {center - 0.5 * extent, center + 0.5 * extent};
}

// Changes planar uvs of what lies behind the middle of `box`, seen from where the projection reads right
// (planar-xy: from +z). A closed shape whose walls show one picture is its own mirror image from the side.
// - mirrored: faces whose middle is behind show the picture left to right, so that it reads right from there
//   too.
// - varied: they show it displaced by smooth noise, not at all at the box's middle and at the back by up to
//   0.3 of the picture, .1 on average; features of 0.3 of the box. Follows the vertices.
void tell_back_apart(Mesh& mesh, UvMode mode, BackWall back, const Bounds& box) {
    assert(mode != UvMode::mesh && mesh.uvs.size() == mesh.positions.size());
    if (back == BackWall::varied) vary(mesh, depth_axis(mode), box);
    if (back == BackWall::mirrored) mirror(mesh, depth_axis(mode), box);
}

}  // namespace

void apply_source_uv(Mesh& mesh, const SourceParams& source, const Bounds& box, double aspect) {
    const bool in_units = source.uv != UvMode::mesh && source.uv_width > 0.0;
    apply_uv(mesh, source.uv,
             in_units ? picture_box(source.uv, source.uv_width, source.uv_center, aspect) : box);
    if (source.uv != UvMode::mesh) tell_back_apart(mesh, source.uv, source.back, box);
}

Camera picture_camera(const UvCamera& params, double aspect) {
    assert(params.position && aspect > 0.0);
    CameraParams camera;
    camera.projection = params.height > 0.0 ? Projection::orthographic : Projection::perspective;
    camera.position = params.position;
    camera.target = params.target;
    camera.up = params.up;
    camera.fov = params.fov;
    camera.height = params.height;
    camera.near = 1e-9;
    return make_camera(camera, aspect, 1.0, {});
}

CameraParams params_of(const Camera& camera) {
    const bool parallel = exact::has_parallel_rays(make_exact_lens(camera));
    CameraParams params;
    params.projection = camera.projection;
    params.position = camera.eye;
    params.target = camera.eye + view_direction(camera);
    params.up = camera.world_from_camera[1];
    params.near = camera.near;
    if (parallel)
        params.height = picture_height_at(camera, 1.0);
    else
        params.fov = 2.0 * real::degrees(real::atan2(0.5, camera.focal_px));
    return params;
}

std::optional<PlaceInPicture> place_in_picture(const Camera& camera, const glm::dvec3& point) {
    const ExactLens lens = make_exact_lens(camera);
    const glm::dvec3 p = glm::transpose(camera.world_from_camera) * (point - camera.eye);
    if (!exact::is_in_range(lens, -p.z)) return std::nullopt;
    const auto seen = exact::instance_of(lens, p);
    return PlaceInPicture{{seen.x_px / camera.aspect, 1.0 - seen.y_px}, -p.z};
}

double picture_height_at(const Camera& camera, double depth) {
    const bool parallel = exact::has_parallel_rays(make_exact_lens(camera));
    return (parallel ? 1.0 : depth) / camera.focal_px;
}

Camera widened(Camera camera, glm::dvec2 times) {
    camera.focal_px /= times.y;
    camera.aspect *= times.x / times.y;
    camera.center_x_px = 0.5 * camera.aspect;
    return camera;
}

void apply_camera_uv(Mesh& mesh, const Camera& camera) {
    std::vector<bool> seen;
    mesh.uvs.clear();
    for (const glm::vec3& position : mesh.positions) {
        const std::optional<PlaceInPicture> place = place_in_picture(camera, glm::dvec3(position));
        seen.push_back(place.has_value());
        mesh.uvs.push_back(place ? glm::vec2(place->uv) : glm::vec2(0.0f));
    }
    for (Mesh::Triangle& triangle : mesh.triangles) {
        const auto& [a, b, c] = triangle.position;
        triangle.uv = triangle.position;
        if (!(seen[a] && seen[b] && seen[c])) triangle.uv = {Mesh::no_uv, Mesh::no_uv, Mesh::no_uv};
    }
}

namespace {

using Wrap = TextureSettings::Wrap;

constexpr const char *neutral_summary = "neutral grey", *plain_summary = "the colour of its material",
                     *painted_summary = "the colours of its vertices";

// Beyond a picture of a given width lies nothing; one that is stretched over the mesh has no beyond.
Wrap default_wrap(const SourceParams& source, Wrap of_own_uv) {
    if (source.uv == UvMode::mesh) return of_own_uv;
    return source.uv == UvMode::camera || source.uv_width > 0.0 ? Wrap::black : Wrap::clamp;
}

// Of a mesh's own uv.
Wrap own_wrap(const MeshInput& input) { return is_builtin_mesh(input.mesh) ? Wrap::clamp : Wrap::repeat; }

double aspect_of(const Image& image) { return double(image.width) / double(image.height); }

// Of the first of its pictures that it uses.
double aspect_of(const TexturedMesh& mesh) {
    for (const Texture& texture : mesh.textures)
        if (texture.image.height > 0) return aspect_of(texture.image);
    return 1.0;
}

// Pictures of a source, wrapped as its settings or else its mesh wants it.
using PictureLoader = std::function<Texture(const std::vector<fs::path>& files, Wrap)>;

TexturedMesh load_builtin(const MeshInput& input, const SourceParams& source, const PictureLoader& load) {
    const std::string name = input.mesh.string();
    TexturedMesh loaded;
    loaded.textures.push_back(load(input.texture, default_wrap(source, own_wrap(input))));
    const Texture& texture = loaded.textures.front();
    const double aspect = aspect_of(texture.image);
    loaded.mesh = name == "relief"        ? relief_mesh(texture, input.relief)
                  : name == "sheet"       ? sheet_mesh(texture, input.shape)
                  : is_turned_shape(name) ? turned_shape(name, input.shape)
                                          : builtin_mesh(name, aspect);
    return loaded;
}

// Of a material; none where it names no picture.
std::vector<fs::path> map_of(const Mesh& mesh, std::size_t material) {
    if (material >= mesh.maps.size() || mesh.maps[material].empty()) return {};
    return {mesh.maps[material]};
}

Texture plain_texture(const glm::vec3& color, const char* summary) {
    Texture texture;
    texture.image = make_image(16, 16, 4, 1.0f);
    change_pixels(texture.image, [&](float* p) { std::copy_n(&color[0], 3, p); });
    texture.summary = summary;
    return texture;
}

// Stands for the picture that a mesh has not: as reflective as the world is on average.
Texture neutral_grey() { return plain_texture(glm::vec3(0.18f), neutral_summary); }

bool is_neutral(const Texture& texture) { return texture.summary == neutral_summary; }
bool is_plain(const Texture& texture) { return is_neutral(texture) || texture.summary == plain_summary; }

// The picture of a mesh as its source wants it read.
Texture load_picture(const std::vector<fs::path>& files, const SourceParams& source, Wrap wrap,
                     const Progress& progress, const PictureReaders& readers) {
    if (files.empty()) return neutral_grey();
    return load_texture(files, source.texture, wrap, progress, readers);
}

// A material's picture times its colour; either alone. Exporters write black for a picture that they do not
// mean to be black.
Texture texture_of(const Mesh& mesh, std::size_t material, Wrap wrap, const PictureLoader& load) {
    const std::vector<fs::path> map = map_of(mesh, material);
    const std::optional<glm::vec3> color =
        material < mesh.colors.size() ? mesh.colors[material] : std::nullopt;
    if (map.empty() && color) return plain_texture(*color, plain_summary);
    Texture texture = load(map, wrap);
    if (color && *color != glm::vec3(0.0f) && *color != glm::vec3(1.0f))
        change_pixels(texture.image, [&](float* p) {
            for (int c = 0; c < 3; ++c) p[c] *= (*color)[c];
        });
    return texture;
}

// Faces without a picture whose vertices have colours: each gets a texel of their mean, in a picture of a
// material of its own.
Texture paint_faces(Mesh& mesh) {
    if (mesh.maps.empty()) mesh.maps.emplace_back();
    mesh.colors.resize(mesh.maps.size());
    const auto painted = std::uint32_t(mesh.maps.size());
    const auto side = std::int64_t(std::ceil(std::sqrt(double(mesh.triangles.size()))));
    Texture texture = plain_texture(glm::vec3(1.0f), painted_summary);
    texture.image = make_image(side, side, 4, 1.0f);
    texture.filter = TextureSettings::Filter::nearest;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        Mesh::Triangle& face = mesh.triangles[i];
        if (!mesh.maps[face.material].empty()) continue;
        const std::int64_t x = std::int64_t(i) % side, y = std::int64_t(i) / side;
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (const std::uint32_t corner : face.position)
                sum += real::srgb_to_linear(std::max(0.0, double(mesh.vertex_colors[corner][c])));
            texture.image.at(x, y)[c] = float(sum / 3.0);
        }
        face.material = painted;
        face.uv.fill(std::uint32_t(mesh.uvs.size()));
        mesh.uvs.emplace_back((double(x) + 0.5) / double(side), 1.0 - (double(y) + 0.5) / double(side));
    }
    mesh.maps.emplace_back();
    mesh.colors.emplace_back();
    return texture;
}

// A colour alone needs no place in a picture.
void place_plain_faces(TexturedMesh& loaded) {
    const auto middle = std::uint32_t(loaded.mesh.uvs.size());
    loaded.mesh.uvs.emplace_back(0.5f, 0.5f);
    for (Mesh::Triangle& face : loaded.mesh.triangles)
        if (face.uv[0] == Mesh::no_uv &&
            is_plain(loaded.textures[loaded.textures.size() == 1 ? 0 : face.material]))
            face.uv.fill(middle);
}

// One picture per material that a face uses; others get an empty one, so that indices stay.
std::vector<Texture> load_maps(const Mesh& mesh, Wrap wrap, const PictureLoader& load) {
    std::vector<bool> used(std::max<std::size_t>(1, mesh.maps.size()), false);
    for (const Mesh::Triangle& face : mesh.triangles) used[mesh.maps.empty() ? 0 : face.material] = true;
    std::vector<Texture> textures(used.size());
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) textures[i] = texture_of(mesh, i, wrap, load);
    return textures;
}

TexturedMesh load_file(const MeshInput& input, const SourceParams& source, const PictureLoader& load,
                       const Progress& progress) {
    const Wrap wrap = default_wrap(source, own_wrap(input));
    TexturedMesh loaded;
    loaded.mesh = load_obj(input.mesh, progress);
    // Bodies lie on places of a picture that a mesh without one has not.
    const bool places = source.uv == UvMode::mesh && source.structure.kind == StructureKind::columns;
    const bool colored = input.texture.empty() && !loaded.mesh.vertex_colors.empty();
    Texture painted = colored && places ? paint_faces(loaded.mesh) : Texture{};
    if (input.texture.empty())
        loaded.textures = load_maps(loaded.mesh, wrap, load);
    else
        loaded.textures.push_back(load(input.texture, wrap));
    const auto is_picture = [](const fs::path& map) { return !map.empty(); };
    if (colored && (!places || std::ranges::any_of(loaded.mesh.maps, is_picture)))
        log_warning(
            fmt::format("{}: the colours of its vertices are used in columns, with uv = \"mesh\" and "
                        "without a picture alone",
                        input.mesh.string()));
    if (colored && places) loaded.textures.back() = std::move(painted);
    if (places) place_plain_faces(loaded);
    return loaded;
}

}  // namespace

Bounds bounds(std::span<const TexturedMesh> meshes) {
    Bounds box;
    for (const TexturedMesh& m : meshes) box.add(bounds(m.mesh));
    return box;
}

std::vector<TexturedMesh> load_meshes(const SourceParams& source, const Progress& progress,
                                      const PictureReaders& readers) {
    if (source.meshes.empty()) bad_input("source.meshes", "at least one mesh", "none");
    const PictureLoader load = [&](const std::vector<fs::path>& files, Wrap wrap) {
        return load_picture(files, source, wrap, progress, readers);
    };
    std::vector<TexturedMesh> meshes;
    for (const MeshInput& input : source.meshes)
        meshes.push_back(is_builtin_mesh(input.mesh) ? load_builtin(input, source, load)
                                                     : load_file(input, source, load, progress));
    for (const TexturedMesh& m : meshes)
        if (std::ranges::any_of(m.textures, is_neutral))
            log_warning(m.mesh.name + " has no picture, for which neutral grey stands");
    const Bounds box = bounds(meshes);
    for (TexturedMesh& m : meshes) {
        if (source.uv == UvMode::camera) {
            m.camera = picture_camera(source.uv_camera, aspect_of(m));
            apply_camera_uv(m.mesh, *m.camera);
        } else {
            apply_source_uv(m.mesh, source, box, aspect_of(m));
        }
        for (Texture& texture : m.textures) apply_mask(texture);
    }
    return meshes;
}

void reload_pictures(const SourceParams& source, std::vector<TexturedMesh>& meshes, const Progress& progress,
                     const PictureReaders& readers) {
    assert(meshes.size() == source.meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const MeshInput& input = source.meshes[m];
        for (std::size_t i = 0; i < meshes[m].textures.size(); ++i) {
            Texture& texture = meshes[m].textures[i];
            if (texture.image.width == 0) continue;  // no face uses it
            if (texture.summary == painted_summary) continue;
            const PictureLoader load = [&](const std::vector<fs::path>& files, Wrap wrap) {
                return load_picture(files, source, wrap, progress, readers);
            };
            const Wrap wrap = default_wrap(source, own_wrap(input));
            texture =
                input.texture.empty() ? texture_of(meshes[m].mesh, i, wrap, load) : load(input.texture, wrap);
            apply_mask(texture);
        }
    }
}

}  // namespace astrosplat
