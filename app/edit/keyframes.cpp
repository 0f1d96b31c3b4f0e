// Tracks stay sorted by frame; a parameter without a track has no keyframes.
#include "edit/keyframes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

using TrackKeyframe = Keyframe<std::vector<double>>;

Track* track_of(Scene& scene, const std::string& key) {
    const Track* found = find_track(scene, key);
    return found ? &scene.animation[static_cast<std::size_t>(found - scene.animation.data())] : nullptr;
}

std::vector<TrackKeyframe>::iterator keyframe_at(Track& track, double frame) {
    return std::find_if(track.keyframes.begin(), track.keyframes.end(),
                        [&](const TrackKeyframe& keyframe) { return keyframe.frame == frame; });
}

/// Puts a keyframe in its place, instead of one that is there.
void insert_keyframe(Track& track, TrackKeyframe keyframe) {
    std::erase_if(track.keyframes, [&](const TrackKeyframe& old) { return old.frame == keyframe.frame; });
    const auto after = std::find_if(track.keyframes.begin(), track.keyframes.end(),
                                    [&](const TrackKeyframe& other) { return other.frame > keyframe.frame; });
    track.keyframes.insert(after, std::move(keyframe));
}

/// Of a new keyframe: within a Bezier segment it is Bezier, too.
Interpolation way_at(const Track& track, double frame) {
    const auto after = std::ranges::upper_bound(track.keyframes, frame, {}, &TrackKeyframe::frame);
    const bool within = after != track.keyframes.begin() && after != track.keyframes.end();
    const bool bends = within && (after - 1)->interpolation == Interpolation::bezier;
    return bends ? Interpolation::bezier : track.interpolation;
}

/// The numbers of a value that fits the parameter; sets it in passing.
std::vector<double> numbers_for(const Parameter& parameter, const Value& value) {
    try {
        parameter.set(value);
        std::vector<double> numbers = to_numbers(parameter.spec, value);
        const bool nothing = numbers.empty() || (value.text() && value == parameter.spec.nothing);
        const bool zero = std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0.0; });
        if (nothing || (zero && parameter.spec.type == ParameterType::rotation))
            throw ValueError(
                fmt::format("expected {}, found {}", expectation(parameter.spec), nothing ? "none" : "0"));
        return numbers;
    } catch (const ValueError& error) {
        throw InputError(fmt::format("{}: {}", parameter.spec.key, error.what()));
    }
}

/// A new track moves smoothly, as people expect of a camera or a slider; values that step have no way
/// between.
Track new_track(const ParameterSpec& spec) {
    Track track;
    track.key = spec.key;
    if (spec.animation == Animation::yes) track.interpolation = Interpolation::smooth;
    return track;
}

}  // namespace

const Track* find_track(const Scene& scene, const std::string& key) {
    const auto found = std::find_if(scene.animation.begin(), scene.animation.end(),
                                    [&](const Track& track) { return track.key == key; });
    return found == scene.animation.end() ? nullptr : &*found;
}

bool is_animated(const Scene& scene, const std::string& key) { return find_track(scene, key) != nullptr; }

bool has_keyframe_at(const Scene& scene, const std::string& key, double frame) {
    const Track* track = find_track(scene, key);
    return track && std::any_of(track->keyframes.begin(), track->keyframes.end(),
                                [&](const TrackKeyframe& keyframe) { return keyframe.frame == frame; });
}

void set_keyframe(Scene& scene, const std::string& key, double frame, const Value& value) {
    if (!std::isfinite(frame)) throw InputError(key + ": expected a finite frame number, found another");
    Scene scratch = scene;  // values are checked by setting them
    const Description description = describe(scratch);
    const Parameter* parameter = find_parameter(description, key);
    if (!parameter) throw InputError(key + ": expected a parameter of the scene, found none of that name");
    if (parameter->spec.animation == Animation::no)
        throw InputError(parameter->spec.key.text() + ": this parameter cannot be animated");
    std::vector<double> numbers = numbers_for(*parameter, value);
    Track* track = track_of(scene, parameter->spec.key);
    if (!track) {
        scene.animation.push_back(new_track(parameter->spec));
        track = &scene.animation.back();
    }
    const bool alone =
        track->keyframes.empty() || (track->keyframes.size() == 1 && track->keyframes[0].frame == frame);
    if (!alone && track->keyframes[0].value.size() != numbers.size())
        throw InputError(parameter->spec.key.text() +
                         ": expected as many points as in the other keyframes, found " + "another number");
    const auto old = keyframe_at(*track, frame);
    if (old != track->keyframes.end())
        old->value = std::move(numbers);
    else
        insert_keyframe(*track, {frame, numbers, way_at(*track, frame)});
}

void remove_keyframe(Scene& scene, const std::string& key, double frame) {
    Track* track = track_of(scene, key);
    if (!track) return;
    const auto found = keyframe_at(*track, frame);
    if (found == track->keyframes.end()) return;
    if (track->keyframes.size() > 1) {
        track->keyframes.erase(found);
        return;
    }
    const Description description = describe(scene);
    if (const Parameter* parameter = find_parameter(description, key))
        parameter->set(from_numbers(parameter->spec, found->value));
    remove_track(scene, key);
}

void remove_track(Scene& scene, const std::string& key) {
    std::erase_if(scene.animation, [&](const Track& track) { return track.key == key; });
}

void move_keyframe(Scene& scene, const std::string& key, double from, double to) {
    Track* track = track_of(scene, key);
    if (!track || from == to || !std::isfinite(to) || keyframe_at(*track, from) == track->keyframes.end())
        return;
    copy_keyframe(scene, key, from, to);
    track->keyframes.erase(keyframe_at(*track, from));
}

void copy_keyframe(Scene& scene, const std::string& key, double from, double to) {
    Track* track = track_of(scene, key);
    if (!track || !std::isfinite(to)) return;
    const auto found = keyframe_at(*track, from);
    if (found == track->keyframes.end()) return;
    TrackKeyframe copy = *found;
    copy.frame = to;
    insert_keyframe(*track, std::move(copy));
}

void set_interpolation(Scene& scene, const std::string& key, double frame, Interpolation interpolation) {
    Track* track = track_of(scene, key);
    if (!track) return;
    const auto found = keyframe_at(*track, frame);
    if (found != track->keyframes.end()) found->interpolation = interpolation;
}

void set_ends(Scene& scene, const std::string& key, Ends ends) {
    if (Track* track = track_of(scene, key)) track->ends = ends;
}

std::vector<double> frames_with_keyframes(const Scene& scene) {
    std::vector<double> frames;
    for (const Track& track : scene.animation)
        for (const TrackKeyframe& keyframe : track.keyframes) frames.push_back(keyframe.frame);
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

double frame_of_next_keyframe(const Scene& scene, double frame) {
    const std::vector<double> frames = frames_with_keyframes(scene);
    const auto next = std::upper_bound(frames.begin(), frames.end(), frame);
    return next == frames.end() ? frame : *next;
}

double frame_of_previous_keyframe(const Scene& scene, double frame) {
    const std::vector<double> frames = frames_with_keyframes(scene);
    const auto here = std::lower_bound(frames.begin(), frames.end(), frame);
    return here == frames.begin() ? frame : *(here - 1);
}

}  // namespace astrosplat
