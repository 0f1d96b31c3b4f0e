// The viewport: the view becomes a request for a frame; the frame and its comparison are placed in the
// viewport, with lines of the camera over them; and the widgets get the state of both.
#include <fmt/format.h>

#include <glm/gtc/type_precision.hpp>

#include "camera/projection.h"
#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/text.h"
#include "edit/placement.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "viewer/preview_splats.h"
#include "viewer/session.h"

namespace astrosplat {
namespace {

/// Any scene as it stands at the view's frame, with solo.
Scene evaluated(const Scene& scene, const ViewState& view) {
    Scene now = scene_at(scene, view.frame);
    if (!view.solo.empty())
        for (LayerParams& layer : now.layers) layer.visible = view.solo.count(layer.name) > 0;
    return now;
}

/// Whether a preview by the card is asked for, whatever draws for it.
bool asks_for_card(const Session& session) {
    return session.view.engine == PreviewEngine::card || (session.view.engine == PreviewEngine::automatic &&
                                                          session.card_choice.device == DeviceChoice::gpu);
}

/// The card that draws previews; null: the processor does. Unless it is asked for, one that has drawn a final
/// frame: its probe and the compiling of its programs then hold up nobody.
RenderDevice* preview_card(Session& session) {
    if (session.card_choice.device == DeviceChoice::cpu || session.view.engine == PreviewEngine::processor)
        return nullptr;
    const GlInfo& gl = session.gl;
    const std::string& drew = session.view_frame.status().device;
    const bool asked = asks_for_card(session), known = !gl.software && !drew.empty() && drew == gl.renderer;
    if ((asked || known) && !std::exchange(session.card_asked, true)) try {
            session.card = exact_card(gl, known_probe(gl, session.card_choice.kept));
        } catch (const std::runtime_error& error) {
            log_detail(std::string("previews are drawn by the processor: ") + error.what());
        }
    return asked || !gl.software ? session.card.get() : nullptr;
}

/// Whether the frame sees what is animated move: through the scene's camera, with an open shutter. Layers
/// shown alone would come and go with their tracks.
bool sees_motion(const Scene& scene, const ViewState& view) {
    return scene.camera.shutter > 0.0 && view.solo.empty() && view.view == ViewKind::camera;
}

/// Values that a frame does not depend on go back to their defaults: editing them makes no new frame.
void forget_what_is_not_seen(Scene& scene) {
    const OutputParams standard;
    scene.file.clear();
    scene.provenance = {};
    scene.references.clear();
    for (LayerParams& layer : scene.layers) {  // the sets have what these say
        layer.source.texture = {};
        layer.source.structure = {};
    }
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

/// `now`: the scene as it stands at the frame of `view`, which may differ from the session's in that alone.
ViewRequest make_request(const Session& session, Scene now, const ViewState& view) {
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
    if (sees_motion(now, view))
        made.frame = view.frame;
    else
        stop_animation(now);
    now.camera = view_camera(now, view, made.box, aspect);
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

bool settles(const Session& session) {
    return session.view.playing ? session.view.play_final : session.view.settle;
}

PreviewChoice preview_choice(Session& session) {
    PreviewChoice choice;
    choice.device = preview_card(session);
    choice.share = session.view.preview_share;
    choice.splats = session.fixed_splats;
    choice.steps = settles(session);
    choice.arriving = choice.steps && !session.sets.following() && !session.sets.loader().sets_there();
    return choice;
}

/// Where A and what it is compared with are shown: `place` holds the frame's part, `whole` all of it.
DisplaySettings display_settings(const Session& session, const OutputParams& output, const Rect& place,
                                 const Rect& whole) {
    DisplaySettings shown;
    shown.view = display_view(session.view.display, output.view);
    if (session.view.display == OutputParams::View::automatic) shown.ocio = session.color.transform();
    shown.exposure = static_cast<float>(output.exposure);
    shown.inspection = session.view.inspection;
    shown.a = session.view_frame.texture();
    shown.x = place.x;
    shown.y = place.y;
    shown.width = place.width;
    shown.height = place.height;
    shown.wipe = (whole.x + whole.width * session.view.wipe - place.x) / place.width;
    return shown;
}

void measure_difference(Session& session, const DisplaySettings& shown, double now) {
    if (session.view.compare == CompareMode::difference && shown.b != 0)
        session.difference.measure(session.display, shown, session.viewport_px, now);
    else
        session.difference.clear();
    session.status.difference = session.difference.found();
}

/// The camera of the viewport; none where no camera can be made, as the frame's badge says.
std::optional<Camera> camera_in_viewport(const ViewRequest& request, const Rect& place) {
    try {
        return camera_on_screen(camera_of(request), {place.x, place.y}, double(place.width) / request.width);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// How this frame of the window is drawn.
struct Drawing {
    double now = 0.0;         // s
    bool hurry = false;       // the final frame at once
    bool may_settle = false;  // to the final frame
    PreviewChoice choice;
};

/// Asks for the frame as the view sees it, with the lines beside it; returns where all of it lies in the
/// viewport.
Rect place_of_frame(Session& session, const Scene& now) {
    session.status.viewport_aspect =
        static_cast<double>(session.viewport_px.x) / static_cast<double>(session.viewport_px.y);
    session.request = make_request(session, now, session.view);
    keep_free_camera(session.view, session.shown());
    const Rect whole = frame_in_viewport(session);
    session.status.viewport_camera = camera_in_viewport(session.request, whole);
    session.status.overlay_lines.clear();
    if (session.view.view != ViewKind::camera && session.view.camera_path)
        session.status.overlay_lines =
            session.overlay.lines(session.document.scene(), now, session.status.box, session.request, whole);
    return whole;
}

/// True: a frame from disk is seen in its place, as `rendered` shows it within `whole`.
bool draw_a(Session& session, const Rect& whole, const Drawing& how, DisplaySettings& rendered) {
    const bool from_disk = show_movie(session, rendered) || show_rendered_frame(session, whole, rendered);
    if (!from_disk) session.view_frame.show(session.request, how.choice, how.may_settle, how.now, how.hurry);
    const bool comes = settles(session) && !from_disk && session.view_frame.final_comes();
    const bool is_next = comes && session.view_frame.final_is_next(how.now);
    session.sets.loader().hold_after(is_next ? SetTask::load : comes ? SetTask::arrange : SetTask::describe);
    return from_disk;
}

/// Puts B or the reference beside A. A's final frame comes first; B's follows it.
void compare_a(Session& session, const Rect& whole, const Drawing& how, DisplaySettings& shown) {
    const ViewFrameState reached = session.view_frame.status().state;
    const bool a_is_done = reached == ViewFrameState::final || reached == ViewFrameState::failed;
    const auto request_for = [&](const Scene& other) {
        ViewRequest wanted = make_request(session, evaluated(other, session.view), session.view);
        wanted.region = session.request.region;
        return wanted;
    };
    session.comparison.find_reference(session.document.scene(), session.view, session.status);
    if (session.status.reference) session.status.reference->aligning = session.alignment.working();
    session.comparison.show(session.document.scene(), session.view,
                            {session.snapshots.b(), request_for, how.choice, how.may_settle && a_is_done,
                             how.now, frame_on_screen(whole)},
                            shown);
}

FramesContext frames_context(const Session& session) {
    const ViewRequest& request = session.request;
    const ViewState& view = session.view;
    FramesContext now{session.document.revision(),     request.files,  view.view, {}, view.solo,
                      {request.width, request.height}, request.region, {}};
    for (const auto& layer : request.layers) now.sets.push_back(layer ? layer->set.get() : nullptr);
    if (view.view != ViewKind::camera) now.free = view.free;
    return now;
}

/// Fills Status::final_frames while the frame at hand is final: this one, and where something else came to be
/// seen all of them, a few every time.
void note_final_frames(Session& session) {
    constexpr int at_a_time = 8;     // of a scene's frames, some 0.2 ms each
    constexpr double most = 10'000;  // frames looked for
    FinalFrames& kept = *session.final_frames;
    std::vector<double>& frames = session.status.final_frames;
    session.status.final_frames_bytes = kept.bytes();
    session.status.final_frames_full = kept.full();
    FramesContext context = frames_context(session);
    const bool same = session.frames_context == context && session.final_frames_dropped == kept.drops();
    if (!same) {
        frames.clear();
        session.frames_context.reset();
        session.frame_looked_for.reset();
    }
    if (session.view_frame.status().state != ViewFrameState::final) return;
    const FrameRange range = frame_range(session.document.scene().output);
    if (!same) {
        kept.begin_round();
        if (kept.count() > 1) session.frame_looked_for = range.first;  // else it is this one
    }
    const auto look_for = [&](double frame) {
        const auto at = std::ranges::lower_bound(frames, frame);
        if (at != frames.end() && *at == frame) return;
        ViewState view = session.view;
        view.frame = frame;
        ViewRequest wanted = make_request(session, evaluated(session.document.scene(), view), view);
        wanted.region = session.request.region;
        if (kept.find(wanted)) frames.insert(at, frame);
    };
    std::optional<double>& next = session.frame_looked_for;
    for (int i = 0; i < at_a_time && next; ++i) {
        look_for(*next);
        if (++*next > std::min(range.last, range.first + most)) next.reset();
    }
    look_for(session.view.frame);
    session.frames_context = std::move(context);
    session.final_frames_dropped = kept.drops();
}

void fill_layers(Session& session, const Scene& now) {
    const std::vector<std::int64_t>&shown = session.view_frame.shown(), &kept = session.view_frame.kept();
    Status& status = session.status;
    const SetLoader& loader = session.sets.loader();
    status.layers.resize(now.layers.size());
    status.box = {};
    for (std::size_t i = 0; i < now.layers.size(); ++i) {
        status.layers[i] = loader.status(session.document.scene().layers[i]);
        if (i < shown.size()) status.layers[i].shown = shown[i];
        status.layers[i].kept = i < kept.size() ? kept[i] : -1;
        const auto loaded = loader.layer(now.layers[i].name);
        if (!loaded) continue;
        status.layers[i].box = loaded->box;
        if (now.layers[i].visible)
            status.box.add(world_bounds(loaded->box, render_layer(now, now.layers[i])));
    }
}

/// The pixel of the whole frame at a place of the viewport, px; outside of the frame where that is.
glm::i64vec2 frame_pixel(const Session& session, glm::dvec2 mouse_px) {
    const Rect place = frame_in_viewport(session);
    const auto pixel = [](double px, float begin, float size, int count) {
        return static_cast<std::int64_t>(std::floor((px - begin) / size * count));
    };
    return {pixel(mouse_px.x, place.x, place.width, session.request.width),
            pixel(mouse_px.y, place.y, place.height, session.request.height)};
}

}  // namespace

OutputParams::View display_view(OutputParams::View chosen, OutputParams::View of_scene) {
    const OutputParams::View view = chosen == OutputParams::View::automatic ? of_scene : chosen;
    return view == OutputParams::View::automatic ? OutputParams::View::srgb : view;
}

Rect frame_in_viewport(const Session& session) {
    const glm::vec2 port(session.viewport_px);
    return place_frame(session.view, {0, 0, port.x, port.y}, session.request.width, session.request.height);
}

void draw_viewport(Session& session, glm::ivec2 viewport_px, double now, bool hurry) {
    session.viewport_px = glm::max(viewport_px, glm::ivec2(1));
    const Scene scene = evaluated(session.document.scene(), session.view);
    session.sets.see_sets();
    const bool waits = session.view.playing && session.view.play_final;  // for the final frame
    Drawing how{now, hurry || waits, false, {}};
    const Rect whole = place_of_frame(session, scene);
    const bool one_to_one = session.view.size == SizeMode::one_to_one;
    const Rect place = one_to_one ? crop_to_viewport(session.request, whole, session.viewport_px) : whole;
    how.choice = preview_choice(session);
    how.may_settle = settles(session) && session.sets.loader().sets_there() &&
                     session.sets.wanted(session.document.scene());
    DisplaySettings rendered;
    const bool from_disk = draw_a(session, whole, how, rendered);

    session.color.update(scene.output.ocio, session.view.panels && session.view.tab == PanelTab::output);
    session.status.color = session.color.status();
    DisplaySettings shown = display_settings(session, scene.output, place, whole);
    compare_a(session, whole, how, shown);
    show_front(session, scene, shown);
    show_preparation(session);
    if (from_disk) {
        rendered.view = shown.view;
        rendered.ocio = shown.ocio;
        rendered.exposure = shown.exposure;
        rendered.inspection = shown.inspection;
        rendered.a = shown.a;
        shown = rendered;
    }
    shown.content = 1 + session.rendered_image.version() + session.movie.image().version() +
                    session.view_frame.version() + session.comparison.version() +
                    session.front_difference.version();
    measure_difference(session, shown, now);
    note_final_frames(session);
    session.displayed = shown;
    session.status.viewport_texture =
        to_handle(session.display.draw(shown, session.viewport_px.x, session.viewport_px.y));
    show_scopes(session);
}

void fill_status(Session& session) {
    fill_layers(session, evaluated(session.document.scene(), session.view));
    const ViewFrameStatus* refining = session.comparison.refining();
    session.status.view_frame = refining ? *refining : session.view_frame.status();
    session.status.threads = thread_count();
    const RenderDevice* const card = preview_card(session);
    session.status.engine = card ? card->name() : "processor";
    session.snapshots.fill(session.status);
    session.status.blink_shows_other =
        session.view.compare == CompareMode::blink && session.comparison.blink_shows_other();
    say_new_errors(session.status);
}

void probe(Session& session, glm::dvec2 mouse_px) {
    const ViewRequest& request = session.request;
    session.status.probe.reset();
    if (request.width <= 0 || session.view_frame.texture() == 0) return;
    if (!session.status.rendered_frame.empty() || !session.status.played_movie.empty())
        return;  // another frame is seen
    const glm::i64vec2 at = frame_pixel(session, mouse_px);
    const Image* pixels = session.view_frame.pixels();
    if (!pixels) return;
    const std::shared_ptr<const RenderedFrame> final = session.view_frame.final_frame();
    session.status.probe = probe_of(*pixels, final ? &final->depth : nullptr, request.region, at.x, at.y);
}

std::optional<PixelProbe> probe_of(const Image& pixels, const Image* depth, const Region& region,
                                   std::int64_t x, std::int64_t y) {
    const std::int64_t px = x - region.x, py = y - region.y;
    if (px < 0 || py < 0 || px >= pixels.width || py >= pixels.height) return std::nullopt;
    PixelProbe found;
    found.x = static_cast<int>(x);
    found.y = static_cast<int>(y);
    std::copy_n(pixels.at(px, py), 4, found.rgba);
    const bool has_depth = depth && depth->width == pixels.width && depth->height == pixels.height;
    if (has_depth && *depth->at(px, py) != 0.0f) found.depth = *depth->at(px, py);
    return found;
}

void select_layer_at(Session& session, glm::dvec2 mouse_px, bool behind) {
    const CompareMode compare = session.view.compare;
    if (compare == CompareMode::front || compare == CompareMode::other) return;  // no layers of A are seen
    const glm::i64vec2 at = frame_pixel(session, mouse_px);
    const std::vector<std::size_t> seen = seen_layers(session.view_frame.layer_light(at.x, at.y));
    const std::optional<std::size_t> clicked = clicked_layer(seen, session.view.layer, behind);
    const std::vector<LayerParams>& layers = session.document.scene().layers;
    session.view.selected_box = clicked.has_value();
    if (!clicked || *clicked >= layers.size()) return;
    session.view.layer = *clicked;
    session.view.handle_target = HandleTarget::layer;
    std::string text = layers[*clicked].name + " is selected";
    if (seen.size() > 1) {
        const auto place = std::ranges::find(seen, *clicked) - seen.begin() + 1;
        text += fmt::format(", {} of {} layers here; another click takes the next", place, seen.size());
    }
    say(session.status, text);
}

void pick_focus_at(Session& session, glm::dvec2 mouse_px) {
    const CompareMode compare = session.view.compare;
    const bool other = compare == CompareMode::front || compare == CompareMode::other ||
                       !session.status.rendered_frame.empty();
    const glm::i64vec2 at = frame_pixel(session, mouse_px);
    const std::optional<double> depth = other ? std::nullopt : session.view_frame.depth(at.x, at.y);
    const std::optional<Camera>& seen = session.status.viewport_camera;
    if (!depth || !seen) return say(session.status, "Nothing is seen there that could be in focus");
    const glm::dvec3 point =
        seen->eye + seen->world_from_camera *
                        exact::point_at_depth(make_exact_lens(*seen), mouse_px.x, mouse_px.y, *depth);
    const Scene now = scene_at(session.document.scene(), session.view.frame);
    const Camera camera =
        make_camera(now.camera, double(now.output.width), double(now.output.height), session.status.box);
    const double distance = view_depth(camera, point);
    if (distance <= camera.near) return say(session.status, "That lies behind the camera");
    const std::string text = fmt::format("{:.4g}", distance);
    session.document.set("camera.focus_distance", *parse_double(text), session.view.frame);
    session.view.picking_focus = false;
    say(session.status, "In focus at " + text + " scene units");
}

}  // namespace astrosplat
