// The canonical text of a frame, from the description of its parameters.
#include "frame/frame_hash.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "output/format.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "scene/layer_setup.h"
#include "source/mesh.h"

namespace astrosplat {
namespace {

// Reaches no pixel of any frame, or enters the hash by its effect.
bool is_elsewhere(const ParameterSpec& spec) {
    constexpr std::array<std::string_view, 6> keys = {"output.path",   "output.frames",      "output.fps",
                                                      "output.preset", "output.compression", "layer.preset"};
    return std::ranges::find(keys, spec.generic_key.text()) != keys.end() ||
           spec.generic_key.text().starts_with("camera.file_") || spec.generic_key.is_below("scene") ||
           spec.generic_key.is_below("provenance") || spec.generic_key.is_below("reference") ||
           spec.generic_key.is_below("output.ocio");
}

/// Keys of lenses that the camera does not have, of a pair and of blurs that are off.
bool is_idle(const ParameterSpec& spec, const CameraParams& camera) {
    const ParameterKey& key = spec.generic_key;
    if (key == "camera.eye" || key == "camera.eye_separation" || key == "camera.convergence")
        if (camera.eye == Eye::centre) return true;
    if (key == "camera.f_number" || key == "camera.focus_distance" || key == "camera.unit_mm")
        if (camera.f_number == 0.0) return true;
    if (key == "output.samples") return !is_blurred(camera);
    return is_of_another_lens(spec, camera.projection);
}

bool is_idle(const ParameterKey& key, const EnvironmentParams& environment) {
    return !environment.visible || !has_environment(environment) ||
           (key.text().starts_with("environment.tile") && environment.tile.empty());
}

/// A layer that is not visible may place the stars of one that is.
bool reaches(const Scene& now, const LayerParams& layer) {
    return layer.visible || std::ranges::any_of(now.layers, [&](const LayerParams& other) {
               return other.visible && like_layer(now, other) == &layer;
           });
}

bool is_idle(const ParameterKey& generic_key, const Scene& now, const LayerParams& layer) {
    const std::string& key = generic_key.text();
    if (!reaches(now, layer)) return true;
    if (key == "layer.render.space") return !is_mixed_in_display_space(layer.render);
    if (key == "layer.source.like" || key == "layer.source.depth" || key == "layer.source.slab")
        return !like_layer(now, layer);
    const bool shapes_stars =
        generic_key.is_below("layer.source.wings") || generic_key.is_below("layer.source.spikes");
    return shapes_stars && layer.source.kind != SourceKind::stars;
}

/// Whether a key reaches no pixel of what is seen at one moment.
bool is_idle(const ParameterSpec& spec, const Scene& now) {
    if (spec.generic_key.is_below("environment")) return is_idle(spec.generic_key, now.environment);
    const auto layer = std::ranges::find(now.layers, spec.key.layer(), &LayerParams::name);
    if (layer != now.layers.end()) return is_idle(spec.generic_key, now, *layer);
    return is_idle(spec, now.camera);
}

bool is_hidden(const ParameterSpec& spec, const FrameScene& frame) {
    return is_elsewhere(spec) ||
           std::ranges::all_of(frame.moments(), [&](const Scene& now) { return is_idle(spec, now); });
}

/// Whether its frames are written through OpenColorIO; then to whom.
std::shared_ptr<const DisplayTransform> managed_view(const OutputParams& output) {
    if (!output.ocio.wanted()) return {};
    return resolve_format(output, output.path).ocio;
}

}  // namespace

bool is_of_another_lens(const ParameterSpec& spec, Projection projection) {
    const ParameterKey& key = spec.generic_key;
    if (key == "camera.fov" || key == "camera.focal_length" || key == "camera.film_width") return false;
    const Value name(std::string(name_of(projection)));
    return std::ranges::any_of(spec.conditions, [&](const Condition& condition) {
        const bool has = std::ranges::find(condition.values, name) != condition.values.end();
        return condition.key == "camera.projection" && has != condition.wanted;
    });
}

// The text itself where nothing lies under that name: "plane", "", or a file whose absence the
// loader will report.
std::string FrameHasher::file_text(const fs::path& file) {
    if (const auto known = files_.find(file); known != files_.end()) return known->second.hash;
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return to_toml(file.string());
    const FileStamp stamp = stamp_of(file);  // before it is read: a change from now on is seen
    return files_.emplace(file, HashedFile{sha256_of_file(file), stamp}).first->second.hash;
}

// The names that are used, not those that are asked for: the first ones may be others in another environment.
std::string FrameHasher::ocio_text(const DisplayTransform& ocio) {
    std::string files;
    for (const fs::path& file : ocio.files()) files += " " + file_text(file);
    return fmt::format("output.ocio = {} {} {} OpenColorIO {}{}\n", to_toml(ocio.display()),
                       to_toml(ocio.view()), to_toml(ocio.space()), ocio_version(), files);
}

void check_unchanged(const HashedFiles& files, const Progress& progress) {
    for (const auto& [file, hashed] : files) {
        if (stamp_of(file) == hashed.stamp) continue;
        std::error_code ignored;
        if (fs::is_regular_file(file, ignored) && sha256_of_file(file, progress) == hashed.hash) continue;
        bad_input(file, "the file that the frames were planned with", "a change since; start again");
    }
}

std::string FrameHasher::line(const Parameter& parameter) {
    const ParameterSpec& spec = parameter.spec;
    const Value value = parameter.get();
    std::string text = spec.key.text() + " =";
    if (spec.type != ParameterType::file && spec.type != ParameterType::files)
        text += " " + to_toml(value);
    else if (spec.generic_key.text() == "camera.file")
        text += " \"\"";  // what it says at this frame stands in the keys it replaces
    else if (const std::string* name = value.text())
        text += " " + file_text(*name);
    else if (const Value::List* names = value.list())
        for (const Value& each : *names) text += " " + file_text(each.text() ? *each.text() : "");
    return text + "\n";
}

/// Inputs of a layer that no key says: a mesh's own pictures, the camera's path with stars along it, a limit
/// from --memory.
std::string FrameHasher::layer_text(const Scene& scene, const LayerParams& layer) {
    std::string text;
    std::error_code ignored;
    for (const MeshInput& input : layer.source.meshes) {
        if (layer.source.kind != SourceKind::mesh || !has_own_pictures(input)) continue;
        if (!material_lists_.count(input.mesh) && !fs::is_regular_file(input.mesh, ignored)) continue;
        auto [known, added] = material_lists_.try_emplace(input.mesh);
        if (added)
            for (const fs::path& file : obj_materials(input.mesh)) known->second += " " + file_text(file);
        text += fmt::format("layer.{}.materials ={}\n", layer.name, known->second);
    }
    for (const glm::dvec3& p : source_of(scene, layer).stars.path)
        text += fmt::format("layer.{}.path = {} {} {}\n", layer.name, p.x, p.y, p.z);
    if (const std::int64_t texels = layer.source.structure.most_texels; texels > 0)
        text += fmt::format("layer.{}.most texels = {}\n", layer.name, texels);
    return text;
}

std::string FrameHasher::canonical_text(const FrameScene& frame) {
    std::string text = fmt::format("pixels = {}\n", pixel_version);
    if (region_.width > 0 && region_.height > 0)
        text += fmt::format("region = {} {} {} {}\n", region_.x, region_.y, region_.width, region_.height);
    Scene now = frame.scene;
    for (LayerParams& layer : now.layers) layer.source.stars.unit = parsec_of(now, layer);
    const std::shared_ptr<const DisplayTransform> ocio = managed_view(now.output);
    for (const Parameter& parameter : describe(now).parameters) {
        if (is_hidden(parameter.spec, frame)) continue;
        if (ocio && parameter.spec.generic_key.text() == "output.view") continue;
        text += line(parameter);
    }
    if (ocio) text += ocio_text(*ocio);
    const auto moves_below = [&](const ParameterKey& group) {
        return moves(now, [&](const ParameterKey& key) { return key.is_below(group); });
    };
    for (std::size_t i = 0; i < frame.moving.size(); ++i) {
        Scene then = frame.moving[i];
        for (const Parameter& parameter : describe(then, moves_below).parameters) {
            const ParameterKey& key = parameter.spec.key;
            if (moves(now, [&](const ParameterKey& moved) { return moved == key; }) &&
                !is_elsewhere(parameter.spec) && !is_idle(parameter.spec, then))
                text += fmt::format("{} {}", i, line(parameter));
        }
    }
    for (std::size_t i = 0; i < now.layers.size(); ++i)
        if (std::ranges::any_of(frame.moments(), [&](const Scene& s) { return reaches(s, s.layers[i]); }))
            text += layer_text(now, now.layers[i]);
    return text;
}

std::string FrameHasher::frame_hash(const FrameScene& frame) {
    return Sha256().add(canonical_text(frame)).hex();
}

}  // namespace astrosplat
