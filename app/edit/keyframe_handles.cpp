#include "edit/keyframe_handles.h"

#include <algorithm>
#include <cmath>

#include "edit/keyframes.h"
#include "scene/animate.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

using Numbers = std::vector<double>;

constexpr double least_frames = 1e-3;  // of a handle that another one turns with

Keyframe<Numbers>* keyframe_of(Scene& scene, const std::string& key, double frame) {
    for (Track& track : scene.animation) {
        if (track.key != key) continue;
        const auto found = std::ranges::find(track.keyframes, frame, &Keyframe<Numbers>::frame);
        return found == track.keyframes.end() ? nullptr : &*found;
    }
    return nullptr;
}

/// The handle at `side` of a keyframe as it acts; of no segment: with no frames.
Handle<Numbers> acting(Scene& scene, const std::string& key, double frame, HandleSide side) {
    const Track& track = *find_track(scene, key);
    const Description description = describe(scene);
    const Parameter* parameter = find_parameter(description, key);
    const auto found = std::ranges::find(track.keyframes, frame, &Keyframe<Numbers>::frame);
    if (!parameter || found == track.keyframes.end()) return {};
    const TrackHandles handles =
        handles_of(track, parameter->spec)[static_cast<std::size_t>(found - track.keyframes.begin())];
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

Handle<Numbers>& handle_at(Keyframe<Numbers>& keyframe, HandleSide side) {
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
    Keyframe<Numbers>* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    for (const HandleSide side : {HandleSide::in, HandleSide::out})
        handle_at(*keyframe, side) =
            kind == HandleKind::free ? freed(scene, key, frame, side) : Handle<Numbers>{kind, 0.0, {}};
}

void set_broken(Scene& scene, const std::string& key, double frame, bool broken) {
    Keyframe<Numbers>* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    keyframe->broken = broken;
    if (!broken) follow(keyframe->in, acting(scene, key, frame, HandleSide::out));
}

void set_handle(Scene& scene, const std::string& key, double frame, HandleSide side, double frames,
                const Numbers& value) {
    Keyframe<Numbers>* const keyframe = keyframe_of(scene, key, frame);
    if (!keyframe) return;
    const Handle<Numbers> second = freed(scene, key, frame, other(side));
    const bool right_side = side == HandleSide::in ? frames < 0.0 : frames > 0.0;
    handle_at(*keyframe, side) = {HandleKind::free, right_side ? frames : 0.0, value};
    if (keyframe->broken) return;
    handle_at(*keyframe, other(side)) = second;
    follow(handle_at(*keyframe, other(side)), handle_at(*keyframe, side));
}

}  // namespace astrosplat
