// Rules between parameters, each with its message.
#include "scene/check.h"

#include <fmt/format.h>

#include "bodies/detail_levels.h"
#include "camera/camera.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/text.h"
#include "scene/animate.h"
#include "scene/frames.h"
#include "scene/layer_setup.h"
#include "source/mesh.h"

namespace astrosplat {
namespace {

struct Checker {
    std::string file;
    const Places& places;

    /// Of the key, or of what it is in: the [[layer]] at least.
    std::string nearest_place(ParameterKey key) const {
        for (; !key.empty(); key = key.parent())
            if (const auto found = places.find(key); found != places.end()) return found->second;
        return file;
    }

    /// Fails unless `holds`; `keys` are those the rule is about, the message is "KEY: expected ...,
    /// found ...".
    void require(bool holds, std::initializer_list<ParameterKey> keys, const std::string& message) const {
        if (holds) return;
        ParameterKey named = *keys.begin();
        std::string place = nearest_place(named);
        for (const ParameterKey& key : keys) {
            const auto found = places.find(key);
            if (found == places.end()) continue;
            place = found->second;
            named = key;
        }
        throw InputError(fmt::format("{}: {}: {}", place, named, message));
    }
};

/// Of density or of opacity.
template <class Curve>
void check_curve(const Curve& curve, const ParameterKey& at, const Checker& check) {
    check.require(curve.shape != Curve::Shape::curve || curve.points.size() >= 2,
                  {at / "points", at / "shape"},
                  "expected at least 2 points for shape \"curve\", found none");
}

void check_crops(const std::vector<Crop>& crops, const ParameterKey& at, const Checker& check) {
    std::size_t outlines = 0;
    for (std::size_t i = 0; i < crops.size(); ++i) {
        if (crops[i].shape != Crop::Shape::outline) continue;
        check.require(++outlines <= most_outlines, {at / i / "shape"},
                      fmt::format("expected at most {} outlines, found more", most_outlines));
        std::string problem;
        try {
            outline_lines(crops[i].outline);
        } catch (const InputError& error) {
            problem = error.what();
        }
        check.require(problem.empty(), {at / i / (crops[i].outline.empty() ? "shape" : "outline")}, problem);
    }
}

void check_look(const Look& look, const ParameterKey& at, const Checker& check) {
    check_crops(look.crop, at / "crop", check);
    check_curve(look.pdf, at / "pdf", check);
    for (std::size_t i = 0; i < look.thickness.stops.size(); ++i)
        check_curve(look.thickness.stops[i].pdf, at / "thickness.keys" / i, check);
    check.require(look.thickness.map.empty() || !look.thickness.stops.empty(), {at / "thickness.map"},
                  "expected thickness.keys that the map's colours stand for, found none");
    check.require(!look.thickness.map.empty() || look.thickness.stops.size() <= 1, {at / "thickness.keys"},
                  "expected a thickness.map for several stops, found none");
    check_curve(look.vertical, at / "vertical", check);
    check.require(
        look.radius.min <= look.radius.max, {at / "radius.min", at / "radius.max"},
        fmt::format("expected min not above max, found {} and {}", look.radius.min, look.radius.max));
}

/// The fault of a range or an ellipse, if it has one.
std::string problem_of(const std::optional<glm::dvec2>& range) {
    if (!range || range->x < range->y) return "";
    return fmt::format("expected the lower end first, found {} and {}", range->x, range->y);
}
std::string problem_of(const std::optional<glm::dvec4>& ellipse) {
    if (!ellipse || (ellipse->z > 0.0 && ellipse->w > 0.0)) return "";
    return fmt::format("expected half axes above 0, found {} and {}", ellipse->z, ellipse->w);
}

void check_mask_terms(const MaskTerms& mask, const ParameterKey& at, const Checker& check) {
    for (const auto& [key, message] : {KeyProblem{"luminance", problem_of(mask.luminance)},
                                       {"saturation", problem_of(mask.saturation)},
                                       {"ellipse", problem_of(mask.ellipse)}})
        check.require(message.empty(), {at / key}, message);
}

void check_masks(const std::vector<MaskParams>& masks, const ParameterKey& at, const Checker& check) {
    for (std::size_t i = 0; i < masks.size(); ++i) {
        check_mask_terms(masks[i], at / i, check);
        for (std::size_t k = 0; k < masks[i].any.size(); ++k)
            check_mask_terms(masks[i].any[k], at / i / "any" / k, check);
    }
}

void check_uv_camera(const UvCamera& camera, const ParameterKey& at, const Checker& check) {
    const ParameterKey own = at / "uv_camera";
    check.require(camera.position.has_value(), {own / "position", at / "uv"},
                  "expected the place of the camera for uv \"camera\", found none");
    check.require(camera.position != camera.target, {own / "target", own / "position"},
                  "expected target and position apart, found the same point");
    check.require(camera.up != glm::dvec3(0.0), {own / "up"}, "expected a direction, found 0, 0, 0");
}

void check_prepare(const PrepareParams& prepare, const ParameterKey& at, const Checker& check) {
    const std::optional<KeyProblem> problem = problem_of(prepare);
    if (problem) check.require(false, {at / problem->key}, problem->message);
}

void check_stars(const StarsParams& stars, const ParameterKey& at, const Checker& check) {
    check.require(stars.like.empty() || (stars.along.empty() && !stars.catalogue.empty()),
                  {at / "like", at / "along"},
                  stars.along.empty() ? "expected a catalogue, the stars.csv of the picture, found none"
                                      : "expected like or along, found both");
    check.require(!stars.catalogue.empty() || !stars.along.empty(), {at / "catalogue", at / "kind"},
                  "expected a star catalogue, or along = \"camera\", for kind \"stars\", found none");
    check.require(stars.wings.share + stars.spikes.share <= 1.0, {at / "wings.share", at / "spikes.share"},
                  fmt::format("expected shares of wings and spikes of at most 1 together, found {} and {}",
                              short_number(stars.wings.share), short_number(stars.spikes.share)));
}

void check_source(const SourceParams& source, const ParameterKey& at, const Checker& check) {
    check.require(source.kind != SourceKind::mesh || !source.meshes.empty(), {at / "meshes", at / "kind"},
                  "expected at least one mesh, found none");
    for (std::size_t i = 0; i < source.meshes.size(); ++i) {
        const ParameterKey mesh = at / "meshes" / i;
        check.require(!source.meshes[i].mesh.empty(), {mesh / "mesh"},
                      fmt::format("expected a file or {}, found none", fmt::join(builtin_meshes, ", ")));
        const ShapeParams& shape = source.meshes[i].shape;
        check.require(source.meshes[i].mesh != "revolution" || shape.outline.size() >= 2,
                      {mesh / "outline", mesh / "mesh"},
                      "expected at least 2 points for mesh \"revolution\", found none");
        check.require(std::ranges::all_of(shape.outline, [](const glm::vec2& p) { return p.x >= 0.0f; }),
                      {mesh / "outline"}, "expected points [r, y] with r of at least 0, found one below");
        const std::size_t pictures = source.meshes[i].texture.size();
        check.require(
            pictures <= 1 || pictures == 3, {mesh / "texture"},
            fmt::format("expected one picture, or three for red, green and blue, found {}", pictures));
    }
    check.require(source.kind != SourceKind::splats || !source.file.empty(), {at / "file", at / "kind"},
                  "expected a splat file for kind \"splats\", found none");
    if (source.kind == SourceKind::stars) check_stars(source.stars, at, check);
    check.require(!source.voxels || source.voxel_size == 0.0, {at / "voxels", at / "voxel_size"},
                  "expected voxels or voxel_size, found both");
    check.require(source.splats == 0 || source.count == SourceParams().count, {at / "count", at / "splats"},
                  "expected count or splats, found both");
    check.require(source.splats == 0 || (!source.voxels && source.voxel_size == 0.0),
                  {at / "voxels", at / "voxel_size", at / "splats"},
                  "expected voxels, voxel_size or splats, found two of them");
    const std::string fault = fault_of_tiles(source.structure.detail_tiles);
    check.require(fault.empty(), {at / "structure" / "detail_tiles"}, fault);
    if (source.uv == UvMode::camera) check_uv_camera(source.uv_camera, at, check);
    const TextureSettings& t = source.texture;
    check_prepare(t.prepare, at / "prepare", check);
    check_masks(t.mask, at / "mask", check);
    check.require(!t.black || !t.white || *t.black < *t.white, {at / "black", at / "white"},
                  "expected black below white, found " +
                      (t.black && t.white ? short_number(*t.black) + " and " + short_number(*t.white) : ""));
}

/// The layer that stars take their places from.
void check_like(const Scene& scene, const LayerParams& layer, const Checker& check) {
    const std::string& name = layer.source.stars.like;
    if (layer.source.kind != SourceKind::stars || name.empty()) return;
    const auto found = std::ranges::find(scene.layers, name, &LayerParams::name);
    const bool has_picture = found != scene.layers.end() && found->source.kind == SourceKind::mesh;
    check.require(has_picture, {layer_key(layer.name) / "source.like"},
                  fmt::format("expected the name of a layer with a picture, found '{}'", name));
}

void check_layer(const LayerParams& layer, const Checker& check) {
    const ParameterKey at = layer_key(layer.name);
    check_source(layer.source, at / "source", check);
    check_look(layer.look, at / "look", check);
    check.require(layer.render.hybrid_from_deg < layer.render.hybrid_to_deg,
                  {at / "render.hybrid.from_deg", at / "render.hybrid.to_deg"},
                  fmt::format("expected from_deg below to_deg, found {} and {}", layer.render.hybrid_from_deg,
                              layer.render.hybrid_to_deg));
    check.require(layer.axis != glm::dvec3(0.0), {at / "axis"}, "expected a direction, found 0, 0, 0");
}

/// The sizes that planetariums take as dome masters.
void check_dome(const OutputParams& output, const Checker& check) {
    constexpr std::int64_t least_px = 1024, largest_px = 8192;
    const bool fits = output.width == output.height && least_px <= output.width && output.width <= largest_px;
    check.require(!is_dome(output) || fits, {"output.resolution"},
                  fmt::format("expected a square of {} to {} px for the preset dome, found {} x {}", least_px,
                              largest_px, output.width, output.height));
}

}  // namespace

bool is_dome(const OutputParams& output) { return output.preset.stem() == "dome"; }

std::optional<KeyProblem> problem_of(const PrepareParams& prepare) {
    for (const KeyProblem& problem :
         {KeyProblem{"ellipse", problem_of(prepare.ellipse)}, {"alpha", problem_of(prepare.alpha)}})
        if (!problem.message.empty()) return problem;
    return {};
}

void check_renderable(const Scene& scene, const Places& places) {
    const Checker check{scene.file.string(), places};
    if (scene.layers.empty())
        throw InputError(fmt::format("{}: expected at least one [[layer]], found none", check.file));
    for (const LayerParams& layer : scene.layers) {
        if (!ever_visible(scene, layer)) continue;
        const ParameterKey at = layer_key(layer.name) / "source";
        const SourceParams& source = layer.source;
        check.require(!follows_camera(source) || has_camera_places(scene), {at / "along"},
                      "expected camera.position, or keyframes of it, for stars along the camera, found none");
        check.require(
            source.kind != SourceKind::splats || kind_of(format_of_file(source.file)) == FileKind::splats,
            {at / "file"},
            "expected a file ending in " + alternatives(endings_of({FileKind::splats})) + ", found '" +
                source.file.string() + "'" + std::string(conversion_advice(source.file)));
    }
}

void check_layer_name(const std::string& name, const std::string& place) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    bool good = !name.empty() && letter(name[0]);
    for (const char c : name) good = good && (letter(c) || (c >= '0' && c <= '9') || c == '_');
    if (good) return;
    throw InputError(fmt::format(
        "{}: layer.name: expected letters, digits and _ beginning with a letter, found '{}'", place, name));
}

void check_scene(const Scene& scene, const std::string& file, const Places& places) {
    const Checker check{file, places};
    const auto check_frames = [&](const std::string& text, const ParameterKey& key) {
        parse_frames(text, fmt::format("{}: {}", place_of(places, key, file), key.generic()));
    };
    check_frames(scene.output.frames, "output.frames");
    check.require(!scene.output.path.empty(), {"output.path"}, "expected a file name, found an empty one");
    check_dome(scene.output, check);
    const CameraParams& c = scene.camera;
    check.require(c.up != glm::dvec3(0.0), {"camera.up"}, "expected a direction, found 0, 0, 0");
    check.require(!c.rotation || *c.rotation != glm::dvec4(0.0), {"camera.rotation"},
                  "expected a quaternion that is not zero, found 0, 0, 0, 0");
    check.require(c.far == 0.0 || c.far > c.near, {"camera.near", "camera.far"},
                  fmt::format("expected far beyond near or 0, found {} and {}", short_number(c.near),
                              short_number(c.far)));
    const EnvironmentParams& e = scene.environment;
    check.require(
        e.cube.empty() || e.cube.size() == 6, {"environment.cube"},
        fmt::format("expected six pictures of the faces of a cube, in the order +x -x +y -y +z -z, found {}",
                    e.cube.size()));
    check.require(!e.image.empty() + !e.cube.empty() + !e.tile.empty() <= 1,
                  {"environment.image", "environment.cube", "environment.tile"},
                  e.tile.empty() ? "expected image or cube, found both"
                                 : "expected image, cube or tile, found several of them");
    for (std::size_t i = 0; i < scene.references.size(); ++i)
        if (const std::string& frames = scene.references[i].frames; !frames.empty())
            check_frames(frames, ParameterKey("reference") / i / "frames");
    for (const LayerParams& layer : scene.layers) check_layer(layer, check);
    for (const LayerParams& layer : scene.layers) check_like(scene, layer, check);
}

}  // namespace astrosplat
