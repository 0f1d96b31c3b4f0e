#include "viewer/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/cgroup.h"
#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "edit/new_from_file.h"
#include "edit/view_camera.h"
#include "output/write_picture.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "viewer/overlay.h"
#include "viewer/programs.h"
#include "viewer/session_impl.h"

namespace astrosplat {
namespace {

/// Splats of a layer that a preview will ever draw.
std::int64_t preview_limit(const GlInfo& gl) { return gl.software ? 1'000'000 : 60'000'000; }

double first_frame(const Scene& scene) {
    return static_cast<double>(parse_frames(scene.output.frames, "output.frames").front());
}

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

Document demo_document(std::span<const Assignment> assignments) {
    const std::filesystem::path file = demo_scene_file();
    if (file.empty())
        throw InputError("the demo scene is not installed; name a scene, picture, mesh or splat file");
    return Document::untitled(read_file(file), file, assignments);
}

Document document_for(const std::filesystem::path& file, std::span<const Assignment> assignments) {
    if (kind_of_file(file) == FileKind::scene) return Document::open(file, assignments);
    const std::filesystem::path place = std::filesystem::absolute(file).replace_extension(".toml");
    return Document::untitled(scene_text_for(file, place), place, assignments);
}

Session::Impl::Impl(const ViewerOptions& options, const GlInfo& gl_info)
    : cache(options.cache),
      gl(gl_info),
      preferences(load_preferences()),
      document(options.input.empty() ? demo_document(options.assignments)
                                     : document_for(options.input, options.assignments)),
      loader(options.cache, preview_limit(gl_info)) {
    fresh_demo = options.input.empty();
    view.hint_open = fresh_demo;
    apply_preferences(view, preferences);
    view.frame = first_frame(document.scene());
    if (!options.input.empty()) look_first(options.input);
    find_recoveries();
    status.has_ffmpeg = find_program("ffmpeg").has_value();
    status.recent = preferences.recent;
}

void Session::Impl::take_document(Document next) {
    document = std::move(next);
    view.frame = first_frame(document.scene());
    view.layer = 0;
    view.view = ViewKind::camera;
    view.solo.clear();
    view.playing = false;
    view.hint_open = fresh_demo = false;
    snapshots.clear();
    b_snapshot = -1;
    autosave.remove();
    if (!document.file().empty()) add_recent(preferences, document.file());
    status.recent = preferences.recent;
}

void Session::Impl::open(const std::filesystem::path& file) {
    take_document(document_for(file));
    look_first(file);
}

/// A picture is first seen from the front, as it was before it had depth.
void Session::Impl::look_first(const std::filesystem::path& file) {
    if (kind_of_file(file) == FileKind::picture) view.view = ViewKind::top;
}

/// Runs the frames of the scene round and round at its speed, dropping frames where drawing is slower.
void Session::Impl::play(double now) {
    if (!view.playing) {
        played_at = -1.0;
        return;
    }
    const std::vector<std::int64_t> frames = parse_frames(document.scene().output.frames, "output.frames");
    const auto first = static_cast<double>(frames.front()), last = static_cast<double>(frames.back());
    if (played_at >= 0.0) {
        const double steps = std::floor((now - played_at) * document.scene().output.fps);
        if (steps < 1.0) return;
        view.frame = std::floor(view.frame) + steps;
        if (view.frame > last) view.frame = first;
        played_at += steps / document.scene().output.fps;
    } else {
        played_at = now;
    }
}

/// A changed source is generated anew once the hand has rested a little.
void Session::Impl::load_sets(double now) {
    constexpr double rest_s = 0.4;
    if (document.revision() == wanted_revision) return;
    std::vector<SourceParams> sources;
    for (const LayerParams& layer : document.scene().layers) sources.push_back(layer.source);
    const bool same_layers = sources.size() == wanted_sources.size();
    if (same_layers && sources != wanted_sources && source_edited_at < 0.0) source_edited_at = now;
    if (source_edited_at >= 0.0 && now - source_edited_at < rest_s) return;
    loader.want(document.scene());
    wanted_revision = document.revision();
    wanted_sources = std::move(sources);
    source_edited_at = -1.0;
}

Scene Session::Impl::evaluated(const Scene& scene) const {
    Scene now = scene_at(scene, view.frame);
    if (!view.solo.empty())
        for (LayerParams& layer : now.layers) layer.visible = view.solo.count(layer.name) > 0;
    return now;
}

PictureRequest Session::Impl::make_request(Scene now) const {
    PictureRequest made;
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

/// Front, top and side make their camera anew from the layers' bounds: the free one follows, so that a key of
/// the camera, or a turn, begins where the person is.
void Session::Impl::keep_free_camera() {
    if (view.view != ViewKind::front && view.view != ViewKind::top && view.view != ViewKind::side) return;
    view.free = viewport_camera();
}

void Session::draw(int viewport_width, int viewport_height, double now, bool hurry) {
    Impl& self = *impl_;
    self.viewport_width = std::max(1, viewport_width);
    self.viewport_height = std::max(1, viewport_height);
    const Scene scene = self.evaluated(self.document.scene());
    self.drawn_sets = self.loader.revision();
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
    self.a.show(self.request, choice, may_settle, now, hurry);
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

Session::Session(const ViewerOptions& options, const GlInfo& gl)
    : impl_(std::make_unique<Impl>(options, gl)) {}
Session::~Session() = default;

Document& Session::document() { return impl_->document; }
ViewState& Session::view() { return impl_->view; }
const Status& Session::status() const { return impl_->status; }

void Session::Impl::look_at_disk(double now) {
    constexpr double every_s = 1.0;
    if (now - checked_disk_at < every_s) return;
    checked_disk_at = now;
    status.changed_on_disk = document.changed_on_disk();
    status.memory_bytes = resident_memory_bytes();
}

void Session::Impl::fill_layers(const Scene& now) {
    const std::vector<std::int64_t>& shown = a.shown();
    status.layers.resize(now.layers.size());
    status.box = {};
    for (std::size_t i = 0; i < now.layers.size(); ++i) {
        status.layers[i] = loader.status(document.scene().layers[i]);
        if (i < shown.size()) status.layers[i].shown = shown[i];
        status.layers[i].kept = i < a.kept().size() ? a.kept()[i] : -1;
        const auto loaded = loader.layer(now.layers[i].name);
        if (loaded && now.layers[i].visible)
            status.box.add(world_bounds(loaded->box, render_layer(now.layers[i])));
    }
}

void Session::Impl::fill_status() {
    fill_layers(evaluated(document.scene()));
    status.picture = comparing && b.status().state == PictureState::refining ? b.status() : a.status();
    status.threads = thread_count();
    status.engine =
        view.engine == PreviewEngine::opengl || (view.engine == PreviewEngine::automatic && !gl.software)
            ? fmt::format("OpenGL {}.{}, {}", gl.major, gl.minor, gl.renderer)
            : "processor";
    status.snapshots.clear();
    for (const StoredPicture& stored : snapshots)
        status.snapshots.push_back({stored.look.name, to_handle(stored.thumbnail.handle()), stored.aspect,
                                    stored.splats, stored.seconds});
    status.b_snapshot = b_snapshot;
    status.b_name = b_snapshot >= 0 ? snapshots[static_cast<std::size_t>(b_snapshot)].look.name : "";
}

void Session::advance(double now) {
    Impl& self = *impl_;
    self.play(now);
    self.load_sets(now);
    self.look_at_disk(now);
    self.poll_job();
    self.autosave.update(self.document);
    self.fill_status();
}

/// The linear pixel under the mouse.
void Session::Impl::probe(glm::dvec2 mouse_px) {
    status.probe.reset();
    if (request.width <= 0 || a.texture() == 0) return;
    const Rect port{0, 0, static_cast<float>(viewport_width), static_cast<float>(viewport_height)};
    const Rect place = place_picture(view, port, request.width, request.height);
    const auto x =
        static_cast<std::int64_t>(std::floor((mouse_px.x - place.x) / place.width * request.width));
    const auto y =
        static_cast<std::int64_t>(std::floor((mouse_px.y - place.y) / place.height * request.height));
    const Image* pixels = a.pixels();
    if (!pixels) return;
    const std::int64_t px = x - request.region.x, py = y - request.region.y;
    if (px < 0 || py < 0 || px >= pixels->width || py >= pixels->height) return;
    PixelProbe found;
    found.x = static_cast<int>(x);
    found.y = static_cast<int>(y);
    std::copy_n(pixels->at(px, py), 4, found.rgba);
    status.probe = found;
}

/// Files dropped on the window: a scene is opened; a mesh and a picture together make one layer; on the
/// untouched demo anything else makes a scene of its own, elsewhere a layer.
void Session::drop(const std::vector<std::filesystem::path>& files) {
    Commands commands;
    for (const std::filesystem::path& file : files) {
        const bool fresh = impl_->fresh_demo && !impl_->document.edited() && commands.empty();
        const FileKind kind = kind_of_file(file);
        const auto what = kind == FileKind::scene ? Command::Kind::open
                          : fresh                 ? Command::Kind::new_from_file
                                                  : Command::Kind::import_file;
        commands.push_back({what, file, {}, 0});
    }
    impl_->dropped.insert(impl_->dropped.end(), commands.begin(), commands.end());
}

Commands Session::take_dropped() { return std::exchange(impl_->dropped, {}); }

double Session::next_due(double now) const {
    const Impl& self = *impl_;
    if (!self.loader.idle() || self.job.state() == RenderJob::State::running) return 0.1;
    if (self.view.playing) return 0.0;
    if (!self.a.exact()) return 0.02;
    const PictureState state = self.a.status().state;
    if (state == PictureState::refining) return 0.03;
    if (self.comparing && self.b.waiting()) return 0.03;
    if (state == PictureState::preview && self.view.settle) return self.a.due(now);
    return 1.0;  // to look at the disk and autosave
}

bool Session::loaded() const {
    return impl_->loader.idle() && impl_->wanted_revision == impl_->document.revision();
}
bool Session::preview_exact() const {
    return impl_->a.exact() && impl_->drawn_sets == impl_->loader.revision();
}
std::uint64_t Session::picture_version() const { return impl_->display.version(); }
bool Session::settled() const { return impl_->a.status().state == PictureState::final; }
void Session::say(const std::string& text, bool error) { impl_->say(text, error); }
bool Session::quitting() const { return impl_->quitting; }
std::string Session::title() const {
    return impl_->document.name() + (impl_->document.edited() ? " - edited" : "") + " - astrosplat";
}
void Session::prepare_screenshot(bool with_panels) {
    constexpr std::int64_t preview_splats = 500'000;
    impl_->viewport_is_picture = !with_panels;
    impl_->fixed_splats = preview_splats;
    impl_->status.recoveries.clear();
}

std::optional<std::filesystem::path> Session::take_screenshot_request() {
    return std::exchange(impl_->screenshot, std::nullopt);
}

void Session::save_screenshot(const std::filesystem::path& file, int width, int height,
                              const std::vector<unsigned char>& rgba) {
    try {
        write_picture(file, width, height, rgba);
        say("Saved " + file.string());
    } catch (const OutputError& error) {
        say(error.what(), true);
    }
}

std::optional<std::string> Session::take_clipboard() { return std::exchange(impl_->clipboard, std::nullopt); }
std::shared_ptr<const RenderedFrame> Session::final_frame() const { return impl_->a.final_frame(); }
std::vector<unsigned char> Session::shown_pixels() const { return impl_->display.read(); }

void Session::interrupt() {
    if (impl_->document.edited()) impl_->autosave.write(impl_->document);
    throw Cancelled();  // an autosave stays behind an exception
}

void Session::close(int window_width, int window_height) {
    Preferences& preferences = impl_->preferences;
    preferences.window_width = window_width;
    preferences.window_height = window_height;
    remember_panels(preferences, impl_->view);
    save_preferences(preferences);
}

}  // namespace astrosplat
