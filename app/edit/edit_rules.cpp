// Every value is checked by setting it to itself: the description knows its range.
#include "edit/edit_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "scene/camera_file.h"
#include "scene/check.h"
#include "scene/describe.h"
#include "scene/entries.h"
#include "scene/frames.h"
#include "scene/load.h"

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
    naming(parameter.spec.key, [&] { parameter.set(value); });
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

void apply_output_preset(Scene& scene) {
    if (scene.output.preset.empty()) return;
    const std::string head = "astrosplat = 1\n";
    const std::string text = fmt::format("[output]\npreset = {}\n", to_toml(scene.output.preset.string()));
    Scene blank = parse_unchecked(head, scene.file), loaded = parse_unchecked(head + text, scene.file);
    const Description standard = describe(blank), wanted = describe(scene);
    for (const Parameter& parameter : describe(loaded).parameters) {
        const ParameterKey& key = parameter.spec.key;
        const Parameter *before = find_parameter(standard, key), *own = find_parameter(wanted, key);
        if (before && own && key != "output.preset" && !(before->get() == parameter.get()))
            own->set(parameter.get());
    }
}

void keep_dome_square(Scene& scene, const Scene& before) {
    OutputParams& output = scene.output;
    if (!is_dome(output)) return;
    const bool width_changed = output.width != before.output.width,
               height_changed = output.height != before.output.height;
    if (width_changed && !height_changed) output.height = output.width;
    if (height_changed && !width_changed) output.width = output.height;
}

namespace {

/// Of all keyframes; `otherwise` where there is none.
double last_keyframe(const Scene& scene, double otherwise) {
    double last = otherwise;
    for (const Track& track : scene.animation)
        for (const auto& keyframe : track.keyframes) last = std::max(last, keyframe.frame);
    return last;
}

}  // namespace

double film_frames(const OutputParams& output) {
    constexpr double seconds = 10.0;
    return std::fmax(1.0, std::floor(seconds * output.fps + 0.5));
}

void film_still(const Scene& before, Scene& after) {
    if (before.output.frames != after.output.frames) return;
    const std::vector<std::int64_t> frames = parse_frames(after.output.frames, "output.frames");
    const auto first = static_cast<double>(frames.front());
    if (frames.size() != 1 || last_keyframe(before, first) > first) return;
    const double last = last_keyframe(after, first);
    if (last > first)
        after.output.frames = fmt::format(
            "{}-{}", frames.front(), std::llround(std::max(first + film_frames(after.output) - 1.0, last)));
}

double rounded_to_step(double value, double step) {
    if (!(step > 0.0)) return value;
    const int digits = static_cast<int>(std::floor(std::log10(step)));
    // Dividing by a whole power of ten gives the double nearest to the short decimal; multiplying by 0.001
    // does not.
    const double power = std::pow(10.0, std::abs(digits));
    const double rounded = digits < 0 ? std::round(value * power) / power : std::round(value / power) * power;
    return rounded + 0.0;  // never -0
}

}  // namespace astrosplat
