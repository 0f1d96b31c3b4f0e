// A move is a few Bezier keyframes that follow it to 0.1 % of its distance; the easing is in their handles,
// so keyframes outside the move keep their own timing.
#include "edit/view_camera.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "camera/framing.h"
#include "camera/keyframe.h"
#include "core/real.h"
#include "core/rotation.h"
#include "edit/edits.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

// A path into keyframes: by bisection the farthest keyframe that one segment reaches within the tolerance,
// then the next from there. Then the tolerance is lowered while the number of segments stays, so that the
// last one is no rest of the others.

/// Scene units at a frame; smooth.
using PathInTime = std::function<glm::dvec3(double frame)>;

constexpr int samples = 16;               // of a segment, where it is compared with the path
constexpr double least_step = 1.0 / 512;  // of a handle's length, as a share of its segment

/// A segment whose handles have the path's velocities, `out` and `in` of its frames long.
struct FittedSegment {
    double out = 1.0 / 3.0, in = 1.0 / 3.0;
    double error = 0.0;  // the largest distance to the path at the same frame, scene units
};

class Fitter {
  public:
    Fitter(const PathInTime& path, double first, double last) : path_(path), first_(first), last_(last) {}

    /// Keyframes as counts of frames from the first.
    std::vector<double> greedy(double tolerance) const {
        std::vector<double> ends = {0.0};
        const double length = last_ - first_;
        while (ends.back() < length) {
            double lo = ends.back() + 1.0, hi = length;
            while (lo < hi) {
                const double mid = std::floor(0.5 * (lo + hi + 1.0));
                if (best(ends.back(), mid).error < tolerance)
                    lo = mid;
                else
                    hi = mid - 1.0;
            }
            ends.push_back(std::fmin(lo, length));
        }
        return ends;
    }

    /// By turns one handle, the other, or both at once, in ever smaller steps.
    FittedSegment best(double from, double to) const {
        constexpr std::array<std::array<double, 2>, 6> ways = {
            {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}};
        FittedSegment found;
        found.error = error_of(found, from, to);
        for (double step = 0.25; step > least_step;) {
            const FittedSegment before = found;
            for (const auto& [out, in] : ways) {
                FittedSegment next{std::clamp(before.out + out * step, 0.0, 1.0),
                                   std::clamp(before.in + in * step, 0.0, 1.0)};
                next.error = error_of(next, from, to);
                if (next.error < found.error) found = next;
            }
            if (found.error == before.error) step *= 0.5;
        }
        return found;
    }

    glm::dvec3 place(double at) const { return path_(first_ + at); }

    /// Scene units a frame.
    glm::dvec3 velocity(double at) const {
        constexpr double h = 1e-3;
        const double before = std::fmax(0.0, at - h), after = std::fmin(last_ - first_, at + h);
        return (place(after) - place(before)) / (after - before);
    }

  private:
    double error_of(const FittedSegment& segment, double from, double to) const {
        const double span = to - from;
        const glm::dvec3 a = place(from), d = place(to);
        const glm::dvec3 b = a + velocity(from) * (segment.out * span),
                         c = d - velocity(to) * (segment.in * span);
        double most = 0.0;
        for (int i = 1; i < samples; ++i) {
            const double u = static_cast<double>(i) / samples;
            const double at = from + span * bezier_point(0.0, segment.out, 1.0 - segment.in, 1.0, u);
            most = std::fmax(most, glm::distance(bezier_point(a, b, c, d, u), place(at)));
        }
        return most;
    }

    const PathInTime& path_;
    double first_, last_;
};

/// As few Bezier keyframes as follow the path, at whole numbers of frames from `first` on, the last one at
/// `last` (a whole number of frames later, 1 at least). Between them the path is missed by less than
/// `tolerance` scene units at every frame, unless it takes a bend within a single one; at them, speed and
/// direction are the path's.
std::vector<Keyframe<glm::dvec3>> fit_path(const PathInTime& path, double first, double last,
                                           double tolerance) {
    const Fitter fitter(path, first, last);
    std::vector<double> ends = fitter.greedy(tolerance);
    for (int i = 0; i < 20; ++i) {
        std::vector<double> more_even = fitter.greedy(tolerance *= 0.9);
        if (more_even.size() > ends.size()) break;
        ends = std::move(more_even);
    }
    std::vector<Keyframe<glm::dvec3>> keyframes;
    for (const double at : ends)
        keyframes.push_back({first + at, fitter.place(at), Interpolation::bezier, {}, {}});
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const FittedSegment segment = fitter.best(ends[i], ends[i + 1]);
        const double span = ends[i + 1] - ends[i], out = segment.out * span, in = segment.in * span;
        keyframes[i].out = {HandleKind::free, out, fitter.velocity(ends[i]) * out};
        keyframes[i + 1].in = {HandleKind::free, -in, fitter.velocity(ends[i + 1]) * -in};
    }
    return keyframes;
}

// The moves.

constexpr double tolerance = 8e-4;        // of the distance to the middle
constexpr double fly_in_share = 0.15;     // of the distance that is left at the end
constexpr double face_on_tilt_deg = 0.1;  // exactly face-on, an up along the axis would be undefined
constexpr double least_share = 1e-7;      // of the distance to the middle: finer digits say nothing

const char* const position_key = "camera.position";
const char* const target_key = "camera.target";
const char* const up_key = "camera.up";
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

/// A move around `middle`.
struct Move {
    glm::dvec3 middle;
    std::function<glm::dvec3(double)> place;   // on the way, of the share 0..1 that is done
    std::optional<glm::dvec3> up_at_end = {};  // where the camera's up turns, too
};

bool is_camera_track(const Track& track) { return track.key.is_below("camera"); }

/// Makes room for a move of `frames` frames from `frame` on, in `keys`. What is animated only later stays as
/// it was at `frame`.
void make_room(Scene& scene, std::span<const char* const> keys, double frame, double frames,
               LaterKeys later) {
    const Scene now = scene_at(scene, frame);
    for (Track& track : scene.animation) {
        if (!is_camera_track(track)) continue;
        if (later == LaterKeys::replace)
            std::erase_if(track.keyframes, [&](const auto& keyframe) { return keyframe.frame > frame; });
        if (later == LaterKeys::shift)
            for (auto& keyframe : track.keyframes)
                if (keyframe.frame > frame) keyframe.frame += frames;
        if (track.keyframes.empty()) scene.camera = now.camera;
    }
    for (const char* key : keys)
        if (Track* const track = find_track(scene, key))
            std::erase_if(track->keyframes,
                          [&](const auto& k) { return k.frame >= frame && k.frame <= frame + frames; });
    std::erase_if(scene.animation, [](const Track& track) { return track.keyframes.empty(); });
}

glm::dvec3 rounded(const glm::dvec3& v, double step) {
    return {rounded_to_step(v.x, step), rounded_to_step(v.y, step), rounded_to_step(v.z, step)};
}

void set_smooth_keyframe(Scene& scene, const char* key, double frame, const glm::dvec3& value) {
    set_keyframe(scene, key, frame, vector_value(value));
    set_interpolation(scene, key, frame, Interpolation::smooth);
}

/// In order, where make_room() has left no keyframe; places to `step` scene units.
void insert_positions(Scene& scene, const std::vector<Keyframe<glm::dvec3>>& keyframes, double step) {
    using Numbers = std::vector<double>;
    constexpr double frame_step = 1e-3;
    const auto numbers = [&](const glm::dvec3& v) {
        const glm::dvec3 r = rounded(v, step);
        return Numbers{r.x, r.y, r.z};
    };
    const auto handle = [&](const Handle<glm::dvec3>& h) {
        if (h.kind != HandleKind::free) return Handle<Numbers>{};
        return Handle<Numbers>{h.kind, rounded_to_step(h.frames, frame_step), numbers(h.value)};
    };
    set_smooth_keyframe(scene, position_key, keyframes.front().frame, keyframes.front().value);
    Track& track = *find_track(scene, position_key);
    track.constant_speed = false;  // the handles carry the speed
    auto at = std::ranges::find(track.keyframes, keyframes.front().frame, &Keyframe<Numbers>::frame);
    at = track.keyframes.erase(at);
    for (const Keyframe<glm::dvec3>& k : keyframes)
        at = 1 + track.keyframes.insert(
                     at, {k.frame, numbers(k.value), k.interpolation, handle(k.in), handle(k.out)});
    (at - 1)->interpolation = Interpolation::smooth;
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

/// Frames after `frame` at which the camera has keyframes.
std::set<double> later_frames(const Scene& scene, double frame) {
    std::set<double> frames;
    for (const Track& track : scene.animation)
        if (is_camera_track(track))
            for (const auto& keyframe : track.keyframes)
                if (keyframe.frame > frame) frames.insert(keyframe.frame);
    return frames;
}

/// Over the move from what it is to `up`; keyframes after the move were made with what it is.
void turn_up(Scene& scene, const glm::dvec3& up, double frame, double end) {
    const glm::dvec3 before = scene_at(scene, frame).camera.up;
    const bool is_new = !is_animated(scene, up_key);
    set_smooth_keyframe(scene, up_key, frame, before);
    set_smooth_keyframe(scene, up_key, end, up);
    const std::set<double> later = later_frames(scene, end);
    if (is_new && !later.empty()) set_smooth_keyframe(scene, up_key, *later.begin(), before);
}

void add_path(Scene& scene, const Move& move, double frame, LaterKeys later) {
    const double frames = film_frames(scene.output);
    const bool shifts = later == LaterKeys::shift && !later_frames(scene, frame).empty();
    const double end = shifts ? frame_range(scene.output).last + frames : frame + frames - 1.0;
    remove_track(scene, rotation_key);  // it would replace the target
    scene.camera.rotation.reset();
    const char* const keys[] = {position_key, target_key, up_key};
    make_room(scene, std::span(keys).first(move.up_at_end ? 3 : 2), frame, frames, later);
    const double distance = std::fmax(glm::distance(move.place(0.0), move.middle), 1e-9);
    const auto place = [&](double at) { return move.place(real::smoothstep((at - frame) / frames)); };
    const double step = least_share * distance;
    insert_positions(scene, fit_path(place, frame, frame + frames, tolerance * distance), step);
    for (const double at : {frame, frame + frames})
        set_smooth_keyframe(scene, target_key, at, rounded(move.middle, step));
    if (move.up_at_end) turn_up(scene, *move.up_at_end, frame, frame + frames);
    extend_frames(scene, std::llround(frame), std::llround(end));
}

/// A camera without a position frames the box.
glm::dvec3 place_of(const CameraParams& camera, const Scene& scene, const Bounds& box) {
    return camera.position ? *camera.position : make_camera(camera, aspect_of(scene.output), 1.0, box).eye;
}

/// The point that the camera looks at, where that is within the box; else the box's centre.
glm::dvec3 middle_of(const CameraParams& camera, const Bounds& box) {
    const bool looks_there = camera.position && !camera.rotation;
    return looks_there && box.contains(camera.target) ? camera.target : box.center();
}

glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis) { return v - axis * glm::dot(v, axis); }

/// The direction across the axis in which `arm` goes; any where it goes along the axis.
glm::dvec3 side_of(const glm::dvec3& arm, const glm::dvec3& axis) {
    glm::dvec3 side = across(arm, axis);
    if (!(glm::length(side) > 1e-9 * glm::length(arm))) side = across({0.0, 0.0, 1.0}, axis);
    if (!(glm::length(side) > 0.0)) side = across({1.0, 0.0, 0.0}, axis);
    return glm::normalize(side);
}

/// A circle around the camera's up, which stays upright; at its height.
Move orbit(const CameraParams& camera, const glm::dvec3& middle, const glm::dvec3& start) {
    const glm::dvec3 up = glm::normalize(camera.up), arm = start - middle;
    const double height = glm::dot(arm, up), distance = glm::length(across(arm, up));
    const double radius = distance > 0.0 ? distance : std::fmax(std::fabs(height), 1e-6);
    const glm::dvec3 from = side_of(arm, up), towards = glm::cross(up, from);  // +x from +z
    return {middle, [=](double share) {
                const double angle = share * 2.0 * real::pi;
                return middle + up * height + radius * (from * real::cos(angle) + towards * real::sin(angle));
            }};
}

/// The distance shrinks by the same factor at every step of the share: the frame fills evenly.
Move fly_in(const glm::dvec3& middle, const glm::dvec3& start) {
    return {middle, [=](double share) { return middle + (start - middle) * real::pow(fly_in_share, share); }};
}

/// The thin direction of what is seen: the first visible layer's axis.
glm::dvec3 thin_direction(const Scene& scene) {
    for (const LayerParams& layer : scene.layers)
        if (layer.visible) return glm::normalize(rotation_from_degrees(layer.transform.rotate) * layer.axis);
    return {0.0, 1.0, 0.0};
}

/// From above the thin direction to its side. Begins where the camera is, if that is face-on already; else at
/// a distance that holds the whole box. What is up in the first frame stays up in every one, and in the
/// last one the axis is, so that a disk lies in the frame: an up across the axis, as of a picture's own
/// camera, turns to it on the way.
Move face_on_to_edge_on(const Scene& scene, const CameraParams& camera, const Bounds& box,
                        const glm::dvec3& middle, const glm::dvec3& start) {
    constexpr double least_across = 0.1;
    constexpr double face_on_cosine = 0.9998;  // within a degree
    const glm::dvec3 arm = start - middle, up = glm::normalize(camera.up);
    glm::dvec3 axis = thin_direction(scene);
    if (glm::dot(arm, axis) < 0.0) axis = -axis;
    const Framing framing = frame_box(box, camera, aspect_of(scene.output));
    const bool is_face_on = glm::dot(arm, axis) > face_on_cosine * glm::length(arm);
    const double distance = is_face_on ? glm::length(arm) : glm::length(framing.position - framing.target);
    const bool turns = glm::length(across(up, axis)) > least_across;
    const double sign = glm::dot(up, axis) < 0.0 ? -1.0 : 1.0;  // of the axis that is up in the end
    const glm::dvec3 side = turns ? -sign * side_of(up, axis) : side_of(arm, axis);
    const double from_deg = turns ? 0.0 : face_on_tilt_deg;
    Move move{middle, [=](double share) {
                  const double angle = real::radians(from_deg + share * (90.0 - from_deg));
                  return middle + (axis * real::cos(angle) + side * real::sin(angle)) * distance;
              }};
    if (turns) move.up_at_end = sign * axis;
    return move;
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
    return later_frames(scene, frame).size();
}

void add_camera_move(Scene& scene, CameraMove move, const Bounds& box, double frame, LaterKeys later) {
    Bounds seen = box;
    if (seen.empty()) seen.add(glm::dvec3(0.0));
    const CameraParams camera = scene_at(scene, frame).camera;
    const glm::dvec3 middle = middle_of(camera, seen), start = place_of(camera, scene, seen);
    const Move path = move == CameraMove::orbit    ? orbit(camera, middle, start)
                      : move == CameraMove::fly_in ? fly_in(middle, start)
                                                   : face_on_to_edge_on(scene, camera, seen, middle, start);
    add_path(scene, path, frame, later);
}

}  // namespace astrosplat
