#include "viewer/session.h"

#include <new>
#include <thread>

#include "camera_files/camera_track.h"
#include "core/error.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/text.h"
#include "edit/edits.h"
#include "edit/layers.h"
#include "edit/picture_start.h"
#include "scene/camera_file.h"
#include "scene/source_metadata.h"
#include "source/picture.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

/// Splats of a layer that previews know until its tree is there.
constexpr std::int64_t sample_limit = 1 << 18;

fs::path place_beside(const fs::path& file) { return fs::absolute(file).replace_extension(".toml"); }

/// A scene, or what any other file becomes, untitled: a picture an empty one until its own is made. Throws
/// InputError.
Document document_for(const fs::path& file, std::span<const Assignment> assignments = {}) {
    if (kind_of_file(file) == FileKind::scene) return Document::open(file, assignments);
    require_readable(file);
    const fs::path place = place_beside(file);
    if (is_picture(file)) return Document::untitled(empty_scene_text(), place);
    return Document::untitled(scene_text_for(file, place), place, assignments);
}

void want_start(Session& session, StartRequest request) {
    require_picture(request.start.picture);
    session.after_start.clear();
    request.place = place_beside(request.start.picture);
    request.revision = session.document.revision();
    session.starts.want(std::move(request));
}

/// A picture is first seen from the front, as it was before it had depth: by its own camera, if any.
void choose_first_view(ViewState& view, const Document& document, const fs::path& file) {
    if (kind_of_file(file) == FileKind::picture && !document.scene().camera.position)
        view.view = ViewKind::top;
}

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
void read_again(Session& session, const std::vector<fs::path>& files) {
    outdate_layers_of(files, session.document.scene(), session.sets.loader());
    session.files->forget(files);
    say(session.status, files.size() == 1 ? "Read again: " + files[0].filename().string()
                                          : "Read again: " + std::to_string(files.size()) + " files");
    ReferencePicture& reference = session.comparison.reference();
    if (std::find(files.begin(), files.end(), reference.file()) != files.end()) reference.forget();
}

void watch_files(Session& session) {
    session.disk.watch(
        files_in_use(session.document.scene(), session.sets.loader(), session.comparison.reference().file()));
}

/// The system counts page by page, which takes it some 10 ms of a large set.
void count_memory(Session& session, double now) {
    constexpr double every_s = 5.0;
    if (now - session.memory_counted_at < every_s) return;
    session.memory_counted_at = now;
    session.status.memory_bytes = resident_memory_bytes();
}

void check_disk(Session& session, double now) {
    if (!session.disk.due(now)) return;
    session.status.changed_on_disk = session.document.changed_on_disk();
    watch_files(session);
    const std::vector<fs::path> changed = session.disk.changed();
    if (!changed.empty()) read_again(session, changed);
}

void want_sets(Session& session, double now) {
    if (!session.sets.due(session.document, now)) return;
    watch_files(session);  // before they are read, so that no change after that is missed
    session.sets.want(session.document);
}

/// Once for each: a camera made for other frames than the scene's stands still.
void say_missed_frames(Session& session) {
    const Scene& scene = session.document.scene();
    if (!scene.imported.camera && session.missed_frames.empty()) return;
    const FrameRange range = frame_range(scene.output);
    std::string missed =
        missed_camera_frames(scene, std::array{std::int64_t(range.first), std::int64_t(range.last)});
    if (missed != session.missed_frames && !missed.empty()) say(session.status, missed, true);
    session.missed_frames = std::move(missed);
}

void open_snapshots(Session& session) {
    std::vector<std::string> problems;
    session.snapshots.open(session.document.file(), problems);
    for (const std::string& problem : problems) say(session.status, problem, true);
    const auto count = static_cast<std::int64_t>(session.snapshots.size());
    if (count > 0 && problems.empty() && !session.view.snapshots_open)
        say(session.status, counted(count, "snapshot") + " of this scene: View > Snapshots shows them");
}

/// Of the scene that was opened: its snapshots, and what a farm was given of it, where there is a farm to
/// ask.
void show_what_was_made(Session& session) {
    open_snapshots(session);
    if (session.status.has_slurm) session.jobs.list_earlier(session.document);
}

Command::Kind command_for(FileKind kind, bool fresh) {
    if (kind == FileKind::scene) return Command::Kind::open;
    if (kind == FileKind::look) return Command::Kind::apply_look;
    return fresh ? Command::Kind::open : Command::Kind::import_file;
}

/// Seconds between frames of the window while others work: a window that is drawn without a graphics card
/// takes a fifth of their processor at most.
double paced(const Session& session, double least) {
    return std::clamp(4.0 * session.frame_took_s, least, 0.25);
}

/// Until what is seen, or is worked out of it, may change by itself; idle_due_s: it will not.
double due_of_view(const Session& session, double now) {
    if (!session.status.rendered_frame.empty()) return session.rendered.working() ? 0.03 : 1.0;
    if (session.sets.following()) return 0.01;
    if (!session.sets.wanted(session.document.scene())) return 0.1;
    if (!session.view_frame.exact()) return 0.02;
    const ViewFrameState reached = session.view_frame.status().state;
    if (reached == ViewFrameState::refining || session.comparison.waiting()) return paced(session, 0.03);
    if (reached == ViewFrameState::preview && session.view.settle) return session.view_frame.due(now);
    if (session.frame_looked_for) return 0.02;
    if (session.difference.waiting() || session.comparison.reference().working() ||
        session.alignment.working())
        return 0.1;
    if (session.view.compare == CompareMode::blink)
        return (std::floor(now * session.view.blink_hz) + 1.0) / session.view.blink_hz - now;
    if (session.front.working() || session.preparation.working() || session.finished.working()) return 0.1;
    return idle_due_s;  // to look at the disk and autosave
}

}  // namespace

Session::Session(const ViewerOptions& options, const GlInfo& gl_info)
    : gl(gl_info),
      card_choice{options.device, options.cache.folder},
      preferences(load_preferences()),
      document(options.input.empty() ? demo_document(options.assignments)
                                     : document_for(options.input, options.assignments)),
      cache(options.cache),
      sets(options.cache, sample_limit),
      view_frame(files, card_choice, final_frames),
      comparison(files, card_choice, final_frames),
      front(front_check(1280, options.cache)),
      jobs(options.cache, options.program, options.limits),
      starts(options.cache),
      fresh_demo(options.input.empty()) {
    view.hint_open = fresh_demo;
    static_cast<PanelSizes&>(view) = preferences;
    view.settle = view.settings.settles != 0;
    view.engine = static_cast<PreviewEngine>(view.settings.engine);
    view.frame = frame_range(document.scene().output).first;
    if (!options.input.empty() && kind_of_file(options.input) == FileKind::mesh) offer_picture(*this, 0);
    find_recoveries(status);
    status.has_ffmpeg = has_program("ffmpeg");
    status.has_slurm = has_program("sbatch");
    status.recent = preferences.recent;
    if (!options.input.empty()) note_recent(*this, options.input);
    show_what_was_made(*this);
    opens_input = !options.input.empty() && is_picture(options.input);
    if (opens_input) want_start(*this, {PictureStart{options.input}, {}, {}, options.assignments});
}

void say(Status& status, const std::string& text, bool error) {
    constexpr std::size_t most = 500;  // lines of the log
    status.message = {text, error, status.message.number + 1};
    status.log.push_back(status.message);
    if (status.log.size() > most) status.log.erase(status.log.begin());
}

void say_new_errors(Status& status) {
    std::set<std::string> errors;
    if (status.view_frame.state == ViewFrameState::failed) errors.insert(status.view_frame.error);
    for (const LayerStatus& layer : status.layers) errors.insert(layer.error);
    if (status.reference) errors.insert(status.reference->error);
    if (status.color) errors.insert(status.color->error);
    errors.erase("");
    for (const std::string& error : errors)
        if (!status.standing_errors.count(error)) say(status, error, true);
    status.standing_errors = std::move(errors);
}

void forget_old_message(Status& status, MessageAge& age, double now) {
    constexpr double seen_s = 12.0;
    Message& message = status.message;
    if (message.number != age.number)
        age = {message.number, now};
    else if (!message.error && now - age.since >= seen_s)
        message.text.clear();
}

namespace {

/// Of a document that shows something else than before.
void see_from_beginning(Session& session) {
    ViewState& view = session.view;
    view.frame = frame_range(session.document.scene().output).first;
    view.layer = 0;
    view.view = ViewKind::camera;
    view.solo.clear();
    view.playing = false;
    view.movie.clear();
    view.play_first.reset();
    view.play_last.reset();
}

}  // namespace

void take_document(Session& session, Document next) {
    session.starts.cancel();
    session.opens_input = false;
    session.document = std::move(next);
    ++session.status.scenes;
    ViewState& view = session.view;
    std::erase_if(view.renders, [](const KeptRender& kept) { return kept.scene.empty(); });
    see_from_beginning(session);
    view.hint_open = session.fresh_demo = false;
    view.grey_layer.clear();
    view.start.reset();
    show_what_was_made(session);
    session.autosave.remove();
}

void note_recent(Session& session, const fs::path& file) {
    add_recent(session.preferences, file);
    session.status.recent = session.preferences.recent;
}

void open_file(Session& session, const fs::path& file) {
    require_readable(file);
    if (is_picture(file)) return want_start(session, {PictureStart{file}, {}, {}});
    take_document(session, document_for(file));
    note_recent(session, file);
    if (kind_of_file(file) == FileKind::mesh) offer_picture(session, 0);
}

void start_again(Session& session, const std::string& choice) {
    if (session.view.start)
        want_start(session, {chosen_start(*session.view.start, choice), choice, {}, session.assignments});
}

void take_start(Session& session) {
    const StartRequest* const wanted = session.starts.wanted();
    session.status.starting.reset();
    if (!wanted) {
        if (!session.view.start || !session.document.began()) return;
        // Undo may have brought another one back.
        const PictureStart* const began = session.starts.of(session.document);
        session.view.start = began ? std::optional(*began) : std::nullopt;
        return;
    }
    session.status.starting = {wanted->start.picture, wanted->choice, *wanted->done};
    const StartRequest request = *wanted;
    const std::shared_ptr<const StartMade> made = session.starts.take();
    if (!made) return;
    session.status.starting.reset();
    const bool is_input = std::exchange(session.opens_input, false);
    if (!made->error.empty()) throw InputError(made->error);
    const std::string name = request.start.picture.filename().string();
    const bool again = !request.choice.empty();
    if ((again || session.document.edited()) && session.document.revision() != request.revision) {
        const std::string what =
            again ? choice_in_words(request.choice) + ": not made" : name + " was not opened";
        return say(session.status, what + ", for the scene here was edited meanwhile", true);
    }
    if (again) {
        session.document.begin_again(choice_in_words(request.choice), made->text, request.place,
                                     request.assignments);
        see_from_beginning(session);
    } else {
        take_document(session, Document::untitled(made->text, request.place, request.assignments));
        session.assignments = request.assignments;
        if (!is_input) note_recent(session, request.start.picture);
    }
    Commands after = std::exchange(session.after_start, {});
    session.dropped.insert(session.dropped.end(), after.begin(), after.end());
    choose_first_view(session.view, session.document, request.start.picture);
    session.starts.keep(session.document, made->start);
    session.view.start = made->start;
}

void cancel_start(Session& session) {
    if (!session.starts.wanted()) return;
    session.starts.cancel();
    session.opens_input = false;
    say(session.status, "Cancelled; what was there stays");
}

void wait_for_start(Session& session) {
    while (session.starts.wanted()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        take_start(session);
    }
}

void offer_picture(Session& session, std::size_t layer) {
    const std::vector<LayerParams>& layers = session.document.scene().layers;
    session.view.grey_layer.clear();
    if (layer < layers.size() && lacks_picture(layers[layer])) session.view.grey_layer = layers[layer].name;
}

void find_recoveries(Status& status) {
    status.recoveries.clear();
    for (const Recovery& recovery : recoveries())
        status.recoveries.push_back({recovery.autosave, recovery.name(), recovery.time + " UTC"});
}

Document demo_document(std::span<const Assignment> assignments) {
    const fs::path file = assets_folder("scenes") / "whirlpool.toml";
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        throw InputError("the demo scene is not installed; name a scene, picture, mesh or splat file");
    return Document::untitled(read_file(file), file, assignments);
}

/// A, and B where that is compared with.
bool is_as_final_as_it_gets(const Session& session) {
    const ViewFrameState reached = session.view_frame.status().state;
    const bool with_b = compares(session.view) && session.view.compare_with == CompareWith::b;
    return reached == ViewFrameState::failed || !session.status.rendered_frame.empty() ||
           (reached == ViewFrameState::final && !(with_b && session.comparison.waiting()));
}

/// Most bytes of final frames that are kept.
std::int64_t limit_of_final_frames(const Settings& settings) {
    constexpr int usual_gib = 2;  // 240 frames of 960x540 with their alpha, as floats
    return std::int64_t{std::max(0, settings.frames_gib == 0 ? usual_gib : settings.frames_gib)} << 30;
}

void advance(Session& session, double now) {
    session.final_frames->limit(limit_of_final_frames(session.view.settings));

    session.playback.advance(session.view, session.document.scene().output, is_as_final_as_it_gets(session),
                             now);
    session.status.played_fps = session.playback.shown_fps();
    want_sets(session, now);
    session.sets.follow(
        session.document.scene(), session.view.layer,
        session.view_frame.status().state == ViewFrameState::final && session.sets.loader().idle());
    check_disk(session, now);
    say_missed_frames(session);
    count_memory(session, now);
    const bool opens_input = session.opens_input;
    try {
        take_start(session);
    } catch (const std::exception& error) {
        if (opens_input) throw;  // as of any other file that the program is started with
        say(session.status, error.what(), true);
    }
    attempt(session.status, [&] { show_renderings(session, now); });
    attempt(session.status, [&] { take_alignment(session); });
    show_thumbnails(session);
    show_kinds(session);
    session.autosave.update(session.document);
    fill_status(session);
    forget_old_message(session.status, session.message_age, now);
}

void navigate(Session& session, const ViewportInput& input, double now) {
    if (session.request.width <= 0) return;
    probe(session, input.hovered ? input.mouse_px : glm::dvec2(-1.0));
    if (input.click != ViewportInput::Click::none)
        attempt(session.status, [&] {
            if (session.view.picking_focus) return pick_focus_at(session, input.mouse_px);
            select_layer_at(session, input.mouse_px, input.click == ViewportInput::Click::behind);
        });
    if (session.view.size == SizeMode::one_to_one) return;  // the widgets move and zoom the frame
    attempt(session.status, [&] {
        if (session.navigator.navigate(input, session.shown(), now, session.document, session.view))
            say(session.status, left_camera_message);
    });
}

void carry_out(Session& session, Commands& commands) {
    for (auto command = commands.begin(); command != commands.end(); ++command) {
        attempt(session.status, [&] { carry_out(session, *command); });
        if (command->kind != Command::Kind::open || !session.starts.wanted()) continue;
        session.after_start.assign(command + 1, commands.end());
        break;
    }
    commands.clear();
}

/// A scene is opened; a look is given to the chosen layer; a camera drives the scene's; a mesh and a picture
/// together make one layer; on the untouched demo anything else makes a scene of its own, elsewhere a layer.
void drop(Session& session, const std::vector<fs::path>& files) {
    Commands commands;
    for (const fs::path& file : files) {
        const bool fresh = session.fresh_demo && !session.document.edited() && commands.empty();
        const Command::Kind kind = is_camera_file(file) && kind_of_file(file) != FileKind::splats
                                       ? Command::Kind::import_camera
                                       : command_for(kind_of_file(file), fresh);
        commands.push_back({kind, file, {}, 0});
    }
    session.dropped.insert(session.dropped.end(), commands.begin(), commands.end());
}

double next_due(const Session& session, double now) {
    constexpr double first_frame_s = 0.02, at_work_s = 0.1, movie_s = 0.008;
    if (!session.view.movie.empty()) return movie_s;
    const SetLoader& loader = session.sets.loader();
    if (!loader.sets_there()) return session.view_frame.status().shown == 0 ? first_frame_s : at_work_s;
    if (session.view.playing) return 0.0;
    const bool at_work = !loader.idle() || session.jobs.running() || session.estimate.working() ||
                         session.starts.wanted() || session.kind_views.working();
    return std::min(at_work ? paced(session, at_work_s) : idle_due_s, due_of_view(session, now));
}

bool preview_exact(const Session& session) { return session.view_frame.exact() && session.sets.same_sets(); }
bool settled(const Session& session) { return session.view_frame.status().state == ViewFrameState::final; }
std::string title(const Session& session) {
    return session.document.name() + (session.document.edited() ? " - edited" : "") + " - astrosplat";
}

void prepare_screenshot(Session& session, bool with_panels) {
    constexpr std::int64_t preview_splats = 500'000;
    session.viewport_is_frame = !with_panels;
    session.fixed_splats = preview_splats;
    session.status.recoveries.clear();
}

void save_screenshot(Session& session, const fs::path& file, int width, int height,
                     const std::vector<unsigned char>& rgba) {
    attempt(session.status, [&] {
        write_image(file, width, height, rgba, credit_of(session));
        say(session.status, "Saved " + file.string());
    });
}

ObjectMetadata source_metadata(const Session& session) {
    std::vector<const SplatSetFacts*> sets;
    std::vector<std::shared_ptr<const LoadedLayer>> held;
    for (const LayerParams& layer : session.document.scene().layers) {
        held.push_back(layer.visible ? session.sets.layer(layer) : nullptr);
        sets.push_back(held.back() && held.back()->set ? held.back()->set.get() : nullptr);
    }
    return source_metadata(session.document.scene(), sets);
}

std::string credit_of(const Session& session) {
    return resolved(session.document.scene().provenance, source_metadata(session)).credit;
}

void interrupt(Session& session) {
    if (session.document.edited()) session.autosave.write(session.document);
    throw Cancelled();  // an autosave stays behind an exception
}

void close(Session& session, int window_width, int window_height) {
    Preferences& preferences = session.preferences;
    preferences.window_width = window_width;
    preferences.window_height = window_height;
    static_cast<PanelSizes&>(preferences) = session.view;
    save_preferences(preferences);
}

}  // namespace astrosplat
