// The canonical text of a frame, from the description of its parameters.
#include "output/frame_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "camera/aperture.h"
#include "core/error.h"
#include "core/sha256.h"
#include "output/format.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "scene/input_files.h"
#include "scene/layer_source.h"
#include "source/mesh.h"
#include "source/obj.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

// Reaches no pixel of any frame, or is told in other words.
bool is_elsewhere(const ParameterSpec& spec) {
    constexpr std::array<std::string_view, 6> keys = {"output.path",   "output.frames",      "output.fps",
                                                      "output.preset", "output.compression", "layer.preset"};
    return std::ranges::find(keys, spec.generic_key.text()) != keys.end() ||
           spec.generic_key.text().starts_with("camera.file_") || spec.generic_key.is_below("provenance") ||
           spec.generic_key.is_below("reference") || spec.generic_key.is_below("output.ocio");
}

bool shows(const EnvironmentParams& environment) {
    return environment.visible &&
           !(environment.image.empty() && environment.cube.empty() && environment.tile.empty());
}

// Keys that came later, where they do nothing.
bool is_unused(const std::string& key, const EnvironmentParams& environment) {
    if (key == "environment.behind") return environment.behind == 0.0;
    return key.starts_with("environment.tile") && environment.tile.empty();
}

// Keys that came with the stars; frames without stars, from before, keep their hash.
bool shapes_stars(const ParameterSpec& spec) {
    return spec.generic_key.is_below("layer.source.wings") ||
           spec.generic_key.is_below("layer.source.spikes");
}

// Keys that came with the stars of pictures, of a layer of others.
bool places_stars_of_a_picture(const ParameterSpec& spec, const Scene& now) {
    const std::string& key = spec.generic_key.text();
    if (key != "layer.source.like" && key != "layer.source.depth" && key != "layer.source.slab") return false;
    return std::ranges::none_of(now.layers, [&](const LayerParams& layer) {
        return layer.name == spec.key.layer() && like_layer(now, layer);
    });
}

// A layer that is not visible may place the stars of one that is.
bool reaches(const Scene& now, const LayerParams& layer) {
    return layer.visible || std::ranges::any_of(now.layers, [&](const LayerParams& other) {
               return other.visible && like_layer(now, other) == &layer;
           });
}

bool has_stars(const Scene& now, const std::string& layer_name) {
    return std::ranges::any_of(now.layers, [&](const LayerParams& layer) {
        return layer.name == layer_name && layer.source.kind == SourceKind::stars;
    });
}

// Keys of lenses that the camera does not have, and of blurs that are off.
bool is_of_another_lens(const std::string& key, const CameraParams& camera) {
    const bool fisheye = camera.projection == Projection::fisheye;
    if (key == "camera.shift")
        return camera.projection != Projection::perspective || camera.shift == glm::dvec2(0.0);
    if (key == "camera.fisheye_tilt") return !fisheye;
    if (key == "camera.eye" || key == "camera.eye_separation" || key == "camera.convergence")
        return camera.eye == Eye::centre || !has_two_eyes(camera.projection);
    if (key == "camera.shutter") return camera.shutter == 0.0;
    if (key == "camera.f_number" || key == "camera.focus_distance" || key == "camera.unit_mm")
        return camera.f_number == 0.0;
    if (key == "output.samples") return !is_blurred(camera);
    if (key == "camera.panorama_fov") return fisheye || !is_onto_sphere(camera.projection);
    return false;
}

// Layers that are not mixed in display values keep the hash they had before there was a choice.
bool is_mixed_as_ever(const ParameterSpec& spec, const Scene& now) {
    return spec.generic_key.text() == "layer.render.space" &&
           std::ranges::none_of(now.layers, [&](const LayerParams& layer) {
               return layer.name == spec.key.layer() && is_encoded(layer.render);
           });
}

/// Whether its frames are written through OpenColorIO; then to whom.
std::shared_ptr<const DisplayTransform> managed_view(const Scene& now) {
    if (!now.output.ocio.wanted()) return {};
    return resolve_format(now.output, now.output.path).ocio;
}

bool is_hidden(const ParameterSpec& spec, const Scene& now) {
    // Frames from before there was a choice keep their hash.
    if (spec.generic_key.text() == "output.primaries")
        return now.output.primaries == OutputParams::Primaries::rec709;
    if (is_mixed_as_ever(spec, now)) return true;
    if (is_of_another_lens(spec.generic_key.text(), now.camera)) return true;
    if (shapes_stars(spec) && !has_stars(now, spec.key.layer())) return true;
    if (spec.generic_key.is_below("environment"))
        return !shows(now.environment) || is_unused(spec.generic_key.text(), now.environment);
    if (places_stars_of_a_picture(spec, now)) return true;
    return std::ranges::any_of(now.layers, [&](const LayerParams& layer) {
        return spec.key.layer() == layer.name && !reaches(now, layer);
    });
}

}  // namespace

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

// Of the pixels of layers with match = "picture" alone. 2: measured through the splats' footprints.
constexpr int matched_light_version = 2;

// Pictures that no key names.
std::string FrameHasher::own_pictures(const LayerParams& layer) {
    std::string text;
    std::error_code ignored;
    if (layer.source.kind != SourceKind::mesh) return text;
    for (const MeshInput& input : layer.source.meshes) {
        if (!has_own_pictures(input)) continue;
        if (!material_lists_.count(input.mesh) && !fs::is_regular_file(input.mesh, ignored)) continue;
        auto [known, added] = material_lists_.try_emplace(input.mesh);
        if (added)
            for (const fs::path& file : obj_materials(input.mesh)) known->second += " " + file_text(file);
        text += fmt::format("layer.{}.materials ={}\n", layer.name, known->second);
    }
    return text;
}

void check_unchanged(const HashedFiles& files, const Progress& progress) {
    for (const auto& [file, hashed] : files) {
        if (stamp_of(file) == hashed.stamp) continue;
        std::error_code ignored;
        if (fs::is_regular_file(file, ignored) && sha256_of_file(file, progress) == hashed.hash) continue;
        bad_input(file.string(), "", "the file that the frames were planned with",
                  "a change since; start again");
    }
}

// What is animated, at the times that an open shutter sees.
std::string FrameHasher::moving_text(double frame, const Scene& now) const {
    std::string text;
    const auto samples = static_cast<int>(now.output.samples);
    for (int i = 0; i < samples; ++i) {
        Scene then = scene_at(scene_, frame + camera_sample(now.camera, i, samples).frames);
        for (const Parameter& parameter : describe(then).parameters) {
            if (moves(scene_, [&](const ParameterKey& key) { return key == parameter.spec.key; }))
                text += fmt::format("{} {} = {}\n", i, parameter.spec.key.text(), to_toml(parameter.get()));
        }
    }
    return text;
}

std::string FrameHasher::canonical_text(std::int64_t frame) {
    Scene now = scene_at(scene_, static_cast<double>(frame));
    std::string text = fmt::format("pixels = {}\n", pixel_version);
    if (region_.width > 0 && region_.height > 0)
        text += fmt::format("region = {} {} {} {}\n", region_.x, region_.y, region_.width, region_.height);
    const std::shared_ptr<const DisplayTransform> ocio = managed_view(now);
    for (const Parameter& parameter : describe(now).parameters) {
        const ParameterSpec& spec = parameter.spec;
        if (is_elsewhere(spec) || is_hidden(spec, now)) continue;
        if (ocio && spec.generic_key.text() == "output.view") continue;
        Value value = parameter.get();
        bool files = spec.type == ParameterType::file || spec.type == ParameterType::files;
        text += spec.key.text() + " =";
        if (!files)
            text += " " + to_toml(value);
        else if (spec.generic_key.text() == "camera.file")
            text += " \"\"";  // what it says at this frame stands in the keys it replaces
        else if (const std::string* name = value.text())
            text += " " + file_text(*name);
        else if (const Value::List* names = value.list())
            for (const Value& each : *names) text += " " + file_text(each.text() ? *each.text() : "");
        text += "\n";
    }
    if (ocio) text += ocio_text(*ocio);
    if (now.camera.shutter > 0.0) text += moving_text(static_cast<double>(frame), now);
    for (const LayerParams& layer : now.layers) {
        if (!reaches(now, layer)) continue;
        text += own_pictures(layer);
        for (const glm::dvec3& p : source_of(scene_, layer).stars.path)
            text += fmt::format("layer.{}.path = {} {} {}\n", layer.name, p.x, p.y, p.z);
        if (layer.look.vertical.match == VerticalAlpha::Match::picture)
            text += fmt::format("layer.{}.matched light = {}\n", layer.name, matched_light_version);
        if (const std::int64_t texels = layer.source.structure.most_texels; texels > 0)
            text += fmt::format("layer.{}.most texels = {}\n", layer.name, texels);
    }
    return text;
}

std::string FrameHasher::frame_hash(std::int64_t frame) { return Sha256().add(canonical_text(frame)).hex(); }

}  // namespace astrosplat
