// Session: what the viewport shows. The view becomes a request for a picture; the picture and what it is
// compared with are placed in the viewport; lines of the camera are laid over it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/error.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "viewer/overlay.h"
#include "viewer/session_impl.h"

namespace astrosplat {
namespace {

/// What a picture does not depend on, at its default, so that editing it does not make the picture anew.
void forget_what_is_not_seen(Scene& scene) {
    const OutputParams standard;
    scene.file.clear();
    scene.provenance = {};
    scene.animation.clear();
    OutputParams& output = scene.output;
    output.frames = standard.frames;
    output.fps = standard.fps;
    output.path = standard.path;
    output.depth = standard.depth;
    output.compression = standard.compression;
    output.alpha = standard.alpha;
    output.view = standard.view;
    std::erase_if(output.aovs, [](const std::string& aov) { return aov != "depth"; });  // the probe shows it
}

DisplaySettings::View display_view(DisplayView chosen, OutputParams::View of_scene) {
    switch (chosen) {
        case DisplayView::linear:
            return DisplaySettings::View::linear;
        case DisplayView::srgb:
            return DisplaySettings::View::srgb;
        case DisplayView::soft:
            return DisplaySettings::View::soft;
        case DisplayView::scene:
            break;
    }
    if (of_scene == OutputParams::View::linear) return DisplaySettings::View::linear;
    return of_scene == OutputParams::View::soft ? DisplaySettings::View::soft : DisplaySettings::View::srgb;
}

}  // namespace

Scene Session::Impl::evaluated(const Scene& scene) const {
    Scene now = scene_at(scene, view.frame);
    if (!view.solo.empty())
        for (LayerParams& layer : now.layers) layer.visible = view.solo.count(layer.name) > 0;
    return now;
}

PictureRequest Session::Impl::make_request(Scene now) const {
    PictureRequest made;
    made.files = files_read_again;
    for (const LayerParams& layer : now.layers) {
        made.layers.push_back(loader.layer(layer.name));
        if (layer.visible && made.layers.back())
            made.box.add(world_bounds(made.layers.back()->box, render_layer(layer)));
    }
    const double output_aspect =
        static_cast<double>(now.output.width) / static_cast<double>(now.output.height);
    made.width = viewport_width;
    made.height = viewport_height;
    if (view.size == SizeMode::one_to_one) {
        made.width = static_cast<int>(now.output.width);
        made.height = static_cast<int>(now.output.height);
    } else if (view.view == ViewKind::camera && !viewport_is_picture) {
        const double height = std::min<double>(viewport_height, viewport_width / output_aspect);
        made.width = std::max(1, static_cast<int>(std::lround(height * output_aspect)));
        made.height = std::max(1, static_cast<int>(std::lround(height)));
    }
    const double aspect = static_cast<double>(made.width) / static_cast<double>(made.height);
    now.camera = view_camera(now, view, made.box, aspect);
    forget_what_is_not_seen(now);
    now.output.width = made.width;
    now.output.height = made.height;
    made.scene = std::move(now);
    return made;
}

namespace {

/// The part of a 1:1 picture that the viewport shows; empty: all of it.
Region visible_part(const Rect& place, int width, int height, int viewport_width, int viewport_height) {
    const double scale = static_cast<double>(place.width) / width;
    const auto low = [scale](double at) {
        return std::max<std::int64_t>(0, std::llround(std::floor(-at / scale)));
    };
    const auto high = [scale](double at, double end, int size) {
        return std::min<std::int64_t>(size, std::llround(std::ceil((end - at) / scale)));
    };
    Region part;
    part.x = low(place.x);
    part.y = low(place.y);
    part.width = std::max<std::int64_t>(1, high(place.x, viewport_width, width) - part.x);
    part.height = std::max<std::int64_t>(1, high(place.y, viewport_height, height) - part.y);
    if (part.width >= width && part.height >= height) return {};
    return part;
}

}  // namespace

/// The scene's camera and its path, seen from outside.
void Session::Impl::draw_overlay(const Scene& now, const Rect& place) {
    status.overlay_lines.clear();
    if (view.view == ViewKind::camera || !view.camera_path) return;
    try {
        const bool same_box = path_box.lo == status.box.lo && path_box.hi == status.box.hi;
        if (Scene part = camera_part(document.scene()); !same_box || part != path_of) {
            path = camera_path(part, status.box);
            path_of = std::move(part);
            path_box = status.box;
        }
        const Camera seen_through = camera_of(request);
        const double width = static_cast<double>(now.output.width),
                     height = static_cast<double>(now.output.height);
        const Camera camera = make_camera(now.camera, width, height, status.box);
        const double size = status.box.empty() ? 10.0 : glm::length(status.box.extent());
        std::vector<std::vector<glm::dvec3>> lines = frustum(camera, width, height, 0.08 * size);
        lines.push_back(path);
        const float scale = place.width / static_cast<float>(request.width);
        for (const std::vector<glm::dvec3>& line : lines)
            for (std::vector<glm::vec2>& part : project_line(seen_through, line)) {
                for (glm::vec2& p : part) p = glm::vec2(place.x, place.y) + scale * p;
                status.overlay_lines.push_back(std::move(part));
            }
    } catch (const InputError&) {  // a camera that cannot be made says so in the picture's badge
    }
}

/// Front, top and side make their camera from the layers' bounds in every frame: the free one follows, so
/// that the free view begins where the person is.
void Session::Impl::keep_free_camera() {
    if (view.view != ViewKind::front && view.view != ViewKind::top && view.view != ViewKind::side) return;
    view.free = viewport_camera();
}

void Session::draw(int viewport_width, int viewport_height, double now, bool hurry) {
    Impl& self = *impl_;
    self.viewport_width = std::max(1, viewport_width);
    self.viewport_height = std::max(1, viewport_height);
    self.status.viewport_aspect = static_cast<double>(self.viewport_width) / self.viewport_height;
    const Scene scene = self.evaluated(self.document.scene());
    const std::uint64_t sets = self.loader.revision();
    const bool new_sets = std::exchange(self.drawn_sets, sets) != sets;
    self.request = self.make_request(scene);
    self.keep_free_camera();
    const Rect port{0, 0, static_cast<float>(self.viewport_width), static_cast<float>(self.viewport_height)};
    Rect place = place_picture(self.view, port, self.request.width, self.request.height);
    const Rect whole = place;
    self.draw_overlay(scene, whole);
    if (self.view.size == SizeMode::one_to_one) {
        const float scale = place.width / static_cast<float>(self.request.width);
        self.request.region = visible_part(place, self.request.width, self.request.height,
                                           self.viewport_width, self.viewport_height);
        const Region& part = self.request.region;
        if (part.width > 0)
            place = {place.x + scale * static_cast<float>(part.x),
                     place.y + scale * static_cast<float>(part.y), scale * static_cast<float>(part.width),
                     scale * static_cast<float>(part.height)};
    }
    const PreviewChoice choice{self.view.engine == PreviewEngine::opengl ||
                                   (self.view.engine == PreviewEngine::automatic && !self.gl.software),
                               self.view.preview_share, self.fixed_splats};
    const bool may_settle = self.view.settle && !self.view.playing && self.loader.sets_there();
    const double start = thread_seconds();
    self.a.show(self.request, choice, may_settle, now, hurry);
    if (new_sets) self.new_set_draw_s = thread_seconds() - start;
    self.loader.hold(self.a.status().state == PictureState::refining);

    DisplaySettings shown;
    shown.view = display_view(self.view.display, scene.output.view);
    shown.exposure = static_cast<float>(scene.output.exposure) + self.view.inspect_exposure;
    shown.a = self.a.texture();
    shown.x = place.x;
    shown.y = place.y;
    shown.width = place.width;
    shown.height = place.height;
    self.show_comparison(shown, choice, may_settle, now);
    shown.content = 1 + self.a.version() + self.b.version() + self.references_loaded;
    shown.wipe = (whole.x + whole.width * self.view.wipe - place.x) / place.width;
    self.status.picture_texture =
        to_handle(self.display.draw(shown, self.viewport_width, self.viewport_height));
}

}  // namespace astrosplat
