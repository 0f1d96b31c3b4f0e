// Tracks into values: positions move along a curve, rotations slerp, everything else goes component by
// component; booleans, choices and whole numbers step.
#include "scene/animate.h"

#include "camera/keyframe.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

using Keyframes = std::vector<Keyframe<std::vector<double>>>;

/// Keyframes of another type: `value` makes one of the numbers of a keyframe or of a handle.
template <class T, class Read>
std::vector<Keyframe<T>> converted(const Keyframes& keyframes, const Read& value) {
    const auto handle = [&](const Handle<std::vector<double>>& h) {
        return Handle<T>{h.kind, h.frames, h.kind == HandleKind::free ? value(h.value) : T(0)};
    };
    std::vector<Keyframe<T>> result;
    for (const auto& k : keyframes)
        result.push_back({k.frame, value(k.value), k.interpolation, handle(k.in), handle(k.out)});
    return result;
}

std::vector<Keyframe<double>> component(const Keyframes& keyframes, std::size_t index, bool steps) {
    std::vector<Keyframe<double>> scalar =
        converted<double>(keyframes, [&](const std::vector<double>& numbers) { return numbers.at(index); });
    if (steps)
        for (Keyframe<double>& keyframe : scalar) keyframe.interpolation = Interpolation::step;
    return scalar;
}

std::vector<Keyframe<glm::dvec4>> rotation_keyframes(const Track& track) {
    return converted<glm::dvec4>(track.keyframes, [](const std::vector<double>& v) {
        const glm::dvec4 q(v.at(0), v.at(1), v.at(2), v.at(3));
        return q / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    });
}

/// Those of camera.file.
std::span<const Track> imported_tracks(const Scene& scene) {
    return scene.imported.camera ? std::span(scene.imported.camera->tracks) : std::span<const Track>();
}

/// The part of a linear track that decides at `frame`: at most two of its keyframes.
Track around(const Track& track, double frame) {
    const auto& keyframes = track.keyframes;
    const auto after = std::ranges::upper_bound(keyframes, frame, {}, [](const auto& k) { return k.frame; });
    Track part;
    part.key = track.key;
    if (after != keyframes.begin()) part.keyframes.push_back(*(after - 1));
    if (after != keyframes.end()) part.keyframes.push_back(*after);
    return part;
}

}  // namespace

std::vector<Keyframe<glm::dvec3>> position_keyframes(const Track& track) {
    return converted<glm::dvec3>(track.keyframes, [](const std::vector<double>& numbers) {
        return glm::dvec3(numbers.at(0), numbers.at(1), numbers.at(2));
    });
}

std::vector<TrackHandles> handles_of(const Track& track, const ParameterSpec& spec) {
    std::vector<TrackHandles> result(track.keyframes.size());
    const auto fill = [&](const auto& keyframes, const auto& add) {
        for (std::size_t i = 0; i < result.size(); ++i) {
            add(result[i].in, handle_before(std::span(keyframes), i, track.ends));
            add(result[i].out, handle_after(std::span(keyframes), i, track.ends));
        }
    };
    if (spec.type == ParameterType::position) {
        fill(position_keyframes(track), [](Handle<std::vector<double>>& handle, const Handle<glm::dvec3>& h) {
            handle = {h.kind, h.frames, {h.value.x, h.value.y, h.value.z}};
        });
        return result;
    }
    for (std::size_t c = 0; c < track.keyframes.front().value.size(); ++c)
        fill(component(track.keyframes, c, false),
             [](Handle<std::vector<double>>& handle, const Handle<double>& h) {
                 handle.kind = h.kind;
                 handle.frames = h.frames;
                 handle.value.push_back(h.value);
             });
    return result;
}

std::vector<double> track_at(const Track& track, const ParameterSpec& spec, double frame) {
    if (spec.type == ParameterType::position) {
        const glm::dvec3 p =
            evaluate_position(position_keyframes(track), frame, track.ends, track.constant_speed);
        return {p.x, p.y, p.z};
    }
    if (spec.type == ParameterType::rotation) {
        const glm::dvec4 q = evaluate_rotation(rotation_keyframes(track), frame, track.ends);
        return {q.x, q.y, q.z, q.w};
    }
    std::vector<double> numbers;
    const bool steps = spec.animation == Animation::steps;
    for (std::size_t i = 0; i < track.keyframes.front().value.size(); ++i)
        numbers.push_back(evaluate_scalar(component(track.keyframes, i, steps), frame, track.ends));
    return numbers;
}

Scene scene_at(const Scene& scene, double frame) {
    Scene still = scene;
    const Description description = describe(still, [&](const ParameterKey& group) {
        return moves(scene, [&](const ParameterKey& key) { return key.is_below(group); });
    });
    const auto set = [&](const Track& track) {
        const Parameter* parameter = find_parameter(description, track.key);
        if (!parameter || track.keyframes.empty()) return;  // of a layer that was taken out
        parameter->set(from_numbers(parameter->spec, track_at(track, parameter->spec, frame)));
    };
    for (const Track& track : scene.animation) set(track);
    for (const Track& track : imported_tracks(scene)) set(around(track, frame));
    return still;
}

void stop_animation(Scene& scene) {
    scene.animation.clear();
    scene.imported = {};
}

bool moves(const Scene& scene, const std::function<bool(const ParameterKey&)>& wanted) {
    const auto is_wanted = [&](const Track& track) { return wanted(track.key); };
    return std::ranges::any_of(scene.animation, is_wanted) ||
           std::ranges::any_of(imported_tracks(scene), is_wanted);
}

const Track* moving_track(const Scene& scene, const ParameterKey& key) {
    for (const std::span<const Track> tracks : {imported_tracks(scene), std::span(scene.animation)})
        if (const auto found = std::ranges::find(tracks, key, &Track::key); found != tracks.end())
            return &*found;
    return nullptr;
}

bool ever_visible(const Scene& scene, const LayerParams& layer) {
    const Track* const track = moving_track(scene, layer_key(layer.name) / "visible");
    if (!track) return layer.visible;
    return std::ranges::any_of(track->keyframes,
                               [](const auto& k) { return !k.value.empty() && k.value[0] != 0.0; });
}

bool is_shaded_alike(const Scene& scene, const std::string& layer) {
    const ParameterKey harmless = layer_key(layer) / "visible";
    return !moves(scene, [&](const ParameterKey& key) { return key.layer() == layer && key != harmless; });
}

}  // namespace astrosplat
