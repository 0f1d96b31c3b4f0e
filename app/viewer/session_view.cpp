#include "viewer/session_view.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "edit/project_line.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "viewer/session_prepare.h"
#include "viewer/session_rendered.h"

namespace astrosplat {
namespace {

/// Whether the frame sees what is animated move: through the scene's camera, with an open shutter. Layers
/// shown alone would come and go with their tracks.
bool sees_motion(const Scene& scene, const ViewState& view) {
    return scene.camera.shutter > 0.0 && view.solo.empty() && view.view == ViewKind::camera;
}

/// What a frame does not depend on, at its default, so that editing it does not make the frame again.
void forget_what_is_not_seen(Scene& scene) {
    const OutputParams standard;
    scene.file.clear();
    scene.provenance = {};
    scene.references.clear();
    for (LayerParams& layer : scene.layers) layer.source.texture = {};  // the sets have what it says
    OutputParams& output = scene.output;
    output.frames = standard.frames;
    output.fps = standard.fps;
    output.path = standard.path;
    output.depth = standard.depth;
    output.compression = standard.compression;
    output.alpha = standard.alpha;
    output.view = standard.view;
    output.ocio = standard.ocio;
    std::erase_if(output.aovs, [](const std::string& aov) { return aov != "depth"; });  // the probe shows it
}

/// The part of a 1:1 frame that the viewport shows; empty: all of it.
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

/// Size in px of the whole frame.
glm::ivec2 frame_size(const Session& session, const OutputParams& output) {
    const glm::dvec2 output_px(static_cast<double>(output.width), static_cast<double>(output.height));
    if (session.view.size == SizeMode::one_to_one) return output_px;
    if (session.view.view != ViewKind::camera || session.viewport_is_frame) return session.viewport_px;
    const double aspect = output_px.x / output_px.y;
    const double height = std::min<double>(session.viewport_px.y, session.viewport_px.x / aspect);
    return {std::max(1, static_cast<int>(std::lround(height * aspect))),
            std::max(1, static_cast<int>(std::lround(height)))};
}

ViewRequest make_request(const Session& session, Scene now) {
    ViewRequest made;
    made.files = session.disk.changes();
    for (const LayerParams& layer : now.layers) {
        made.layers.push_back(session.sets.layer(layer));
        if (layer.visible && made.layers.back())
            made.box.add(world_bounds(made.layers.back()->box, render_layer(now, layer)));
    }
    const glm::ivec2 size = frame_size(session, now.output);
    made.width = size.x;
    made.height = size.y;
    const double aspect = static_cast<double>(made.width) / static_cast<double>(made.height);
    if (sees_motion(now, session.view))
        made.frame = session.view.frame;
    else
        stop_animation(now);
    now.camera = view_camera(now, session.view, made.box, aspect);
    forget_what_is_not_seen(now);
    now.output.width = made.width;
    now.output.height = made.height;
    made.scene = std::move(now);
    return made;
}

/// Limits a 1:1 frame to what the viewport shows of it; returns where that part lies.
Rect crop_to_viewport(ViewRequest& request, const Rect& whole, glm::ivec2 viewport_px) {
    request.region = visible_part(whole, request.width, request.height, viewport_px.x, viewport_px.y);
    const Region& part = request.region;
    if (part.width <= 0) return whole;
    const float scale = whole.width / static_cast<float>(request.width);
    return {whole.x + scale * static_cast<float>(part.x), whole.y + scale * static_cast<float>(part.y),
            scale * static_cast<float>(part.width), scale * static_cast<float>(part.height)};
}

PreviewChoice preview_choice(const Session& session) {
    PreviewChoice choice;
    choice.opengl = draws_by_opengl(session);
    choice.whole_sets = !session.gl.software;
    choice.share = session.view.preview_share;
    choice.splats = session.fixed_splats;
    return choice;
}

/// Where A and what it is compared with are shown: `place` holds the frame's part, `whole` all of it.
DisplaySettings display_settings(const Session& session, const OutputParams& output, const Rect& place,
                                 const Rect& whole) {
    DisplaySettings shown;
    shown.view = display_view(session.view.display, output.view);
    if (session.view.display == OutputParams::View::automatic) shown.ocio = session.color.transform();
    shown.exposure = static_cast<float>(output.exposure) + session.view.inspect_exposure;
    shown.a = session.view_frame.texture();
    shown.x = place.x;
    shown.y = place.y;
    shown.width = place.width;
    shown.height = place.height;
    shown.wipe = (whole.x + whole.width * session.view.wipe - place.x) / place.width;
    return shown;
}

/// Of each layer what the final frame is made of; null: it is not seen.
std::vector<std::shared_ptr<const SplatSet>> sets_of(const Session& session, const Scene& now) {
    std::vector<std::shared_ptr<const SplatSet>> sets;
    for (const LayerParams& layer : now.layers) {
        const auto loaded = session.sets.loader().layer(layer.name);
        sets.push_back(loaded && layer.visible ? loaded->set : nullptr);
    }
    return sets;
}

/// Compares the front with its picture while A is at rest; null: nothing is found yet.
std::shared_ptr<const FrontFound> check_front(Session& session, const Scene& now) {
    std::optional<FrontStatus>& status = session.status.front;
    const bool at_rest = session.view_frame.status().state == ViewFrameState::final;
    const bool shown = session.view.compare == CompareMode::front;
    status.reset();
    if (!at_rest) session.front.cancel();
    if (session.front.asked([&](const FrontRequest& asked) { return asked.sets != sets_of(session, now); }))
        session.front.forget();  // it would keep the sets of scenes that are closed
    if (session.viewport_is_frame || !has_front_picture(now) || !(at_rest || shown)) return {};
    status.emplace();
    status->changed_by_look = front_changed_by_look(now);
    if (status->changed_by_look && !shown) return {};
    const FrontRequest request = front_request(now, sets_of(session, now), session.disk.changes());
    if (at_rest) session.front.want(request);
    const std::shared_ptr<const FrontFound> found = session.front.found(request);
    status->working = session.front.working();
    if (!found) return {};
    status->error = found->error;
    if (!found->error.empty()) return {};
    status->measured = true;
    status->psnr_db = found->fidelity.psnr_db;
    status->ssim = found->fidelity.ssim;
    status->light = found->fidelity.flux.frame;
    return found;
}

/// The signed difference in place of all else, as large as the viewport has room for it.
void show_front(Session& session, const std::shared_ptr<const FrontFound>& found, DisplaySettings& shown) {
    if (session.front_shown != found) {
        session.front_texture.upload(found->difference);
        session.front_shown = found;
        ++session.fronts_shown;
    }
    const glm::vec2 port(session.viewport_px);
    const auto width = static_cast<float>(found->difference.width),
               height = static_cast<float>(found->difference.height);
    const float scale = std::min(port.x / width, port.y / height);
    shown.b = session.front_texture.handle();
    shown.b_is_display = true;
    shown.mode = DisplaySettings::Mode::b;
    shown.width = std::round(scale * width);
    shown.height = std::round(scale * height);
    shown.x = std::round(0.5f * (port.x - shown.width));
    shown.y = std::round(0.5f * (port.y - shown.height));
}

void measure_difference(Session& session, const DisplaySettings& shown, double now) {
    if (session.view.compare == CompareMode::difference && shown.b != 0)
        session.difference.measure(session.display, shown, session.viewport_px, now);
    else
        session.difference.clear();
    session.status.difference = session.difference.found();
}

/// What the viewport looks through; none where no camera can be made, as the frame's badge says.
std::optional<Camera> camera_in_viewport(const ViewRequest& request, const Rect& place) {
    try {
        return camera_on_screen(camera_of(request), {place.x, place.y}, double(place.width) / request.width);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace

OutputParams::View display_view(OutputParams::View chosen, OutputParams::View of_scene) {
    const OutputParams::View view = chosen == OutputParams::View::automatic ? of_scene : chosen;
    return view == OutputParams::View::automatic ? OutputParams::View::srgb : view;
}

Scene evaluated(const Scene& scene, const ViewState& view) {
    Scene now = scene_at(scene, view.frame);
    if (!view.solo.empty())
        for (LayerParams& layer : now.layers) layer.visible = view.solo.count(layer.name) > 0;
    return now;
}

bool draws_by_opengl(const Session& session) {
    // Vertex shaders draw no discs of the sphere.
    if (is_onto_sphere(session.request.scene.camera.projection)) return false;
    return session.view.engine == PreviewEngine::opengl ||
           (session.view.engine == PreviewEngine::automatic && !session.gl.software);
}

void draw_viewport(Session& session, glm::ivec2 viewport_px, double now, bool hurry) {
    session.viewport_px = glm::max(viewport_px, glm::ivec2(1));
    const glm::vec2 port_px(session.viewport_px);
    session.status.viewport_aspect = static_cast<double>(port_px.x) / static_cast<double>(port_px.y);
    const Scene scene = evaluated(session.document.scene(), session.view);
    const bool new_sets = session.sets.new_sets();
    session.request = make_request(session, scene);
    keep_free_camera(session.view, session.shown());
    const Rect whole = place_frame(session.view, {0, 0, port_px.x, port_px.y}, session.request.width,
                                   session.request.height);
    session.status.viewport_camera = camera_in_viewport(session.request, whole);
    const bool from_outside = session.view.view != ViewKind::camera && session.view.camera_path;
    session.status.overlay_lines.clear();
    if (from_outside)
        session.status.overlay_lines = session.overlay.lines(session.document.scene(), scene,
                                                             session.status.box, session.request, whole);
    const bool one_to_one = session.view.size == SizeMode::one_to_one;
    const Rect place = one_to_one ? crop_to_viewport(session.request, whole, session.viewport_px) : whole;

    const PreviewChoice choice = preview_choice(session);
    const bool may_settle = session.view.settle && !session.view.playing &&
                            session.sets.loader().sets_there() &&
                            session.sets.wanted(session.document.scene());
    DisplaySettings rendered;
    const bool from_disk = show_rendered_frame(session, whole, rendered);
    const double start = thread_seconds();
    if (!from_disk) session.view_frame.show(session.request, choice, may_settle, now, hurry);
    if (new_sets) session.sets.drew_new_sets(thread_seconds() - start);
    const ViewFrameState reached = session.view_frame.status().state;
    const bool settles = session.view.settle && !session.view.playing;
    session.sets.loader().hold(settles && !from_disk && session.view_frame.final_is_next(now));

    session.color.update(scene.output.ocio, session.view.panels && session.view.tab == PanelTab::output);
    session.status.color = session.color.status();
    DisplaySettings shown = display_settings(session, scene.output, place, whole);
    // A's final frame comes first; B's follows it.
    const bool a_is_done = reached == ViewFrameState::final || reached == ViewFrameState::failed;
    const auto request_for = [&](const Scene& other) {
        ViewRequest wanted = make_request(session, evaluated(other, session.view));
        wanted.region = session.request.region;
        return wanted;
    };
    session.comparison.find_reference(session.document.scene(), session.view, session.status);
    if (session.status.reference) session.status.reference->aligning = session.alignment.working();
    session.comparison.show(session.document.scene(), session.view,
                            {request_for, choice, may_settle && a_is_done, now, frame_on_screen(whole)},
                            shown);
    const std::shared_ptr<const FrontFound> front = check_front(session, scene);
    if (front && session.view.compare == CompareMode::front) show_front(session, front, shown);
    show_preparation(session);
    if (from_disk) {
        rendered.view = shown.view;
        rendered.ocio = shown.ocio;
        rendered.exposure = shown.exposure;
        rendered.a = shown.a;
        shown = rendered;
    }
    shown.content = 1 + session.rendered_uploads + session.view_frame.version() +
                    session.comparison.version() + session.fronts_shown;
    measure_difference(session, shown, now);
    session.displayed = shown;
    session.status.viewport_texture =
        to_handle(session.display.draw(shown, session.viewport_px.x, session.viewport_px.y));
}

}  // namespace astrosplat
