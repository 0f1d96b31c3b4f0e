// Session: mouse and keys over the viewport become a camera (VIEWER.md). Moving in the scene's camera goes to
// a free copy of it, unless the camera is locked to the view: then the scene's camera is edited, one undo
// step a gesture.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "edit/keys.h"
#include "edit/navigate.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/describe.h"
#include "scene/layer_setup.h"
#include "viewer/session_impl.h"

namespace astrosplat {
namespace {

bool moves(const ViewportInput& input) {
    using Drag = ViewportInput::Drag;
    const bool dragged = input.drag != Drag::none && input.drag != Drag::wipe &&
                         (input.delta_px != glm::dvec2(0.0) || input.fly != glm::dvec3(0.0));
    return dragged || (input.wheel != 0.0f && input.hovered) || input.double_click;
}

/// A perspective camera of the same direction that shows the pivot's plane at the same scale.
FreeCamera in_perspective(FreeCamera camera) {
    const glm::dvec3 back = glm::normalize(camera.position - camera.pivot);
    camera.position =
        camera.pivot + back * (0.5 * camera.height / real::tan(0.5 * real::radians(camera.fov_deg)));
    camera.orthographic = false;
    return camera;
}

/// Sets what differs between two cameras: keys where a parameter is keyed.
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
                if (is_keyed(scene, key))
                    set_key(scene, key, frame, parameter.get());
                else
                    find_parameter(parameters, key)->set(parameter.get());
            }
        },
        gesture);
}

}  // namespace

/// What the picture looks through now, as a free camera.
FreeCamera Session::Impl::picture_camera() const {
    return free_camera(request.scene.camera, request.box,
                       static_cast<double>(request.width) / request.height);
}

/// The same for the whole viewport, so that leaving a picture narrower than the viewport changes no scale.
FreeCamera Session::Impl::viewport_camera() const {
    FreeCamera camera = picture_camera();
    if (view.size == SizeMode::one_to_one) return camera;
    const double taller = static_cast<double>(viewport_height) / request.height;
    camera.height *= taller;
    camera.fov_deg = 2.0 * real::degrees(real::atan(taller * real::tan(0.5 * real::radians(camera.fov_deg))));
    return camera;
}

void Session::Impl::leave_scene_camera(bool turning) {
    const bool from_camera = view.view == ViewKind::camera;
    view.free = viewport_camera();
    // Front, top and side are flat; turned, a thing looks solid only in perspective.
    if (!from_camera && turning) view.free = in_perspective(view.free);
    view.view = ViewKind::free;
    if (from_camera) say("Free view, a copy of the camera; 0 returns to it");
}

/// One frame of mouse and keys on a camera.
FreeCamera Session::Impl::moved(FreeCamera camera, const ViewportInput& input, const glm::dvec2& viewport_px,
                                double elapsed_s) {
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
            if (input.wheel != 0.0f) fly_speed *= std::pow(1.25, input.wheel);
            const double size = status.box.empty() ? 10.0 : glm::length(status.box.hi - status.box.lo);
            return fly(camera, input.fly * (input.speed * fly_speed * size * elapsed_s));
        }
        default:
            break;
    }
    if (input.wheel != 0.0f && input.hovered)
        camera = zoom_to(camera, input.wheel, input.mouse_px, viewport_px);
    if (input.double_click) camera = with_pivot(camera, point_under(camera, input.mouse_px, viewport_px));
    return camera;
}

void Session::Impl::navigate(const ViewportInput& input, double elapsed_s) {
    if (input.drag_begins) ++gesture;
    if (!moves(input)) return;
    const glm::dvec2 viewport_px(viewport_width, viewport_height);
    if (view.view == ViewKind::camera && view.lock_to_camera) {
        const glm::dvec2 picture_px(request.width, request.height);
        const FreeCamera camera = moved(picture_camera(), input, picture_px, elapsed_s);
        const CameraParams& now = request.scene.camera;
        edit_camera(document, now, moved_camera(now, camera, picture_px.x / picture_px.y), view.frame,
                    gesture);
        return;
    }
    using Drag = ViewportInput::Drag;
    const bool turning = input.drag == Drag::orbit || input.drag == Drag::look;
    if (view.view != ViewKind::free) leave_scene_camera(turning);
    view.free = moved(view.free, input, viewport_px, elapsed_s);
}

Bounds Session::Impl::layer_box(std::size_t index) const {
    const Scene now = scene_at(document.scene(), view.frame);
    if (index >= now.layers.size()) return status.box;
    const auto loaded = loader.layer(now.layers[index].name);
    return loaded ? world_bounds(loaded->box, render_layer(now.layers[index])) : status.box;
}

void Session::Impl::frame_box_in_view(const Bounds& box) {
    if (box.empty()) return;
    if (view.view != ViewKind::free) leave_scene_camera(false);
    const double aspect = static_cast<double>(viewport_width) / viewport_height;
    view.free = framed(view.free, box, aspect);
}

void Session::navigate(const ViewportInput& input, double now) {
    Impl& self = *impl_;
    const double elapsed = self.navigated_at < 0.0 ? 0.0 : std::min(0.1, now - self.navigated_at);
    self.navigated_at = now;
    if (self.request.width <= 0) return;
    self.probe(input.hovered ? input.mouse_px : glm::dvec2(-1.0));
    if (self.view.size == SizeMode::one_to_one) return;  // the widgets move and zoom the picture
    self.navigate(input, elapsed);
}

}  // namespace astrosplat
