// One line for each thing that a generated set depends on.
#include "sets/recipe.h"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "generate/lattice.h"
#include "source/mesh.h"
#include "source/obj.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

std::string file_line(const char* what, const fs::path& file, const Progress& progress) {
    return fmt::format("{} {} {}\n", what, sha256_of_file(file, progress), file.extension().string());
}

// The parameters of the shape of that name.
std::string shape_lines(const fs::path& name, const ShapeParams& shape, const Progress& progress) {
    const auto& [outline, width, waist, thickness, opening, flattening, shells, concentration, tube,
                 depth_map, depth, blur] = shape;
    std::string text;
    if (name == "revolution")
        for (const glm::vec2& p : outline) text += fmt::format("outline {} {}\n", p.x, p.y);
    if (name == "hourglass") text = fmt::format("width {} waist {}\n", width, waist);
    if (name == "shell") text = fmt::format("thickness {}\n", thickness);
    if (name == "bubble") text = fmt::format("opening {}\n", opening);
    if (name == "spheroid")
        text = fmt::format("flattening {} shells {} concentration {}\n", flattening, shells, concentration);
    if (name == "ring") text = fmt::format("tube {}\n", tube);
    if (name != "sheet") return text;
    text = fmt::format("depth {} blur {}\n", depth, blur);
    return text + (depth_map.empty() ? "" : file_line("depth map", depth_map, progress));
}

std::string mesh_lines(const MeshInput& input, const Progress& progress) {
    const auto& [mesh, texture, relief, shape] = input;
    std::string text;
    if (is_builtin_mesh(mesh)) {
        text = fmt::format("built-in {}\n", mesh.string());
        if (mesh == "relief") text += fmt::format("relief {}\n", relief);
        text += shape_lines(mesh, shape, progress);
    } else {
        text = file_line("mesh", mesh, progress);
        if (texture.empty())
            for (const fs::path& file : obj_materials(mesh, progress))
                text += file_line("material", file, progress);
    }
    for (const fs::path& file : texture) text += file_line("texture", file, progress);
    return text;
}

std::string range_text(const std::optional<glm::dvec2>& range) {
    return range ? fmt::format("{} {}", range->x, range->y) : "-";
}

std::string mask_line(const char* what, const MaskTerms& terms, const Progress& progress) {
    const auto& [luminance, hue, saturation, ellipse, turn, image, derive, feather, invert] = terms;
    std::string text = fmt::format("{} luminance {} hue {} saturation {} derive {} feather {} invert {}",
                                   what, range_text(luminance), range_text(hue), range_text(saturation),
                                   static_cast<int>(derive), feather, invert);
    if (ellipse)
        text += fmt::format(" ellipse {} {} {} {} {}", ellipse->x, ellipse->y, ellipse->z, ellipse->w, turn);
    return text + "\n" + (image.empty() ? "" : file_line("mask picture", image, progress));
}

// Nothing where nothing is used, so that sets made before there was a choice keep their names.
std::string rework_lines(const TextureSettings& settings, const Progress& progress) {
    std::string text;
    if (settings.derive != Derived::none)
        text += fmt::format("derive {}\n", static_cast<int>(settings.derive));
    if (settings.smooth > 0.0) text += fmt::format("smooth {}\n", settings.smooth);
    if (settings.detail > 0.0) text += fmt::format("detail {}\n", settings.detail);
    for (const MaskParams& mask : settings.mask) {
        text += mask_line("mask", mask, progress);
        for (const MaskTerms& terms : mask.any) text += mask_line("or", terms, progress);
    }
    return text;
}

// Nothing where nothing is prepared, likewise.
std::string prepare_lines(const PrepareParams& params, const Progress& progress) {
    const auto& [align, fill, stars, threshold, saturation, background, lupton, q, lupton_stretch, ellipse,
                 turn, feather, mask, alpha] = params;
    if (!prepares(params)) return "";
    std::string text = fmt::format("prepare {}\n", prepare_version);
    if (!align.empty()) text += file_line("align", align, progress);
    if (!fill.empty()) text += file_line("fill", fill, progress);
    if (stars == PrepareParams::Stars::remove)
        text += fmt::format("stars removed {} {}\n", threshold,
                            saturation ? fmt::format("{}", *saturation) : "auto");
    text += fmt::format("background {}\n", static_cast<int>(background));
    if (lupton) text += fmt::format("lupton {} {}\n", q, lupton_stretch);
    if (ellipse)
        text += fmt::format("ellipse {} {} {} {} {} {}\n", ellipse->x, ellipse->y, ellipse->z, ellipse->w,
                            turn, feather);
    if (!mask.empty()) text += file_line("cut", mask, progress);
    return text + fmt::format("alpha from {}\n", range_text(alpha));
}

std::string texture_lines(const TextureSettings& settings) {
    [[maybe_unused]] const auto& [colorspace, alpha, unpremultiply, hdu, plane, stretch, black, white,
                                  softening, filter, wrap, derive, smooth, detail, mask, prepare] = settings;
    const auto limit = [](const std::optional<double>& v) { return v ? fmt::format("{}", *v) : "auto"; };
    return fmt::format("colorspace {}\nalpha {}\nunpremultiply {}\nhdu {}\nplane {}\nstretch {}\n",
                       static_cast<int>(colorspace), static_cast<int>(alpha), static_cast<int>(unpremultiply),
                       hdu, plane, static_cast<int>(stretch)) +
           fmt::format("black {}\nwhite {}\nsoftening {}\nfilter {}\nwrap {}\n", limit(black), limit(white),
                       softening, static_cast<int>(filter), static_cast<int>(wrap));
}

std::string lattice_lines(const SourceParams& source) {
    const std::string size =
        source.voxels ? fmt::format("voxels {} {} {}", source.voxels->x, source.voxels->y, source.voxels->z)
        : source.voxel_size != 0 ? fmt::format("voxel_size {}", source.voxel_size)
        : source.splats > 0      ? fmt::format("splats {}", source.splats)
                                 : fmt::format("count {}", source.count);
    const std::string buffer =
        source.buffer ? fmt::format("{} {} {}", source.buffer->x, source.buffer->y, source.buffer->z)
                      : "auto";
    return fmt::format("{}\nbuffer {}\n", size, buffer);
}

// Nothing for columns, so that sets made before there was a choice keep their names.
std::string structure_lines(const SourceParams& source) {
    const auto& [kind, height, depth, clumps, flare, warp, stars, dust, opacity, density, border, margin,
                 most_texels] = source.structure;
    if (kind == StructureKind::columns) return "";
    return fmt::format("structure {}\nheight {}\ndepth {}\nclumps {}\nstars {}\n", static_cast<int>(kind),
                       height, depth, clumps, finds_stars(source)) +
           (flare != 0.0 || warp != 0.0 ? fmt::format("flare {}\nwarp {}\n", flare, warp) : "") +
           fmt::format("dust {}\n", dust ? fmt::format("{}", *dust) : "auto") +
           fmt::format("opacity {}\ndensity {}\nborder {}\n", opacity, density, border) +
           (margin > 0.0 ? fmt::format("margin {}\n", margin) : "") +
           (most_texels > 0 ? fmt::format("most texels {}\n", most_texels) : "");
}

std::string camera_line(const UvCamera& camera) {
    const auto& [position, target, up, fov, height] = camera;
    const auto text = [](const glm::dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
    return fmt::format("uv camera {} target {} up {} ", position ? text(*position) : "-", text(target),
                       text(up)) +
           (height > 0.0 ? fmt::format("height {}\n", height) : fmt::format("fov {}\n", fov));
}

// Nothing for a picture that is stretched over the meshes and the same in front and behind.
std::string projection_lines(const SourceParams& source) {
    if (source.uv == UvMode::mesh) return "";
    if (source.uv == UvMode::camera) return camera_line(source.uv_camera);
    const glm::dvec3& center = source.uv_center;
    std::string text;
    if (source.uv_width > 0.0)
        text = fmt::format("uv width {} center {} {} {}\n", source.uv_width, center.x, center.y, center.z);
    if (source.back != BackWall::same) text += fmt::format("back {}\n", static_cast<int>(source.back));
    return text;
}

std::string mesh_line(const Mesh& mesh) {
    Sha256 hash;
    const auto add = [&](const auto& list) {
        hash.add(list.data(), list.size() * sizeof list[0]);
        hash.add(fmt::format(" {}\n", list.size()));
    };
    add(mesh.positions), add(mesh.uvs), add(mesh.triangles);
    return fmt::format("mesh {}\n", hash.hex());
}

std::string camera_line(const Camera& camera) {
    std::string text =
        fmt::format("camera {} {} {} {} {} {}\n", static_cast<int>(camera.projection), camera.focal_px,
                    camera.center_x_px, camera.center_y_px, camera.near, camera.aspect);
    text += fmt::format("at {} {} {}\n", camera.eye.x, camera.eye.y, camera.eye.z);
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3& axis = camera.world_from_camera[i];
        text += fmt::format("axis {} {} {}\n", axis.x, axis.y, axis.z);
    }
    return text;
}

}  // namespace

std::string recipe_text(const SourceParams& source, const std::string& layer_name,
                        const Progress& progress) try {
    assert(source.kind == SourceKind::mesh);
    // Names all fields, so that a new one cannot be forgotten: either it belongs below, or among the unused.
    [[maybe_unused]] const auto& [kind, meshes, texture, buffer, voxels, voxel_size, count, splats, jitter,
                                  max_distance, uv, uv_width, uv_center, back, uv_camera, structure, seed,
                                  file, stars] = source;
    std::string text = fmt::format("set {} of astrosplat {}\n", set_version, ASTROSPLAT_VERSION);
    for (const MeshInput& input : meshes) text += mesh_lines(input, progress);
    text += texture_lines(texture) + rework_lines(texture, progress) +
            prepare_lines(texture.prepare, progress) + lattice_lines(source);
    text += structure_lines(source) + projection_lines(source);
    return text + fmt::format("jitter {}\nmax_distance {}\nuv {}\nseed {}\n", jitter, max_distance,
                              static_cast<int>(uv), resolved_seed(seed, layer_name));
} catch (const InputError&) {
    return {};
}

std::string prepared_recipe_text(const std::vector<fs::path>& files, const TextureSettings& settings,
                                 const Progress& progress) try {
    std::string text = fmt::format("picture of astrosplat {}\n", ASTROSPLAT_VERSION);
    for (const fs::path& file : files) text += file_line("texture", file, progress);
    return text + texture_lines(settings) + prepare_lines(settings.prepare, progress);
} catch (const InputError&) {
    return {};
}

std::string sky_recipe_text(const fs::path& file, const SkyTiling& tiling, const Progress& progress) try {
    const auto& [height_deg, seed, face_px] = tiling;
    return fmt::format("sky {} of astrosplat {}\n{}height {} seed {} px {}\n", sky_version,
                       ASTROSPLAT_VERSION, file_line("tile", file, progress), height_deg, seed, face_px);
} catch (const InputError&) {
    return {};
}

Recipe recipe_of(const SourceParams& source, const std::string& layer_name, const Progress& progress) {
    std::string text = recipe_text(source, layer_name, progress);
    std::string name = text.empty() ? "" : Sha256().add(text).hex();
    return {std::move(text), std::move(name)};
}

Recipe geometry_recipe(const ColumnPlan& plan) {
    const auto& [meshes, lattice, max_distance, jitter, seed] = plan;
    const Bounds& box = lattice.box;
    std::string text = fmt::format("geometry {} of astrosplat {}\n", set_version, ASTROSPLAT_VERSION);
    for (const TexturedMesh& m : meshes) text += mesh_line(m.mesh) + (m.camera ? camera_line(*m.camera) : "");
    text += fmt::format("lattice {} {} {}\n", lattice.n.x, lattice.n.y, lattice.n.z);
    text += fmt::format("from {} {} {} to {} {} {}\n", box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y,
                        box.hi.z);
    text += fmt::format("jitter {}\nmax_distance {}\nseed {}\n", jitter, max_distance, seed);
    return {text, Sha256().add(text).hex()};
}

}  // namespace astrosplat
