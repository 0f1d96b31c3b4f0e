// Tracks into values: positions move along a curve, rotations slerp, everything else goes component by
// component; booleans, choices and whole numbers step.
#include "scene/animate.h"

#include <algorithm>
#include <cmath>

#include "scene/describe.h"

namespace astrosplat {
namespace {

using Keyframes = std::vector<Keyframe<std::vector<double>>>;

std::vector<Keyframe<double>> component(const Keyframes& keyframes, std::size_t index, bool steps) {
    std::vector<Keyframe<double>> scalar;
    for (const auto& keyframe : keyframes)
        scalar.push_back(
            {keyframe.frame, keyframe.value.at(index), steps ? Interpolation::step : keyframe.interpolation});
    return scalar;
}

std::vector<double> evaluate_position_track(const Track& track, double frame) {
    std::vector<Keyframe<glm::dvec3>> keyframes;
    for (const auto& keyframe : track.keyframes)
        keyframes.push_back({keyframe.frame,
                             {keyframe.value.at(0), keyframe.value.at(1), keyframe.value.at(2)},
                             keyframe.interpolation});
    const glm::dvec3 p = evaluate_position(keyframes, frame, track.ends, track.constant_speed);
    return {p.x, p.y, p.z};
}

std::vector<double> evaluate_rotation_track(const Track& track, double frame) {
    std::vector<Keyframe<glm::dvec4>> keyframes;
    for (const auto& keyframe : track.keyframes) {
        const glm::dvec4 q(keyframe.value.at(0), keyframe.value.at(1), keyframe.value.at(2),
                           keyframe.value.at(3));
        const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
        keyframes.push_back({keyframe.frame, q / length, keyframe.interpolation});
    }
    const glm::dvec4 q = evaluate_rotation(keyframes, frame, track.ends);
    return {q.x, q.y, q.z, q.w};
}

}  // namespace

std::vector<double> track_at(const Track& track, const ParameterSpec& spec, double frame) {
    if (spec.type == ParameterType::position) return evaluate_position_track(track, frame);
    if (spec.type == ParameterType::rotation) return evaluate_rotation_track(track, frame);
    std::vector<double> numbers;
    const bool steps = spec.animation == Animation::steps;
    for (std::size_t i = 0; i < track.keyframes.front().value.size(); ++i)
        numbers.push_back(evaluate_scalar(component(track.keyframes, i, steps), frame, track.ends));
    return numbers;
}

Scene scene_at(const Scene& scene, double frame) {
    Scene still = scene;
    const Description description = describe(still, [&](const ParameterKey& group) {
        return std::ranges::any_of(scene.animation,
                                   [&](const Track& track) { return track.key.is_below(group); });
    });
    for (const Track& track : scene.animation) {
        const Parameter* parameter = find_parameter(description, track.key);
        if (!parameter || track.keyframes.empty()) continue;  // of a layer that was taken out
        parameter->set(from_numbers(parameter->spec, track_at(track, parameter->spec, frame)));
    }
    return still;
}

bool ever_visible(const Scene& scene, const LayerParams& layer) {
    const ParameterKey key = layer_key(layer.name) / "visible";
    for (const Track& track : scene.animation) {
        if (track.key != key) continue;
        return std::ranges::any_of(track.keyframes,
                                   [](const auto& k) { return !k.value.empty() && k.value[0] != 0.0; });
    }
    return layer.visible;
}

}  // namespace astrosplat
