#include "viewer/session.h"

#include <algorithm>
#include <new>
#include <utility>

#include "core/error.h"
#include "core/memory.h"
#include "edit/new_from_file.h"
#include "output/write_picture.h"
#include "viewer/session_commands.h"
#include "viewer/session_picture.h"
#include "viewer/session_state.h"
#include "viewer/session_status.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

/// Does it, or says in the message line why not: nothing that a person asks for ends the window.
template <class Act>
void attempt(Status& status, const Act& act) {
    try {
        act();
    } catch (const Cancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        say(status, "not enough memory for that", true);
    } catch (const std::exception& error) {
        say(status, error.what(), true);
    }
}

/// Textures, meshes, maps, skies, a reference: what was changed shows without being asked for.
void read_again(SessionState& state, const std::vector<fs::path>& files) {
    outdate_layers_of(files, state.document.scene(), state.sets.loader());
    forget(*state.files, files);
    say(state.status, files.size() == 1 ? "Read again: " + files[0].filename().string()
                                        : "Read again: " + std::to_string(files.size()) + " files");
    const fs::path reference = state.comparison.reference_file();
    if (std::find(files.begin(), files.end(), reference) == files.end()) return;
    state.comparison.forget_reference();
    attempt(state.status, [&] { state.comparison.load_reference(reference); });
}

void watch_files(SessionState& state) {
    state.disk.watch(state.document.scene(), state.sets.loader(), state.comparison.reference_file());
}

void look_at_disk(SessionState& state, double now) {
    if (!state.disk.due(now)) return;
    state.status.changed_on_disk = state.document.changed_on_disk();
    state.status.memory_bytes = resident_memory_bytes();
    watch_files(state);
    const std::vector<fs::path> changed = state.disk.changed();
    if (!changed.empty()) read_again(state, changed);
}

void want_sets(SessionState& state, double now) {
    if (!state.sets.due(state.document, now)) return;
    watch_files(state);  // before they are read, so that no change after that is missed
    state.sets.want(state.document);
}

Command::Kind command_for(FileKind kind, bool fresh) {
    if (kind == FileKind::scene) return Command::Kind::open;
    if (kind == FileKind::look) return Command::Kind::apply_look;
    return fresh ? Command::Kind::new_from_file : Command::Kind::import_file;
}

}  // namespace

Session::Session(const ViewerOptions& options, const GlInfo& gl)
    : state_(std::make_unique<SessionState>(options, gl)) {}
Session::~Session() = default;

Document& Session::document() { return state_->document; }
ViewState& Session::view() { return state_->view; }
const Status& Session::status() const { return state_->status; }

void Session::advance(double now) {
    SessionState& state = *state_;
    const bool for_screenshot = state.fixed_splats > 0;
    state.playback.advance(state.view, state.document.scene().output, now);
    want_sets(state, now);
    if (!for_screenshot) state.sets.show_growth(now);
    look_at_disk(state, now);
    if (const auto news = state.jobs.poll(state.status.job)) say(news->text, news->error);
    state.autosave.update(state.document);
    fill_status(state);
}

void Session::navigate(const ViewportInput& input, double now) {
    SessionState& state = *state_;
    if (state.request.width <= 0) return;
    probe(state, input.hovered ? input.mouse_px : glm::dvec2(-1.0));
    if (state.view.size == SizeMode::one_to_one) return;  // the widgets move and zoom the picture
    attempt(state.status, [&] {
        if (state.navigator.navigate(input, state.shown(), now, state.document, state.view))
            say(left_camera_message);
    });
}

void Session::carry_out(Commands& commands) {
    for (const Command& command : commands)
        attempt(state_->status, [&] { astrosplat::carry_out(*state_, command); });
    commands.clear();
}

/// Files dropped on the window: a scene is opened; a look is given to the chosen layer; a mesh and a picture
/// together make one layer; on the untouched demo anything else makes a scene of its own, elsewhere a layer.
void Session::drop(const std::vector<fs::path>& files) {
    Commands commands;
    for (const fs::path& file : files) {
        const bool fresh = state_->fresh_demo && !state_->document.edited() && commands.empty();
        commands.push_back({command_for(kind_of_file(file), fresh), file, {}, 0});
    }
    state_->dropped.insert(state_->dropped.end(), commands.begin(), commands.end());
}

Commands Session::take_dropped() { return std::exchange(state_->dropped, {}); }

void Session::draw(int viewport_width, int viewport_height, double now, bool hurry) {
    draw_viewport(*state_, {viewport_width, viewport_height}, now, hurry);
}

double Session::next_due(double now) const {
    const SessionState& state = *state_;
    if (!state.sets.loader().idle() || state.jobs.running()) return 0.1;
    if (state.view.playing) return 0.0;
    if (!state.picture.exact()) return 0.02;
    const PictureState reached = state.picture.status().state;
    if (reached == PictureState::refining || state.comparison.waiting()) return 0.03;
    if (reached == PictureState::preview && state.view.settle) return state.picture.due(now);
    return 1.0;  // to look at the disk and autosave
}

bool Session::loaded() const { return state_->sets.loaded(state_->document); }
bool Session::preview_exact() const { return state_->picture.exact() && state_->sets.same_sets(); }
std::uint64_t Session::picture_version() const { return state_->display.version(); }
bool Session::settled() const { return state_->picture.status().state == PictureState::final; }
void Session::say(const std::string& text, bool error) { astrosplat::say(state_->status, text, error); }
bool Session::quitting() const { return state_->quitting; }
std::string Session::title() const {
    return state_->document.name() + (state_->document.edited() ? " - edited" : "") + " - astrosplat";
}

void Session::prepare_screenshot(bool with_panels) {
    constexpr std::int64_t preview_splats = 500'000;
    state_->viewport_is_picture = !with_panels;
    state_->fixed_splats = preview_splats;
    state_->status.recoveries.clear();
}

std::optional<fs::path> Session::take_screenshot_request() {
    return std::exchange(state_->screenshot, std::nullopt);
}

void Session::save_screenshot(const fs::path& file, int width, int height,
                              const std::vector<unsigned char>& rgba) {
    attempt(state_->status, [&] {
        write_picture(file, width, height, rgba);
        say("Saved " + file.string());
    });
}

std::optional<std::string> Session::take_clipboard() {
    return std::exchange(state_->clipboard, std::nullopt);
}
std::shared_ptr<const RenderedFrame> Session::final_frame() const { return state_->picture.final_frame(); }
Image Session::shown_light() const { return state_->picture.read(); }
std::vector<unsigned char> Session::shown_pixels() const { return state_->display.read(); }

void Session::interrupt() {
    if (state_->document.edited()) state_->autosave.write(state_->document);
    throw Cancelled();  // an autosave stays behind an exception
}

void Session::close(int window_width, int window_height) {
    Preferences& preferences = state_->preferences;
    preferences.window_width = window_width;
    preferences.window_height = window_height;
    remember_panels(preferences, state_->view);
    save_preferences(preferences);
}

}  // namespace astrosplat
