// A move is a few Bezier keyframes that follow it to 0.1 % of its distance; the easing is in their handles,
// so keyframes outside the move keep their own timing.
#include "edit/camera_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "core/real.h"
#include "core/rotation.h"
#include "edit/fit_path.h"
#include "edit/keyframes.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

constexpr double move_seconds = 10.0;
constexpr double tolerance = 8e-4;        // of the distance to the middle
constexpr double fly_in_share = 0.15;     // of the distance that is left at the end
constexpr double face_on_tilt_deg = 0.1;  // exactly face-on, "up" would be undefined

const char* const position_key = "camera.position";
const char* const target_key = "camera.target";
const char* const rotation_key = "camera.rotation";

Value vector_value(const glm::dvec3& v) { return Value::List{v.x, v.y, v.z}; }

void set_lens_and_up(CameraParams& params, const CameraParams& camera) {
    params.projection = camera.projection;
    params.fov = camera.fov;
    params.focal_length = camera.focal_length;
    params.height = camera.height;
    params.up = camera.up;
    params.roll = camera.roll;
}

void set_orientation_keyframe(Scene& scene, const CameraParams& camera, double frame) {
    const bool turns = scene.camera.rotation || camera.rotation || is_animated(scene, rotation_key);
    if (!turns) {
        set_keyframe(scene, target_key, frame, vector_value(camera.target));
        return;
    }
    const glm::dquat q =
        glm::quat_cast(make_camera(camera, aspect_of(scene.output), 1.0, {}).world_from_camera);
    set_keyframe(scene, rotation_key, frame, Value::List{q.x, q.y, q.z, q.w});
}

/// A place on the way, of the share 0..1 of the move that is done.
using Path = std::function<glm::dvec3(double)>;

double ease(double t) { return t * t * (3.0 - 2.0 * t); }

template <class Gone>
void remove_keyframes(Scene& scene, const std::string& key, const Gone& gone) {
    for (Track& track : scene.animation)
        if (track.key == key)
            std::erase_if(track.keyframes, [&](const auto& keyframe) { return gone(keyframe.frame); });
}

void remove_empty_tracks(Scene& scene) {
    std::erase_if(scene.animation, [](const Track& track) { return track.keyframes.empty(); });
}

bool is_camera_track(const Track& track) { return track.key.is_below("camera"); }

/// Makes room for a move of `frames` frames from `frame` on. What is animated only later stays as it was at
/// `frame`.
void make_room(Scene& scene, double frame, double frames, LaterKeys later) {
    const Scene now = scene_at(scene, frame);
    for (Track& track : scene.animation) {
        if (!is_camera_track(track)) continue;
        if (later == LaterKeys::replace)
            remove_keyframes(scene, track.key, [&](double at) { return at > frame; });
        if (later == LaterKeys::shift)
            for (auto& keyframe : track.keyframes)
                if (keyframe.frame > frame) keyframe.frame += frames;
        if (track.keyframes.empty()) scene.camera = now.camera;
    }
    for (const char* key : {position_key, target_key})
        remove_keyframes(scene, key, [&](double at) { return at >= frame && at <= frame + frames; });
    remove_empty_tracks(scene);
}

void set_smooth_keyframe(Scene& scene, const char* key, double frame, const glm::dvec3& value) {
    set_keyframe(scene, key, frame, vector_value(value));
    set_interpolation(scene, key, frame, Interpolation::smooth);
}

/// In order, where no keyframe of that time is left.
void insert_positions(Scene& scene, const std::vector<Keyframe<glm::dvec3>>& keyframes) {
    set_smooth_keyframe(scene, position_key, keyframes.front().frame, keyframes.front().value);
    for (Track& track : scene.animation) {
        if (track.key != position_key) continue;
        track.constant_speed = false;  // the handles carry the speed
        auto at = std::ranges::find(track.keyframes, keyframes.front().frame,
                                    &Keyframe<std::vector<double>>::frame);
        at = track.keyframes.erase(at);
        for (const Keyframe<glm::dvec3>& k : keyframes) {
            const auto numbers = [](const glm::dvec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
            const auto handle = [&](const Handle<glm::dvec3>& h) {
                return h.kind == HandleKind::free
                           ? Handle<std::vector<double>>{h.kind, h.frames, numbers(h.value)}
                           : Handle<std::vector<double>>{};
            };
            at = track.keyframes.insert(
                at, {k.frame, numbers(k.value), k.interpolation, handle(k.in), handle(k.out)});
            ++at;
        }
        (at - 1)->interpolation = Interpolation::smooth;
    }
}

/// The frames to render reach to the end of the move, whose last keyframe is where a loop would begin again.
void extend_frames(Scene& scene, std::int64_t first, std::int64_t last) {
    const std::vector<std::int64_t> frames = parse_frames(scene.output.frames, "output.frames");
    if (frames.back() >= last) return;
    const bool gapless = frames.back() - frames.front() + 1 == static_cast<std::int64_t>(frames.size());
    if (gapless && first <= frames.back() + 1)
        scene.output.frames = fmt::format("{}-{}", std::min(first, frames.front()), last);
    else
        scene.output.frames += fmt::format(",{}-{}", first, last);
}

void add_path(Scene& scene, const Path& path, const glm::dvec3& target, double frame, LaterKeys later) {
    const double frames = std::fmax(1.0, std::floor(move_seconds * scene.output.fps + 0.5));
    const bool shifts = later == LaterKeys::shift && camera_keyframes_after(scene, frame) > 0;
    const double end =
        shifts ? static_cast<double>(parse_frames(scene.output.frames, "output.frames").back()) + frames
               : frame + frames - 1.0;
    remove_track(scene, rotation_key);  // it would replace the target
    scene.camera.rotation.reset();
    make_room(scene, frame, frames, later);
    const auto place = [&](double at) { return path(ease((at - frame) / frames)); };
    const double distance = glm::distance(path(0.0), target);
    insert_positions(scene, fit_path(place, frame, frame + frames, tolerance * std::fmax(distance, 1e-9)));
    set_smooth_keyframe(scene, target_key, frame, target);
    set_smooth_keyframe(scene, target_key, frame + frames, target);
    extend_frames(scene, std::llround(frame), std::llround(end));
}

/// Where the camera is at a frame; a camera without a position frames the box.
glm::dvec3 camera_place(const Scene& scene, const Bounds& box, double frame) {
    const CameraParams camera = scene_at(scene, frame).camera;
    return camera.position ? *camera.position : make_camera(camera, aspect_of(scene.output), 1.0, box).eye;
}

Path orbit_path(const glm::dvec3& middle, const glm::dvec3& start) {
    glm::dvec3 arm = start - middle;
    const glm::dvec3 height(0.0, arm.y, 0.0);
    arm.y = 0.0;
    if (glm::length(arm) == 0.0) arm.z = std::fmax(std::fabs(height.y), 1e-6);
    const glm::dvec3 across(arm.z, 0.0, -arm.x);  // towards +x from +z
    return [=](double share) {
        const double angle = share * 2.0 * real::pi;
        return middle + height + arm * real::cos(angle) + across * real::sin(angle);
    };
}

/// The distance shrinks by the same factor at every step of the share: the frame fills evenly.
Path fly_in_path(const glm::dvec3& middle, const glm::dvec3& start) {
    return [=](double share) { return middle + (start - middle) * real::pow(fly_in_share, share); };
}

/// The thin direction of what is seen: the first visible layer's axis.
glm::dvec3 thin_direction(const Scene& scene) {
    for (const LayerParams& layer : scene.layers)
        if (layer.visible) return glm::normalize(rotation_from_degrees(layer.transform.rotate) * layer.axis);
    return {0.0, 1.0, 0.0};
}

/// From above the thin direction to the side on which the camera is, at a distance that holds the whole box.
Path face_on_path(const Scene& scene, const Bounds& box, const glm::dvec3& start) {
    const glm::dvec3 middle = box.center(), axis = thin_direction(scene);
    glm::dvec3 side = start - middle;
    side -= axis * glm::dot(side, axis);
    if (!(glm::length(side) > 1e-9 * glm::length(start - middle))) side = glm::dvec3(0.0, 0.0, 1.0);
    side -= axis * glm::dot(side, axis);
    if (!(glm::length(side) > 0.0)) side = glm::dvec3(1.0, 0.0, 0.0);
    side = glm::normalize(side);
    const Framing framing = frame_box(box, scene.camera.fov, aspect_of(scene.output));
    const double distance = glm::length(framing.position - framing.target);
    return [=](double share) {
        const double angle = real::radians(face_on_tilt_deg + share * (90.0 - face_on_tilt_deg));
        return middle + (axis * real::cos(angle) + side * real::sin(angle)) * distance;
    };
}

}  // namespace

void set_camera_keyframe(Scene& scene, const CameraParams& camera, double frame) {
    const bool moves = std::ranges::any_of(scene.animation, is_camera_track);
    if (!moves) set_lens_and_up(scene.camera, camera);
    if (camera.position) set_keyframe(scene, position_key, frame, vector_value(*camera.position));
    set_orientation_keyframe(scene, camera, frame);
    Scene source = scene;
    source.camera = camera;
    for (const Parameter& parameter : describe(source).parameters) {
        const ParameterKey& key = parameter.spec.key;
        if (!key.is_below("camera") || key == position_key || key == target_key || key == rotation_key)
            continue;
        if (is_animated(scene, key)) set_keyframe(scene, key, frame, parameter.get());
    }
}

void set_keyframe_of_seen_camera(Scene& scene, const ViewState& view, const Status& status) {
    set_camera_keyframe(scene, seen_camera(scene, view, status), std::round(view.frame));
}

std::size_t camera_keyframes_after(const Scene& scene, double frame) {
    std::set<double> frames;
    for (const Track& track : scene.animation)
        if (is_camera_track(track))
            for (const auto& keyframe : track.keyframes)
                if (keyframe.frame > frame) frames.insert(keyframe.frame);
    return frames.size();
}

void add_camera_move(Scene& scene, CameraMove move, const Bounds& box, double frame, LaterKeys later) {
    Bounds seen = box;
    if (seen.empty()) seen.add(glm::dvec3(0.0));
    const glm::dvec3 middle = seen.center(), start = camera_place(scene, seen, frame);
    const Path path = move == CameraMove::orbit    ? orbit_path(middle, start)
                      : move == CameraMove::fly_in ? fly_in_path(middle, start)
                                                   : face_on_path(scene, seen, start);
    add_path(scene, path, middle, frame, later);
}

}  // namespace astrosplat
