// Session: what the menus and keys ask for.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "edit/batch_command.h"
#include "edit/camera_moves.h"
#include "edit/layers.h"
#include "edit/new_from_file.h"
#include "edit/view_camera.h"
#include "scene/layer_setup.h"
#include "scene/save.h"
#include "viewer/programs.h"
#include "viewer/session_impl.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

std::string frame_text(double frame) {
    return fmt::format("{}", static_cast<std::int64_t>(std::lround(frame)));
}

/// The pattern of [output] path as an absolute path.
std::string absolute_pattern(const Document& document) {
    const fs::path folder =
        document.file().empty() ? fs::current_path() : fs::absolute(document.file()).parent_path();
    return (folder / document.scene().output.path).lexically_normal().string();
}

/// Frames as numbered PNGs in the job's folder, then one movie of them.
ProcessStep movie_step(const fs::path& folder, double fps, const fs::path& movie) {
    return {"Writing the movie",
            {"ffmpeg",
             "-y",
             "-loglevel",
             "error",
             "-framerate",
             fmt::format("{}", fps),
             "-pattern_type",
             "glob",
             "-i",
             (folder / "frame.*.png").string(),
             "-c:v",
             "libx264",
             "-crf",
             "16",
             "-preset",
             "slow",
             "-pix_fmt",
             "yuv420p",
             "-vf",
             "pad=ceil(iw/2)*2:ceil(ih/2)*2",
             "-movflags",
             "+faststart",
             movie.string()}};
}

fs::path make_job_folder() {
    std::string pattern = (fs::temp_directory_path() / "astrosplat-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw OutputError(pattern + ": cannot be made");
    return pattern;
}

}  // namespace

/// Renders files with --batch on a copy of the scene as it stands.
void Session::Impl::render_files(const Command& command) {
    using Kind = Command::Kind;
    std::vector<std::string> arguments = {"--overwrite"};
    if (!cache.folder.empty()) arguments.insert(arguments.end(), {"--cache", cache.folder.string()});
    const fs::path folder = make_job_folder();
    std::vector<ProcessStep> afterwards;
    std::int64_t frames =
        static_cast<std::int64_t>(parse_frames(document.scene().output.frames, "output.frames").size());
    if (command.kind == Kind::render_movie) {
        arguments.insert(arguments.end(), {"-o", (folder / "frame.######.png").string()});
        afterwards.push_back(movie_step(folder, document.scene().output.fps, command.path));
    } else if (command.kind == Kind::render_frame) {
        frames = 1;
        arguments.insert(arguments.end(),
                         {"-f", frame_text(view.frame), "-o", fs::absolute(command.path).string()});
    } else {
        arguments.insert(arguments.end(), {"-o", absolute_pattern(document)});
    }
    job.start(folder, document.text_for(folder / "scene.toml"), frames, arguments, std::move(afterwards));
    job_target = command.kind == Kind::render_range ? fs::path(absolute_pattern(document)) : command.path;
}

/// The command line that renders what the viewport shows.
void Session::Impl::copy_batch_command() {
    BatchCommandOptions options;
    options.frame = view.frame;
    options.width = request.width;
    options.height = request.height;
    if (request.region.width > 0) options.region = request.region;
    if (view.view != ViewKind::camera) options.camera = request.scene.camera;
    const BatchCommand command = batch_command(document, options);
    if (command.text.empty()) return say(command.reason, true);
    clipboard = command.text;
    say("Copied: " + command.text);
}

void Session::Impl::find_recoveries() {
    status.recoveries.clear();
    for (const Recovery& recovery : recoveries())
        status.recoveries.push_back({recovery.autosave,
                                     recovery.titled ? recovery.original.filename().string() : "Untitled",
                                     recovery.time + " UTC"});
}

void Session::Impl::poll_job() {
    job.poll();
    status.job = {};
    if (job.state() == RenderJob::State::running) status.job = {job.text(), job.progress()};
    const std::string last = job.text();
    switch (job.take_result()) {
        case RenderJob::State::done:
            say("Saved " + job_target.string());
            break;
        case RenderJob::State::failed:
            say(last, true);
            break;
        case RenderJob::State::cancelled:
            say("Rendering cancelled; finished frames are kept");
            break;
        default:
            break;
    }
}

void Session::Impl::say(const std::string& text, bool error) {
    status.message = {text, error, status.message.number + 1};
    status.log.push_back(status.message);
    constexpr std::size_t most = 500;
    if (status.log.size() > most) status.log.erase(status.log.begin());
}

/// One command; errors become the message line.
void Session::Impl::obey(const Command& command) {
    using Kind = Command::Kind;
    const auto layer_index = [&](std::size_t index) {
        return std::min(index, document.scene().layers.size() - 1);
    };
    switch (command.kind) {
        case Kind::new_from_file:
        case Kind::open:
            return open(command.path);
        case Kind::open_demo:
            take_document(demo_document());
            fresh_demo = true;
            return;
        case Kind::save:
            document.save();
            autosave.remove();
            return say("Saved " + document.file().string());
        case Kind::save_as:
            document.save_as(command.path);
            autosave.remove();
            add_recent(preferences, document.file());
            status.recent = preferences.recent;
            return say("Saved " + document.file().string());
        case Kind::reload:
            document.reload();
            return say("Read again: " + document.file().string());
        case Kind::keep:
            return document.ignore_change_on_disk();
        case Kind::recover:
            take_document(recover(command.path));
            if (autosave.write(document)) discard_recovery(command.path);
            find_recoveries();
            return say("Recovered; save to keep it");
        case Kind::discard_recovery:
            discard_recovery(command.path);
            find_recoveries();
            return;
        case Kind::quit:
            quitting = true;
            return;
        case Kind::import_file:
            document.edit("Add layer", [&](Scene& scene) { view.layer = add_layer(scene, command.path); });
            return;
        case Kind::set_reference:
            view.reference = command.path;
            view.compare = CompareMode::reference;
            return load_reference();
        case Kind::save_look: {
            if (document.scene().layers.empty()) return;
            const LayerParams& layer = document.scene().layers[layer_index(view.layer)];
            write_file_atomically(command.path, save_preset_text(layer.look, layer.render, command.path));
            return say("Saved the look of " + layer.name + " in " + command.path.string());
        }
        case Kind::apply_look:
            if (document.scene().layers.empty()) return;
            document.edit("Apply look", [&](Scene& scene) {
                apply_preset(scene.layers[layer_index(view.layer)], command.path);
            });
            return;
        case Kind::regenerate:
            return loader.retry(document.scene().layers[layer_index(command.index)].name);
        case Kind::cancel_load:
            return loader.cancel(document.scene().layers[layer_index(command.index)].name);
        case Kind::render_frame:
        case Kind::render_range:
        case Kind::render_movie:
            return render_files(command);
        case Kind::cancel_render:
            return job.cancel();
        case Kind::screenshot:
            screenshot = command.path;
            return;
        case Kind::store_b:
            take_snapshot();
            b_snapshot = static_cast<int>(snapshots.size()) - 1;
            return say("B is the look as it is now; Tab shows A or B");
        case Kind::take_snapshot:
            return take_snapshot();
        case Kind::restore_snapshot:
            if (command.index < snapshots.size()) restore_look(document, snapshots[command.index].look);
            return;
        case Kind::delete_snapshot:
            return delete_snapshot(command.index);
        case Kind::compare_snapshot:
            if (command.index < snapshots.size()) b_snapshot = static_cast<int>(command.index);
            return;
        case Kind::copy_batch_command:
            return copy_batch_command();
        case Kind::copy_text:
            clipboard = command.text;
            return;
        case Kind::frame_layer:
            return frame_box_in_view(layer_box(view.layer));
        case Kind::frame_all:
            return frame_box_in_view(status.box);
        case Kind::add_move:
            document.edit("Add camera move", [&](Scene& scene) {
                add_camera_move(scene, static_cast<CameraMove>(command.index), status.box, view.frame);
            });
            return;
    }
}

void Session::obey(Commands& commands, double) {
    for (const Command& command : commands) {
        try {
            impl_->obey(command);
        } catch (const InputError& error) {
            impl_->say(error.what(), true);
        } catch (const OutputError& error) {
            impl_->say(error.what(), true);
        }
    }
    commands.clear();
}

}  // namespace astrosplat
