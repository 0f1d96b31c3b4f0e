// One line for each thing that a generated set depends on.
#include "sets/recipe.h"

#include <fmt/format.h>

#include <type_traits>

#include "core/error.h"
#include "core/hash.h"
#include "generate/lattice.h"
#include "source/mesh.h"

namespace astrosplat {
namespace {

// A value, the numbers of a vector, an enum as its number, "auto" where there is none.
template <class T>
std::string text_of(const T& value) {
    if constexpr (std::is_enum_v<T>)
        return fmt::format("{}", int(value));
    else
        return fmt::format("{}", value);
}
std::string text_of(const glm::dvec2& v) { return fmt::format("{} {}", v.x, v.y); }
std::string text_of(const glm::dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }
std::string text_of(const glm::dvec4& v) { return fmt::format("{} {} {} {}", v.x, v.y, v.z, v.w); }
template <class T>
std::string text_of(const std::optional<T>& v) {
    return v ? text_of(*v) : "auto";
}

// "NAME VALUE VALUE ..." and the line's end.
template <class... Values>
std::string line(std::string_view name, const Values&... values) {
    return std::string(name) + ((" " + text_of(values)) + ... + "\n");
}

std::string file_line(std::string_view what, const fs::path& file, const Progress& progress) {
    return line(what, sha256_of_file(file, progress), file.extension().string());
}

// The parameters of the shape of that name.
std::string shape_lines(const fs::path& name, const ShapeParams& shape, const Progress& progress) {
    const auto& [outline, width, waist, thickness, opening, flattening, shells, concentration, tube,
                 depth_map, depth, blur] = shape;
    std::string text;
    if (name == "revolution")
        for (const glm::vec2& p : outline) text += line("outline", p.x, p.y);
    if (name == "hourglass") text = line("width", width, "waist", waist);
    if (name == "shell") text = line("thickness", thickness);
    if (name == "bubble") text = line("opening", opening);
    if (name == "spheroid")
        text = line("flattening", flattening, "shells", shells, "concentration", concentration);
    if (name == "ring") text = line("tube", tube);
    if (name != "sheet") return text;
    text = line("depth", depth, "blur", blur);
    return text + (depth_map.empty() ? "" : file_line("depth map", depth_map, progress));
}

std::string mesh_lines(const MeshInput& input, const Progress& progress) {
    const auto& [mesh, texture, relief, shape] = input;
    std::string text;
    if (is_builtin_mesh(mesh)) {
        text = line("built-in", mesh.string());
        if (mesh == "relief") text += line("relief", relief);
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

std::string range_text(const std::optional<glm::dvec2>& range) { return range ? text_of(*range) : "-"; }

std::string mask_line(std::string_view what, const MaskTerms& terms, const Progress& progress) {
    const auto& [luminance, hue, saturation, ellipse, turn, image, derive, feather, invert] = terms;
    const std::string round = ellipse ? " ellipse " + text_of(*ellipse) + " " + text_of(turn) : "";
    return line(what, "luminance", range_text(luminance), "hue", range_text(hue), "saturation",
                range_text(saturation), "derive", derive, "feather", feather, "invert",
                text_of(invert) + round) +
           (image.empty() ? "" : file_line("mask picture", image, progress));
}

// Nothing where nothing is used, so that sets made before there was a choice keep their names.
std::string rework_lines(const TextureSettings& settings, const Progress& progress) {
    std::string text;
    if (settings.derive != Derived::none) text += line("derive", settings.derive);
    if (settings.smooth > 0.0) text += line("smooth", settings.smooth);
    if (settings.detail > 0.0) text += line("detail", settings.detail);
    for (const MaskParams& mask : settings.mask) {
        text += mask_line("mask", mask, progress);
        for (const MaskTerms& terms : mask.any) text += mask_line("or", terms, progress);
    }
    return text;
}

// Nothing where nothing is prepared, likewise.
std::string prepare_lines(const PrepareParams& params, const Progress& progress) {
    const auto& [align, starless, fill, stars, threshold, saturation, background, lupton, q, lupton_stretch,
                 ellipse, turn, feather, mask, alpha] = params;
    if (!prepares(params)) return "";
    std::string text = line("prepare", prepare_version);
    if (!align.empty()) text += file_line("align", align, progress);
    if (!starless.empty()) text += file_line("starless", starless, progress);
    if (!fill.empty()) text += file_line("fill", fill, progress);
    if (stars == PrepareParams::Stars::remove) text += line("stars removed", threshold, saturation);
    text += line("background", background);
    if (lupton) text += line("lupton", q, lupton_stretch);
    if (ellipse) text += line("ellipse", *ellipse, turn, feather);
    if (!mask.empty()) text += file_line("cut", mask, progress);
    return text + line("alpha from", range_text(alpha));
}

std::string texture_lines(const TextureSettings& settings) {
    [[maybe_unused]] const auto& [colorspace, alpha, unpremultiply, hdu, plane, stretch, black, white,
                                  softening, filter, wrap, derive, smooth, detail, mask, prepare] = settings;
    return line("colorspace", colorspace) + line("alpha", alpha) + line("unpremultiply", unpremultiply) +
           line("hdu", hdu) + line("plane", plane) + line("stretch", stretch) + line("black", black) +
           line("white", white) + line("softening", softening) + line("filter", filter) + line("wrap", wrap);
}

std::string lattice_lines(const SourceParams& source) {
    const std::string size = source.voxels
                                 ? line("voxels", source.voxels->x, source.voxels->y, source.voxels->z)
                             : source.voxel_size != 0 ? line("voxel_size", source.voxel_size)
                             : source.splats > 0      ? line("splats", source.splats)
                                                      : line("count", source.count);
    return size + line("buffer", source.buffer ? text_of(*source.buffer) : "auto");
}

std::string galaxy_line(const GalaxyParams& galaxy) {
    const auto& [inclination, position_angle, center, near_side, bulge] = galaxy;
    return line("galaxy", inclination, position_angle, range_text(center), near_side, bulge);
}

// How the galaxies of a disk lie.
std::string galaxy_lines(const StructureParams& params) {
    if (params.kind != StructureKind::disk) return "";
    if (params.galaxies.empty()) return galaxy_line(params.galaxy) + line("spiral", params.spiral);
    std::string text = line("spiral", params.spiral);
    for (const GalaxyParams& galaxy : params.galaxies) text += galaxy_line(galaxy);
    return text;
}

// Nothing for columns, so that sets made before there was a choice keep their names.
std::string structure_lines(const SourceParams& source) {
    [[maybe_unused]] const auto& [kind, height, depth, clumps, flare, warp, galaxy, galaxies, spiral,
                                  axis_angle, tilt, stars, dust, opacity, density, border, margin, detail,
                                  detail_tiles, detail_strength, most_texels] = source.structure;
    if (kind == StructureKind::columns) return "";
    return line("structure", kind) + line("height", height) + line("depth", depth) + line("clumps", clumps) +
           line("stars", finds_stars(source)) +
           (flare != 0.0 || warp != 0.0 ? line("flare", flare) + line("warp", warp) : "") +
           galaxy_lines(source.structure) +
           (kind == StructureKind::axis ? line("axis angle", axis_angle) + line("tilt", tilt) : "") +
           line("dust", dust) + line("opacity", opacity) + line("density", density) + line("border", border) +
           (margin > 0.0 ? line("margin", margin) : "") +
           (detail > 0 ? line("detail", detail, "strength", detail_strength) + line("tiles", detail_tiles)
                       : "") +
           (most_texels > 0 ? line("most texels", most_texels) : "");
}

std::string camera_line(const UvCamera& camera) {
    const auto& [position, target, up, fov, height] = camera;
    return line("uv camera", position ? text_of(*position) : "-", "target", target, "up", up,
                height > 0.0 ? "height" : "fov", height > 0.0 ? height : fov);
}

// Nothing for a picture that is stretched over the meshes and the same in front and behind.
std::string projection_lines(const SourceParams& source) {
    if (source.uv == UvMode::mesh) return "";
    if (source.uv == UvMode::camera) return camera_line(source.uv_camera);
    std::string text;
    if (source.uv_width > 0.0) text = line("uv width", source.uv_width, "center", source.uv_center);
    if (source.back != BackWall::same) text += line("back", source.back);
    return text;
}

std::string mesh_line(const Mesh& mesh) {
    Sha256 hash;
    const auto add = [&](const auto& list) {
        hash.add(list.data(), list.size() * sizeof list[0]);
        hash.add(fmt::format(" {}\n", list.size()));
    };
    add(mesh.positions), add(mesh.uvs), add(mesh.triangles);
    return line("mesh", hash.hex());
}

std::string camera_line(const Camera& camera) {
    std::string text = line("camera", camera.projection, camera.focal_px, camera.center_x_px,
                            camera.center_y_px, camera.near, camera.aspect);
    text += line("at", camera.eye);
    for (int i = 0; i < 3; ++i) text += line("axis", camera.world_from_camera[i]);
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
    std::string text = line("set", set_version, "of astrosplat", ASTROSPLAT_VERSION);
    for (const MeshInput& input : meshes) text += mesh_lines(input, progress);
    text += texture_lines(texture) + rework_lines(texture, progress) +
            prepare_lines(texture.prepare, progress) + lattice_lines(source);
    text += structure_lines(source) + projection_lines(source);
    return text + line("jitter", jitter) + line("max_distance", max_distance) + line("uv", uv) +
           line("seed", resolved_seed(seed, layer_name));
} catch (const InputError&) {
    return {};
}

std::string prepared_recipe_text(const std::vector<fs::path>& files, const TextureSettings& settings,
                                 const Progress& progress) try {
    std::string text = line("picture of astrosplat", ASTROSPLAT_VERSION);
    for (const fs::path& file : files) text += file_line("texture", file, progress);
    return text + texture_lines(settings) + prepare_lines(settings.prepare, progress);
} catch (const InputError&) {
    return {};
}

std::string sky_recipe_text(const fs::path& file, const SkyTiling& tiling, const Progress& progress) try {
    const auto& [height_deg, seed, face_px] = tiling;
    return line("sky", sky_version, "of astrosplat", ASTROSPLAT_VERSION) + file_line("tile", file, progress) +
           line("height", height_deg, "seed", seed, "px", face_px);
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
    std::string text = line("geometry", set_version, "of astrosplat", ASTROSPLAT_VERSION);
    for (const TexturedMesh& m : meshes) text += mesh_line(m.mesh) + (m.camera ? camera_line(*m.camera) : "");
    text += line("lattice", lattice.n.x, lattice.n.y, lattice.n.z) +
            line("from", lattice.box.lo, "to", lattice.box.hi) + line("jitter", jitter) +
            line("max_distance", max_distance) + line("seed", seed);
    return {text, Sha256().add(text).hex()};
}

}  // namespace astrosplat
