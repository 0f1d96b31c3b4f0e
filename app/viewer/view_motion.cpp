#include "viewer/view_motion.h"

#include <glm/geometric.hpp>

#include "camera/projection.h"
#include "core/error.h"
#include "core/real.h"
#include "edit/edits.h"
#include "edit/placement.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

bool moves(const ViewportInput& input) {
    using Drag = ViewportInput::Drag;
    const bool of_camera = input.drag == Drag::orbit || input.drag == Drag::pan ||
                           input.drag == Drag::dolly || input.drag == Drag::look;
    const bool dragged = of_camera && (input.delta_px != glm::dvec2(0.0) || input.fly != glm::dvec3(0.0));
    return dragged || (input.wheel != 0.0f && input.hovered) || input.double_click;
}

/// A perspective camera of the same direction that shows the pivot's plane at the same scale.
FreeCamera in_perspective(FreeCamera camera) {
    const glm::dvec3 back = glm::normalize(camera.position - camera.pivot);
    camera.position =
        camera.pivot + back * (0.5 * camera.height / real::tan(0.5 * real::radians(camera.fov_deg)));
    camera.projection = Projection::perspective;
    return camera;
}

/// Sets what differs between two cameras: keyframes where a parameter is animated.
void edit_camera(Document& document, const CameraParams& before, const CameraParams& after, double frame,
                 Gesture gesture) {
    Scene old_scene, new_scene;
    old_scene.camera = before;
    new_scene.camera = after;
    const Description old_values = describe(old_scene), new_values = describe(new_scene);
    document.edit(
        "Move camera",
        [&](Scene& scene) {
            const Description parameters = describe(scene);
            for (const Parameter& parameter : new_values.parameters) {
                const std::string& key = parameter.spec.key;
                if (parameter.get() == find_parameter(old_values, key)->get()) continue;
                if (is_animated(scene, key))
                    set_keyframe(scene, key, frame, parameter.get());
                else
                    find_parameter(parameters, key)->set(parameter.get());
            }
        },
        gesture);
}

/// The camera of the frame now, as a free camera.
FreeCamera camera_of_view(const ViewRequest& request) {
    return free_camera(request.scene.camera, request.box,
                       static_cast<double>(request.width) / request.height);
}

/// The same for the whole viewport, so that leaving a frame narrower than the viewport changes no scale.
FreeCamera viewport_camera(const ViewState& view, const ShownView& shown) {
    const FreeCamera camera = camera_of_view(shown.request);
    if (view.size == SizeMode::one_to_one) return camera;
    return with_height(camera, shown.viewport_px.y / shown.request.height);
}

/// True: it was the scene's camera.
bool go_to_free_view(ViewState& view, const ShownView& shown, bool turning) {
    const bool from_camera = view.view == ViewKind::camera;
    view.free = viewport_camera(view, shown);
    // Front, top and side are flat; turned, a thing looks solid only in perspective.
    if (!from_camera && turning) view.free = in_perspective(view.free);
    view.view = ViewKind::free;
    return from_camera;
}

/// Of a scene all that its camera's path depends on, to notice when that changes; the rest at its defaults.
Scene camera_part(const Scene& scene) {
    Scene part;
    part.camera = scene.camera;
    part.output.width = scene.output.width;
    part.output.height = scene.output.height;
    part.output.frames = scene.output.frames;
    part.output.fps = scene.output.fps;
    part.imported = scene.imported;
    for (const Track& track : scene.animation)
        if (track.key.is_below("camera")) part.animation.push_back(track);
    return part;
}

/// Places of the scene's camera over the frames of [output], `step` frames apart; one where it stands still.
std::vector<glm::dvec3> camera_places(const Scene& scene, const Bounds& box, double step) {
    const auto [first, last] = frame_range(scene.output);
    std::vector<glm::dvec3> places;
    for (double frame = first; frame <= last; frame += step) {
        const Scene now = scene_at(scene, frame);
        const glm::dvec3 eye = make_camera(now.camera, static_cast<double>(now.output.width),
                                           static_cast<double>(now.output.height), box)
                                   .eye;
        if (places.empty() || places.back() != eye) places.push_back(eye);
    }
    return places;
}

std::vector<glm::dvec3> camera_path(const Scene& scene, const Bounds& box) {
    constexpr double most = 256.0;
    const auto [first, last] = frame_range(scene.output);
    return camera_places(scene, box, std::max(1.0, (last - first) / (most - 1.0)));
}

/// Frames between two ticks: a second, halved or doubled until there are neither few nor a crowd.
double tick_frames(const OutputParams& output) {
    constexpr double few = 8.0, many = 40.0;
    const auto [first, last] = frame_range(output);
    double step = std::max(1.0, std::round(output.fps));
    while (step > 1.0 && (last - first) / step < few) step = std::max(1.0, 0.5 * step);
    while ((last - first) / step > many) step *= 2.0;
    return step;
}

/// Edges of the pyramid that `camera` sees, out to `length` scene units: lines of the four corners, then the
/// frame with a mark above its upper side.
std::vector<std::vector<glm::dvec3>> frustum(const Camera& camera, double width_px, double height_px,
                                             double length) {
    const auto corner = [&](double x_px, double y_px) {
        return camera.eye +
               camera.world_from_camera * exact::point_at_depth(make_exact_lens(camera), x_px, y_px, length);
    };
    const glm::dvec3 corners[] = {corner(0, 0), corner(width_px, 0), corner(width_px, height_px),
                                  corner(0, height_px)};
    std::vector<std::vector<glm::dvec3>> lines;
    for (const glm::dvec3& c : corners) lines.push_back({camera.eye, c});
    lines.push_back({corners[0], corners[1], corners[2], corners[3], corners[0]});
    lines.push_back({corner(0.4 * width_px, -0.04 * height_px), corner(0.5 * width_px, -0.16 * height_px),
                     corner(0.6 * width_px, -0.04 * height_px), corner(0.4 * width_px, -0.04 * height_px)});
    return lines;
}

/// Between the in and out points, where they lie within the frames.
FrameRange play_range(const ViewState& view, const OutputParams& output) {
    const auto [first, last] = frame_range(output);
    FrameRange range{std::clamp(view.play_first.value_or(first), first, last),
                     std::clamp(view.play_last.value_or(last), first, last)};
    if (range.first > range.last) range.last = last;
    return range;
}

}  // namespace

FreeCamera Navigator::moved(FreeCamera camera, const ViewportInput& input, const glm::dvec2& viewport_px,
                            const Bounds& box, double elapsed_s) {
    switch (input.drag) {
        case ViewportInput::Drag::orbit:
            camera = orbit(camera, input.delta_px, viewport_px.y);
            break;
        case ViewportInput::Drag::pan:
            camera = pan(camera, input.delta_px, viewport_px.y);
            break;
        case ViewportInput::Drag::dolly:
            camera = dolly(camera, input.delta_px, viewport_px.y);
            break;
        case ViewportInput::Drag::look: {
            camera = look_around(camera, input.delta_px, viewport_px.y);
            if (input.wheel != 0.0f) fly_speed_ *= std::pow(1.25, input.wheel);
            const double size = box.empty() ? 10.0 : glm::length(box.extent());
            return fly(camera, input.fly * (input.speed * fly_speed_ * size * elapsed_s));
        }
        default:
            break;
    }
    if (input.wheel != 0.0f && input.hovered)
        camera = zoom_to(camera, input.wheel, input.mouse_px, viewport_px);
    if (input.double_click) camera = with_pivot(camera, point_under(camera, input.mouse_px, viewport_px));
    return camera;
}

bool Navigator::navigate(const ViewportInput& input, const ShownView& shown, double now, Document& document,
                         ViewState& view) {
    const double before = std::exchange(navigated_at_, now);
    const double elapsed_s = before < 0.0 ? 0.0 : std::min(0.1, now - before);
    if (input.drag_begins) ++gesture_;
    if (!moves(input)) return false;
    if (view.view == ViewKind::camera && view.lock_to_camera) {
        const glm::dvec2 frame_px(shown.request.width, shown.request.height);
        const FreeCamera camera = moved(camera_of_view(shown.request), input, frame_px, shown.box, elapsed_s);
        const CameraParams& old = shown.request.scene.camera;
        edit_camera(document, old, moved_camera(old, camera, frame_px.x / frame_px.y), view.frame, gesture_);
        return false;
    }
    using Drag = ViewportInput::Drag;
    const bool turning = input.drag == Drag::orbit || input.drag == Drag::look;
    const bool left = view.view != ViewKind::free && go_to_free_view(view, shown, turning);
    view.free = moved(view.free, input, shown.viewport_px, shown.box, elapsed_s);
    return left;
}

void keep_free_camera(ViewState& view, const ShownView& shown) {
    if (view.view == ViewKind::front || view.view == ViewKind::top || view.view == ViewKind::side)
        view.free = viewport_camera(view, shown);
}

bool frame_in_view(ViewState& view, const Bounds& box, const ShownView& shown) {
    if (box.empty()) return false;
    const bool left = view.view != ViewKind::free && go_to_free_view(view, shown, false);
    view.free = framed(view.free, box, shown.viewport_px.x / shown.viewport_px.y);
    return left;
}

std::vector<CameraOverlay::Line> CameraOverlay::lines(const Scene& scene, const Scene& now, const Bounds& box,
                                                      const ViewRequest& request, const Rect& place) {
    std::vector<Line> result;
    try {
        const bool same_box = path_box_.lo == box.lo && path_box_.hi == box.hi;
        if (Scene part = camera_part(scene); !same_box || part != path_of_) {
            path_ = camera_path(part, box);
            ticks_ = camera_places(part, box, tick_frames(part.output));
            path_of_ = std::move(part);
            path_box_ = box;
        }
        const Camera seen_through = camera_of(request);
        const double width = static_cast<double>(now.output.width),
                     height = static_cast<double>(now.output.height);
        const Camera camera = make_camera(now.camera, width, height, box);
        const double size = box.empty() ? 10.0 : glm::length(box.extent());
        std::vector<std::vector<glm::dvec3>> in_world = frustum(camera, width, height, 0.08 * size);
        in_world.push_back(path_);
        const float scale = place.width / static_cast<float>(request.width);
        for (const std::vector<glm::dvec3>& line : in_world)
            for (Line& part : project_line(seen_through, line)) {
                for (glm::vec2& p : part) p = glm::vec2(place.x, place.y) + scale * p;
                result.push_back(std::move(part));
            }
        for (const glm::dvec3& tick : ticks_)
            if (const auto at = project_point(seen_through, tick); at && ticks_.size() > 1)
                result.push_back({glm::vec2(place.x, place.y) + scale * *at});
    } catch (const InputError&) {
        result.clear();
    }
    return result;
}

double Playback::next_frame(double frame, double steps, ViewState& view, const OutputParams& output) {
    const auto [first, last] = play_range(view, output);
    if (frame < first || frame > last) return first;
    if (view.play_mode != PlayMode::ping_pong || first == last) {
        if (frame + steps <= last) return frame + steps;
        view.playing = view.play_mode != PlayMode::once;
        return view.playing ? first : last;
    }
    const double length = last - first;
    const double there = backwards_ ? 2.0 * length - (frame - first) : frame - first;
    const double at = std::fmod(there + steps, 2.0 * length);
    backwards_ = at >= length;
    return backwards_ ? last - (at - length) : first + at;
}

void Playback::advance(ViewState& view, const OutputParams& output, bool is_final, double now) {
    if (!view.playing) {
        played_at_ = -1.0;
        backwards_ = waited_ = false;
        shown_at_.clear();
        return;
    }
    if (played_at_ < 0.0) {
        played_at_ = now;
        const FrameRange range = play_range(view, output);
        if (view.play_mode == PlayMode::once && view.frame >= range.last) view.frame = range.first;
        return;
    }
    const double due = std::floor((now - played_at_) * output.fps);
    const bool waits = view.play_final && !is_final;
    waited_ = waited_ || waits;
    if (due < 1.0 || waits) return;
    const double steps = view.every_frame || std::exchange(waited_, false) ? 1.0 : due;
    view.frame = next_frame(std::floor(view.frame), steps, view, output);
    played_at_ = due > steps ? now : played_at_ + steps / output.fps;
    shown_at_.push_back(now);
    while (shown_at_.size() > 2 && now - shown_at_.front() > 1.0) shown_at_.pop_front();
}

double Playback::shown_fps() const {
    if (shown_at_.size() < 2) return 0.0;
    return static_cast<double>(shown_at_.size() - 1) / (shown_at_.back() - shown_at_.front());
}

}  // namespace astrosplat
