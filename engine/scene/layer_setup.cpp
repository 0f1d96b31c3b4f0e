#include "scene/layer_setup.h"

#include <fmt/format.h>

#include "camera/keyframe.h"
#include "core/error.h"
#include "core/rotation.h"
#include "generate/lattice.h"
#include "render/footprint.h"
#include "scene/animate.h"
#include "source/mesh.h"
#include "stars/star_set.h"

namespace astrosplat {
namespace {

/// By Blend.
constexpr ColumnLaw column_laws[] = {ColumnLaw::transmittance, ColumnLaw::sum,
                                     ColumnLaw::screen,        ColumnLaw::maximum,
                                     ColumnLaw::transmittance, ColumnLaw::transmittance};
static_assert(std::size(column_laws) == names_of(Blend{}).size());

StarPsf star_psf(const StarsParams& stars) {
    StarPsf psf;
    psf.core_px = float(stars.psf);
    psf.wing_share = float(stars.wings.share);
    psf.wing_px = float(stars.wings.px);
    psf.wing_power = float(stars.wings.power);
    psf.spike_share = std::min(float(stars.spikes.share), 1.0f - psf.wing_share);
    psf.vanes = stars.spikes.vanes;
    psf.vane_deg = float(stars.spikes.angle);
    psf.spike_px = float(stars.spikes.px);
    return psf;
}

constexpr int places_on_path = 1024;  // about
constexpr double tolerance = 0.01;    // of the distance that stars lie from the path

const Track* position_track(const Scene& scene) { return moving_track(scene, "camera.position"); }

/// Places of the scene's camera: of one that is animated, in equal steps between its keyframes; empty for one
/// without a position.
std::vector<glm::dvec3> camera_places(const Scene& scene) {
    const Track* const track = position_track(scene);
    if (!track)
        return scene.camera.position ? std::vector{*scene.camera.position} : std::vector<glm::dvec3>();
    const std::vector<Keyframe<glm::dvec3>> keyframes = position_keyframes(*track);
    const auto parts = int(keyframes.size()) - 1;
    const int steps = std::max(1, places_on_path / std::max(1, parts));  // between two keyframes
    std::vector<glm::dvec3> places;
    const auto add = [&](double frame) {
        places.push_back(evaluate_position(keyframes, frame, track->ends, track->constant_speed));
    };
    for (std::size_t k = 0; k + 1 < keyframes.size(); ++k)
        for (int i = 0; i < steps; ++i)
            add(keyframes[k].frame + (keyframes[k + 1].frame - keyframes[k].frame) * i / steps);
    add(keyframes.back().frame);
    return places;
}

}  // namespace

RenderLayer render_layer(const LayerParams& params) {
    RenderLayer layer;
    layer.name = params.name;
    layer.render = params.render;
    layer.world_from_layer = rotation_from_degrees(params.transform.rotate);
    layer.scale = params.transform.scale;
    layer.translate = params.transform.translate;
    layer.axis = params.axis;
    layer.seed = resolved_seed(params.source.seed, params.name);
    if (params.source.kind == SourceKind::stars) layer.stars = star_psf(params.source.stars);
    return layer;
}

RenderLayer render_layer(const Scene& scene, const LayerParams& params) {
    RenderLayer layer = render_layer(params);
    const LayerParams* const like = like_layer(scene, params);
    if (!like) return layer;
    const RenderLayer under = render_layer(*like);
    layer.translate = under.to_world(layer.translate);
    layer.world_from_layer = under.world_from_layer * layer.world_from_layer;
    layer.scale *= under.scale;
    return layer;
}

Look look_of(const LayerParams& params) {
    if (params.source.kind != SourceKind::stars) return params.look;
    Look look;
    look.grade = params.look.grade;
    return look;
}

LookInputs look_inputs(const LayerParams& params) {
    LookInputs inputs;
    inputs.axis = glm::vec3(params.axis);
    inputs.seed = resolved_seed(params.source.seed, params.name);
    inputs.falloff_integral = falloff_integral(params.render.falloff);
    inputs.falloff_variance = falloff_variance(params.render.falloff);
    inputs.column = column_laws[std::size_t(params.render.blend)];
    return inputs;
}

Bounds world_bounds(const Bounds& box, const RenderLayer& layer) {
    Bounds result;
    if (box.empty()) return result;
    for (int corner = 0; corner < 8; ++corner) result.add(layer.to_world(box.corner(corner)));
    return result;
}

void check_extent(const Bounds& box, const std::string& layer, double farthest) {
    if (box.empty()) return;
    for (int axis = 0; axis < 3; ++axis)
        for (const double x : {double(box.lo[axis]), double(box.hi[axis])})
            if (!(std::fabs(x) <= farthest))
                throw InputError(
                    fmt::format("{}: expected splats within {:g} scene units of 0, found one at {:g}",
                                layer_key(layer), farthest, x));
}

bool has_environment(const EnvironmentParams& params) {
    return !params.image.empty() || !params.cube.empty() || !params.tile.empty();
}

bool has_camera_places(const Scene& scene) { return scene.camera.position || position_track(scene); }

bool follows_camera(const SourceParams& source) {
    return source.kind == SourceKind::stars && source.stars.along == "camera";
}

const LayerParams* like_layer(const Scene& scene, const LayerParams& layer) {
    if (layer.source.kind != SourceKind::stars || layer.source.stars.like.empty()) return nullptr;
    const auto found = std::ranges::find(scene.layers, layer.source.stars.like, &LayerParams::name);
    return found == scene.layers.end() || found->source.kind != SourceKind::mesh ? nullptr : &*found;
}

double parsec_of(const Scene& scene, const LayerParams& layer) {
    constexpr double least = 1e-9, most = 1e9;  // as the key has it
    const StarsParams& stars = layer.source.stars;
    const bool by_scene = !stars.unit && scene.light_years_per_unit > 0.0 &&
                          layer.source.kind == SourceKind::stars && stars.like.empty();
    return by_scene ? std::clamp(parsec_ly / scene.light_years_per_unit, least, most)
                    : stars.unit.value_or(1.0);
}

SourceParams source_of(const Scene& scene, const LayerParams& layer) {
    SourceParams source = layer.source;
    if (const LayerParams* const like = like_layer(scene, layer)) {
        source = like->source;
        source.kind = SourceKind::stars;
        source.seed = layer.source.seed;
        source.stars = layer.source.stars;
        source.stars.like_seed = resolved_seed(like->source.seed, like->name);
    }
    if (source.kind == SourceKind::stars) source.stars.unit = parsec_of(scene, layer);
    if (!follows_camera(source)) return source;
    const std::vector<glm::dvec3> places = camera_places(scene);
    if (!places.empty()) source.stars.path = simplified_path(places, tolerance * source.stars.spread);
    return source;
}

std::vector<fs::path> named_files(const SourceParams& source) {
    if (source.kind == SourceKind::splats) return {source.file};
    if (source.kind == SourceKind::stars)
        return source.stars.catalogue.empty() ? std::vector<fs::path>() : std::vector{source.stars.catalogue};
    std::vector<fs::path> files;
    for (const MeshInput& input : source.meshes) {
        if (!is_builtin_mesh(input.mesh)) files.push_back(input.mesh);
        files.insert(files.end(), input.texture.begin(), input.texture.end());
        files.push_back(input.shape.depth_map);
    }
    const PrepareParams& prepare = source.texture.prepare;
    files.insert(files.end(), {prepare.align, prepare.starless, prepare.fill, prepare.mask});
    for (const MaskParams& mask : source.texture.mask) {
        files.push_back(mask.image);
        for (const MaskTerms& terms : mask.any) files.push_back(terms.image);
    }
    std::erase(files, fs::path());
    return files;
}

std::vector<fs::path> all_files(const SourceParams& source) {
    std::vector<fs::path> files = named_files(source);
    if (source.kind != SourceKind::mesh) return files;
    for (const MeshInput& input : source.meshes) {
        if (!has_own_pictures(input)) continue;
        const std::vector<fs::path> materials = obj_materials(input.mesh);
        files.insert(files.end(), materials.begin(), materials.end());
    }
    return files;
}

bool has_own_pictures(const MeshInput& input) {
    const auto is_empty = [](const fs::path& file) { return file.empty(); };
    return !is_builtin_mesh(input.mesh) && std::ranges::all_of(input.texture, is_empty);
}

std::vector<fs::path> picture_files(const Scene& scene) {
    std::vector<fs::path> files = scene.environment.cube;
    files.push_back(scene.environment.image);
    files.push_back(scene.environment.tile);
    for (const LayerParams& layer : scene.layers) files.push_back(layer.look.thickness.map);
    std::erase(files, fs::path());
    return files;
}

}  // namespace astrosplat
