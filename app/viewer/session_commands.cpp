// Commands of menus and shortcuts to a session: a table from commands to functions.
#include <iterator>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/text.h"
#include "edit/command_lines.h"
#include "edit/layers.h"
#include "edit/view_camera.h"
#include "scene/animate.h"
#include "scene/camera_file.h"
#include "scene/detail_tiles.h"
#include "scene/frames.h"
#include "scene/layer_setup.h"
#include "scene/reference_place.h"
#include "scene/save.h"
#include "source/write_image.h"
#include "viewer/session.h"

namespace astrosplat {
namespace {

using Kind = Command::Kind;
using State = Session;

/// The layer of an index, or the last; null without layers.
const LayerParams* layer_at(const State& s, std::size_t index) {
    const std::vector<LayerParams>& layers = s.document.scene().layers;
    return layers.empty() ? nullptr : &layers[std::min(index, layers.size() - 1)];
}

void open_demo(State& s, const Command&) {
    take_document(s, demo_document());
    s.fresh_demo = true;
}

void note_saved(State& s) {
    s.autosave.remove();
    say(s.status, "Saved " + s.document.file().string());
}

void save(State& s, const Command&) {
    s.document.save();
    note_saved(s);
}

void save_as(State& s, const Command& c) {
    s.document.save_as(c.path);
    note_recent(s, s.document.file());
    note_saved(s);
    s.snapshots.move_to(s.document.file());
}

void recover_autosave(State& s, const Command& c) {
    take_document(s, recover(c.path));
    if (!s.document.file().empty()) note_recent(s, s.document.file());
    if (s.autosave.write(s.document)) discard_recovery(c.path);
    find_recoveries(s.status);
    say(s.status, "Recovered; save to keep it");
}

void new_scene(State& s, const Command& c) {
    const std::string text = c.text.empty() ? empty_scene_text() : shape_scene_text(c.text);
    take_document(s, Document::untitled(text, fs::absolute("untitled.toml")));
    offer_picture(s, 0);
}

void import_file(State& s, const Command& c) {
    s.document.edit("Add layer", [&](Scene& scene) { s.view.layer = add_layer(scene, c.path); });
    offer_picture(s, s.view.layer);
}

void add_shape_layer(State& s, const Command& c) {
    s.document.edit("Add " + c.text, [&](Scene& scene) { s.view.layer = add_shape(scene, c.text); });
    offer_picture(s, s.view.layer);
}

void choose_picture(State& s, const Command& c) {
    const LayerParams* layer = layer_at(s, c.index);
    if (!layer || layer->source.meshes.empty()) return;
    const std::string key = layer_key(layer->name) / "source.meshes.0.texture";
    s.document.set(key, fs::absolute(c.path).string(), s.view.frame);
    s.view.grey_layer.clear();
}

/// In place of the one that the view has, or a new one.
void set_reference(State& s, const Command& c) {
    s.document.edit("Reference " + c.path.filename().string(), [&](Scene& scene) {
        const auto index = find_reference(scene, reference_view(s.view.view), s.view.frame);
        if (!index) scene.references.emplace_back();
        (index ? scene.references[*index] : scene.references.back()).file = fs::absolute(c.path);
    });
    show_reference(s.view);
}

/// "frame 5", "frames 5 to 9".
std::string frames_in_words(const Track& track) {
    const double first = track.keyframes.front().frame, last = track.keyframes.back().frame;
    return first == last ? "frame " + shortest(first) : "frames " + shortest(first) + " to " + shortest(last);
}

void import_camera(State& s, const Command& c) {
    s.document.edit("Import camera " + c.path.filename().string(),
                    [&](Scene& scene) { scene.camera.file = fs::absolute(c.path); });
    const std::vector<Track>& tracks = s.document.scene().imported.camera->tracks;
    if (!tracks.empty())
        say(s.status, "Camera of " + c.path.filename().string() + ": " + frames_in_words(tracks.front()));
}

void export_camera(State& s, const Command& c) {
    const Scene& scene = s.document.scene();
    const std::vector<std::int64_t> frames = parse_frames(scene.output.frames, "output.frames");
    write_file_atomically(c.path, camera_text(camera_track(scene, frames), scene, c.path));
    say(s.status, "Saved the camera at " + counted(std::ssize(frames), "frame") + " in " + c.path.string());
}

void save_look(State& s, const Command& c) {
    const LayerParams* layer = layer_at(s, s.view.layer);
    if (!layer) return;
    write_file_atomically(c.path, save_preset_text(layer->look, layer->render, c.path));
    say(s.status, "Saved the look of " + layer->name + " in " + c.path.string());
}

void make_detail(State& s, const Command&) {
    double more_splats = 0.0;
    s.document.edit("Detail where the camera comes close", [&](Scene& scene) {
        for (const LayerDetail& found : set_detail(scene, double(usual_detail_splats), s.cache))
            more_splats += found.tiles.more_splats;
    });
    say(s.status, more_splats > 0.0 ? human_count(std::int64_t(more_splats), "more splat") +
                                          " of detail where the camera comes close"
                                    : "The camera comes nowhere so close that a picture's texels show");
}

void apply_look_file(State& s, const Command& c) {
    if (!layer_at(s, s.view.layer)) return;
    s.document.edit("Apply look", [&](Scene& scene) {
        apply_preset(scene.layers[std::min(s.view.layer, scene.layers.size() - 1)], c.path);
    });
}

void render_files(State& s, const Command&) {
    s.jobs.add(s.view.render, s.document);
    keep_render(s.view.renders, s.document, s.view.render);
    s.preferences.renders = s.view.renders;
    save_preferences(s.preferences);
    if (s.jobs.jobs().size() > 1) s.view.queue_open = true;
}

void choose_target(State& s, const Command& c) {
    s.view.render.folder = c.path.parent_path();
    s.view.render.name = c.path.filename().string();
    s.view.render_open = true;
}

/// The part of the viewport that shows the frame, without its surroundings.
void save_view(State& s, const Command& c) {
    const Rect whole = frame_in_viewport(s);
    const auto edge = [](float px, int most) {
        return std::clamp(static_cast<int>(std::lround(px)), 0, most);
    };
    const int x0 = edge(whole.x, s.viewport_px.x), x1 = edge(whole.x + whole.width, s.viewport_px.x),
              y0 = edge(whole.y, s.viewport_px.y), y1 = edge(whole.y + whole.height, s.viewport_px.y);
    if (x1 <= x0 || y1 <= y0) throw InputError("there is no frame to save yet");
    const std::vector<unsigned char> all = s.display.read();
    std::vector<unsigned char> part;
    for (int y = y0; y < y1; ++y) {
        const auto row = all.begin() + 4 * (std::ptrdiff_t{y} * s.viewport_px.x + x0);
        part.insert(part.end(), row, row + 4 * std::ptrdiff_t{x1 - x0});
    }
    write_image(c.path, x1 - x0, y1 - y0, part, credit_of(s));
    say(s.status, "Saved " + c.path.string());
}

/// With a thumbnail of A, whatever it is compared with, and the facts of that frame.
void snapshot(State& s, const Command&) {
    constexpr int thumbnail_px = 192;
    SnapshotList& snapshots = s.snapshots;
    const ViewFrameStatus& shown = s.view_frame.status();
    const bool final = shown.state == ViewFrameState::final;
    DisplaySettings alone = s.displayed;
    alone.b = 0;
    alone.inspection = {};
    s.display.draw(alone, s.viewport_px.x, s.viewport_px.y);
    snapshots.add(store_look({snapshots.next_name(), s.view.frame, final ? shown.total : shown.shown,
                              final ? shown.seconds : 0.0},
                             s.document),
                  thumbnail_of(s.display.read(), s.viewport_px.x, s.viewport_px.y, thumbnail_px));
}

void store_b(State& s, const Command& c) {
    const std::size_t index = s.snapshots.size();
    say(s.status,
        std::string("B is the look as it is now; ") +
            (s.view.compare_with == CompareWith::b ? "the key A shows it" : "Ctrl+B compares with it"));
    try {
        snapshot(s, c);
    } catch (const OutputError& error) {
        say(s.status, error.what(), true);
    }
    s.snapshots.set_b(index);
}

void restore_snapshot(State& s, const Command& c) {
    if (const StoredLook* look = s.snapshots.look(c.index)) restore_look(s.document, *look);
}

void show_snapshot(State& s, const Command& c) {
    s.snapshots.set_b(c.index);
    s.view.compare_with = CompareWith::b;
    s.view.compare = CompareMode::other;
}

/// The command line that renders what the viewport shows.
void copy_batch_command(State& s, const Command&) {
    BatchCommandOptions options;
    options.frame = s.view.frame;
    options.width = s.request.width;
    options.height = s.request.height;
    if (s.request.region.width > 0) options.region = s.request.region;
    if (s.view.view != ViewKind::camera) options.camera = s.request.scene.camera;
    const BatchCommand command = batch_command(s.document, options);
    if (command.text.empty()) return say(s.status, command.reason, true);
    s.clipboard = command.text;
    say(s.status, "Copied: " + command.text);
}

void frame_box_in_view(State& s, const Bounds& box) {
    if (frame_in_view(s.view, box, s.shown())) say(s.status, left_camera_message);
}

void frame_layer(State& s, const Command&) {
    Bounds box = s.status.box;
    const Scene now = scene_at(s.document.scene(), s.view.frame);
    if (s.view.layer < now.layers.size()) {
        const LayerParams& layer = now.layers[s.view.layer];
        if (const auto loaded = s.sets.loader().layer(layer.name))
            box = world_bounds(loaded->box, render_layer(now, layer));
    }
    frame_box_in_view(s, box);
}

void add_move(State& s, const Command& c) {
    s.document.edit("Add camera move", [&](Scene& scene) {
        add_camera_move(scene, static_cast<CameraMove>(c.index), s.status.box, s.view.frame,
                        s.view.later_keys);
    });
}

void keep_settings(State& s, const Command&) {
    const std::string problem = problem_of_cache_folder(s.view.settings.cache_folder);
    if (!problem.empty()) {
        say(s.status, "Cache folder: " + problem, true);
        s.view.settings.cache_folder = s.preferences.settings.cache_folder;
    }
    s.preferences.settings = s.view.settings;
    save_preferences(s.preferences);
}

struct Entry {
    Kind kind;
    void (*function)(State&, const Command&);
};

constexpr Entry entries[] = {
    {Kind::start_again, [](State& s, const Command& c) { start_again(s, c.text); }},
    {Kind::cancel_start, [](State& s, const Command&) { cancel_start(s); }},
    {Kind::new_scene, new_scene},
    {Kind::open, [](State& s, const Command& c) { open_file(s, c.path); }},
    {Kind::open_demo, open_demo},
    {Kind::save, save},
    {Kind::save_as, save_as},
    {Kind::reload,
     [](State& s, const Command&) {
         s.document.reload();
         say(s.status, "Read again: " + s.document.file().string());
     }},
    {Kind::keep, [](State& s, const Command&) { s.document.ignore_change_on_disk(); }},
    {Kind::recover, recover_autosave},
    {Kind::discard_recovery,
     [](State& s, const Command& c) {
         discard_recovery(c.path);
         find_recoveries(s.status);
     }},
    {Kind::quit, [](State& s, const Command&) { s.quitting = true; }},
    {Kind::import_file, import_file},
    {Kind::add_shape, add_shape_layer},
    {Kind::choose_picture, choose_picture},
    {Kind::set_reference, set_reference},
    {Kind::align_reference, [](State& s, const Command&) { begin_alignment(s); }},
    {Kind::import_camera, import_camera},
    {Kind::export_camera, export_camera},
    {Kind::save_look, save_look},
    {Kind::apply_look, apply_look_file},
    {Kind::regenerate,
     [](State& s, const Command& c) {
         if (const LayerParams* layer = layer_at(s, c.index)) s.sets.loader().retry(layer->name);
     }},
    {Kind::cancel_load,
     [](State& s, const Command& c) {
         if (const LayerParams* layer = layer_at(s, c.index)) s.sets.loader().cancel(layer->name);
     }},
    {Kind::render, render_files},
    {Kind::choose_target, choose_target},
    {Kind::make_detail, make_detail},
    {Kind::prepare_picture,
     [](State& s, const Command& c) {
         if (const LayerParams* layer = layer_at(s, c.index)) s.jobs.add_preparation(layer->source, c.path);
     }},
    {Kind::cancel_render, [](State& s, const Command&) { s.jobs.cancel_running(); }},
    {Kind::cancel_job, [](State& s, const Command& c) { s.jobs.cancel(c.index); }},
    {Kind::remove_job, [](State& s, const Command& c) { s.jobs.remove(c.index); }},
    {Kind::retry_job, [](State& s, const Command& c) { s.jobs.retry(c.index); }},
    {Kind::open_folder,
     [](State& s, const Command& c) {
         s.file_manager.emplace(std::vector<std::string>{"xdg-open", c.path.string()});
     }},
    {Kind::save_view, save_view},
    {Kind::screenshot, [](State& s, const Command& c) { s.screenshot = c.path; }},
    {Kind::store_b, store_b},
    {Kind::take_snapshot, snapshot},
    {Kind::restore_snapshot, restore_snapshot},
    {Kind::rename_snapshot, [](State& s, const Command& c) { s.snapshots.rename(c.index, c.text); }},
    {Kind::delete_snapshot, [](State& s, const Command& c) { s.snapshots.remove(c.index); }},
    {Kind::compare_snapshot, [](State& s, const Command& c) { s.snapshots.set_b(c.index); }},
    {Kind::show_snapshot, show_snapshot},
    {Kind::copy_batch_command, copy_batch_command},
    {Kind::copy_text, [](State& s, const Command& c) { s.clipboard = c.text; }},
    {Kind::say, [](State& s, const Command& c) { say(s.status, c.text); }},
    {Kind::frame_layer, frame_layer},
    {Kind::frame_all, [](State& s, const Command&) { frame_box_in_view(s, s.status.box); }},
    {Kind::add_move, add_move},
    {Kind::keep_settings, keep_settings}};

static_assert(std::size(entries) == static_cast<std::size_t>(Kind::keep_settings) + 1);

}  // namespace

void carry_out(Session& session, const Command& command) {
    std::ranges::find(entries, command.kind, &Entry::kind)->function(session, command);
}

}  // namespace astrosplat
