#include "viewer/session.h"

#include <fmt/format.h>

#include <time.h>

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

}  // namespace

double thread_seconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

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
    watch_files();  // before they are read, so that no change after that is missed
    loader.want(document.scene());
    wanted_revision = document.revision();
    wanted_sources = std::move(sources);
    source_edited_at = -1.0;
}

/// What there is of a set that is being generated, as often as takes it no more than a few percent of its
/// time.
void Session::Impl::show_growth(double now) {
    constexpr double shortest_s = 0.25, longest_s = 1.5, share = 0.03;  // the first drawing is a slow one
    const bool for_screenshot = fixed_splats > 0;
    if (for_screenshot || now < grows_at) return;
    const double start = thread_seconds();
    if (!loader.grow()) return;
    grows_at = now + std::clamp((thread_seconds() - start + new_set_draw_s) / share, shortest_s, longest_s);
}

Session::Session(const ViewerOptions& options, const GlInfo& gl)
    : impl_(std::make_unique<Impl>(options, gl)) {}
Session::~Session() = default;

Document& Session::document() { return impl_->document; }
ViewState& Session::view() { return impl_->view; }
const Status& Session::status() const { return impl_->status; }

void Session::advance(double now) {
    Impl& self = *impl_;
    self.play(now);
    self.load_sets(now);
    self.show_growth(now);
    self.look_at_disk(now);
    self.poll_job();
    self.autosave.update(self.document);
    self.fill_status();
}

/// Files dropped on the window: a scene is opened; a look is given to the chosen layer; a mesh and a picture
/// together make one layer; on the untouched demo anything else makes a scene of its own, elsewhere a layer.
void Session::drop(const std::vector<std::filesystem::path>& files) {
    Commands commands;
    for (const std::filesystem::path& file : files) {
        const bool fresh = impl_->fresh_demo && !impl_->document.edited() && commands.empty();
        const FileKind kind = kind_of_file(file);
        const auto what = kind == FileKind::scene  ? Command::Kind::open
                          : kind == FileKind::look ? Command::Kind::apply_look
                          : fresh                  ? Command::Kind::new_from_file
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
Image Session::shown_light() const { return impl_->a.read(); }
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
