// Tracks stay sorted by frame; a parameter without a track has no keyframes.
#include "edit/keyframes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "edit/edit_rules.h"
#include "scene/animate.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

using Numbers = std::vector<double>;
using TrackKeyframe = Keyframe<Numbers>;

/// Null: none.
TrackKeyframe* keyframe_at(Track* track, double frame) {
    if (!track) return nullptr;
    const auto found = std::ranges::find(track->keyframes, frame, &TrackKeyframe::frame);
    return found == track->keyframes.end() ? nullptr : &*found;
}

TrackKeyframe* keyframe_of(Scene& scene, const std::string& key, double frame) {
    return keyframe_at(find_track(scene, key), frame);
}

/// Puts a keyframe in its place, instead of one that is there.
void insert_keyframe(Track& track, TrackKeyframe keyframe) {
    std::erase_if(track.keyframes, [&](const TrackKeyframe& old) { return old.frame == keyframe.frame; });
    const auto after = std::ranges::upper_bound(track.keyframes, keyframe.frame, {}, &TrackKeyframe::frame);
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
Numbers numbers_for(const Parameter& parameter, const Value& value) {
    return naming(parameter.spec.key, [&] {
        parameter.set(value);
        Numbers numbers = to_numbers(parameter.spec, value);
        const bool nothing = numbers.empty() || (value.text() && value == parameter.spec.nothing);
        const bool zero = std::ranges::all_of(numbers, [](double x) { return x == 0.0; });
        if (nothing || (zero && parameter.spec.type == ParameterType::rotation))
            throw ValueError(
                fmt::format("expected {}, found {}", expectation(parameter.spec), nothing ? "none" : "0"));
        return numbers;
    });
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
    const auto found = std::ranges::find_if(scene.animation, [&](const Track& t) { return t.key == key; });
    return found == scene.animation.end() ? nullptr : &*found;
}

Track* find_track(Scene& scene, const std::string& key) {
    return const_cast<Track*>(find_track(std::as_const(scene), key));
}

bool is_animated(const Scene& scene, const std::string& key) { return find_track(scene, key) != nullptr; }

bool has_keyframe_at(const Scene& scene, const std::string& key, double frame) {
    const Track* const track = find_track(scene, key);
    return track && std::ranges::count(track->keyframes, frame, &TrackKeyframe::frame) > 0;
}

void set_keyframe(Scene& scene, const std::string& key, double frame, const Value& value) {
    if (!std::isfinite(frame)) throw InputError(key + ": expected a finite frame number, found another");
    Scene scratch = scene;  // values are checked by setting them
    const Description description = describe(scratch);
    const Parameter* parameter = find_parameter(description, key);
    if (!parameter) throw InputError(key + ": expected a parameter of the scene, found none of that name");
    if (parameter->spec.animation == Animation::no)
        throw InputError(parameter->spec.key.text() + ": this parameter cannot be animated");
    Numbers numbers = numbers_for(*parameter, value);
    Track* track = find_track(scene, parameter->spec.key);
    if (!track) {
        scene.animation.push_back(new_track(parameter->spec));
        track = &scene.animation.back();
    }
    const bool alone =
        track->keyframes.empty() || (track->keyframes.size() == 1 && track->keyframes[0].frame == frame);
    if (!alone && track->keyframes[0].value.size() != numbers.size())
        throw InputError(parameter->spec.key.text() +
                         ": expected as many points as in the other keyframes, found " + "another number");
    if (TrackKeyframe* const old = keyframe_at(track, frame))
        old->value = std::move(numbers);
    else
        insert_keyframe(*track, {frame, numbers, way_at(*track, frame)});
}

void remove_keyframe(Scene& scene, const std::string& key, double frame) {
    const TrackKeyframe* const found = keyframe_of(scene, key, frame);
    if (!found) return;
    Track& track = *find_track(scene, key);
    if (track.keyframes.size() > 1) {
        std::erase_if(track.keyframes, [&](const TrackKeyframe& k) { return k.frame == frame; });
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
    if (from == to || !std::isfinite(to) || !has_keyframe_at(scene, key, from)) return;
    copy_keyframe(scene, key, from, to);
    std::erase_if(find_track(scene, key)->keyframes, [&](const TrackKeyframe& k) { return k.frame == from; });
}

void copy_keyframe(Scene& scene, const std::string& key, double from, double to) {
    const TrackKeyframe* const found = keyframe_of(scene, key, from);
    if (!found || !std::isfinite(to)) return;
    TrackKeyframe copy = *found;
    copy.frame = to;
    insert_keyframe(*find_track(scene, key), std::move(copy));
}

void set_interpolation(Scene& scene, const std::string& key, double frame, Interpolation interpolation) {
    if (TrackKeyframe* const found = keyframe_of(scene, key, frame)) found->interpolation = interpolation;
}

void set_ends(Scene& scene, const std::string& key, Ends ends) {
    if (Track* track = find_track(scene, key)) track->ends = ends;
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

namespace {

constexpr double least_frames = 1e-3;  // of a handle that another one turns with

/// The handle at `side` of a keyframe as it acts; of no segment: with no frames.
Handle<Numbers> acting(Scene& scene, const std::string& key, double frame, HandleSide side) {
    const Track& track = *find_track(scene, key);
    const Description description = describe(scene);
    const Parameter* parameter = find_parameter(description, key);
    const TrackKeyframe* const found = keyframe_of(scene, key, frame);
    if (!parameter || !found) return {};
    const TrackHandles handles =
        handles_of(track, parameter->spec)[static_cast<std::size_t>(found - track.keyframes.data())];
    return side == HandleSide::in ? handles.in : handles.out;
}

/// Free, where it acts now; of no segment: automatic.
Handle<Numbers> freed(Scene& scene, const std::string& key, double frame, HandleSide side) {
    Handle<Numbers> handle = acting(scene, key, frame, side);
    if (handle.frames == 0.0 && handle.kind != HandleKind::free) return {};
    handle.kind = HandleKind::free;
    return handle;
}

/// Turned to the direction of `leader`, at the frames it has.
void follow(Handle<Numbers>& handle, const Handle<Numbers>& leader) {
    if (handle.kind != HandleKind::free || std::fabs(leader.frames) < least_frames) return;
    handle.value = leader.value;
    for (double& number : handle.value) number *= handle.frames / leader.frames;
}

Handle<Numbers>& handle_at(TrackKeyframe& keyframe, HandleSide side) {
    return side == HandleSide::in ? keyframe.in : keyframe.out;
}

HandleSide other(HandleSide side) { return side == HandleSide::in ? HandleSide::out : HandleSide::in; }

}  // namespace

bool has_handle(const Track& track, std::size_t i, HandleSide side) {
    const bool before = side == HandleSide::in;
    if (before ? i == 0 : i + 1 >= track.keyframes.size()) return false;
    return track.keyframes[before ? i - 1 : i].interpolation == Interpolation::bezier;
}

void set_handle_kind(Scene& scene, const std::string& key, double frame, HandleKind kind) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    for (const HandleSide side : {HandleSide::in, HandleSide::out})
        handle_at(*keyframe, side) =
            kind == HandleKind::free ? freed(scene, key, frame, side) : Handle<Numbers>{kind, 0.0, {}};
}

void set_broken(Scene& scene, const std::string& key, double frame, bool broken) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    keyframe->broken = broken;
    if (!broken) follow(keyframe->in, acting(scene, key, frame, HandleSide::out));
}

void set_handle(Scene& scene, const std::string& key, double frame, HandleSide side, double frames,
                const Numbers& value) {
    TrackKeyframe* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    const Handle<Numbers> second = freed(scene, key, frame, other(side));
    const bool right_side = side == HandleSide::in ? frames < 0.0 : frames > 0.0;
    handle_at(*keyframe, side) = {HandleKind::free, right_side ? frames : 0.0, value};
    if (keyframe->broken) return;
    handle_at(*keyframe, other(side)) = second;
    follow(handle_at(*keyframe, other(side)), handle_at(*keyframe, side));
}

}  // namespace astrosplat
