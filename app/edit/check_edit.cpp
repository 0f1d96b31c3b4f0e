// Values are checked by reading and setting them: the description knows every range.
#include "edit/check_edit.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "scene/camera_file.h"
#include "scene/check.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

void check_names(const Scene& scene, const std::string& name) {
    std::set<std::string> names;
    for (const LayerParams& layer : scene.layers) {
        check_layer_name(layer.name, name);
        if (!names.insert(layer.name).second)
            throw InputError(
                fmt::format("{}: layer.name: expected each name once, found '{}' twice", name, layer.name));
    }
}

/// Bytes that UTF-8 cannot have, such as file names of another encoding: a scene file cannot hold them.
bool is_utf8(const std::string& text) {
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::exception&) {
        return false;
    }
}

void check_text(const Value& value, const std::string& key) {
    if (const std::string* text = value.text(); text && !is_utf8(*text))
        throw InputError(key + ": expected text in UTF-8, found another encoding");
    if (const Value::List* list = value.list())
        for (const Value& element : *list) check_text(element, key);
}

void set_checked(const Parameter& parameter, const Value& value) {
    try {
        parameter.set(value);
    } catch (const ValueError& error) {
        throw InputError(fmt::format("{}: {}", parameter.spec.key, error.what()));
    }
}

void check_track(const Track& track, const Parameter& parameter) {
    const auto fail = [&](const char* message) {
        throw InputError(fmt::format("{}: {}", track.key, message));
    };
    if (parameter.spec.animation == Animation::no) fail("this parameter cannot be animated");
    if (track.keyframes.empty()) fail("expected at least one keyframe, found none");
    const Value value = parameter.get();
    for (std::size_t i = 0; i < track.keyframes.size(); ++i) {
        const auto& keyframe = track.keyframes[i];
        if (!std::isfinite(keyframe.frame)) fail("expected a finite frame number, found another");
        if (i > 0 && !(track.keyframes[i - 1].frame < keyframe.frame))
            fail("expected ascending frames, each once, found others");
        if (keyframe.value.size() != track.keyframes[0].value.size() || keyframe.value.empty())
            fail("expected as many numbers in every keyframe, found another number");
        for (const double x : keyframe.value)
            if (!std::isfinite(x)) fail("expected finite numbers in every keyframe, found another");
        set_checked(parameter, from_numbers(parameter.spec, keyframe.value));
    }
    parameter.set(value);
}

}  // namespace

void check_edited_scene(Scene& scene, const std::string& name) {
    check_names(scene, name);
    const Description description = describe(scene);
    std::erase_if(scene.animation,
                  [&](const Track& track) { return !find_parameter(description, track.key); });
    for (const Parameter& parameter : description.parameters) {
        const Value value = parameter.get();
        check_text(value, parameter.spec.key);
        set_checked(parameter, value);
    }
    for (const Track& track : scene.animation) check_track(track, *find_parameter(description, track.key));
    check_scene(scene, name, {});
    refresh_camera_file(scene, name);
}

}  // namespace astrosplat
