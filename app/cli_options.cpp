#include "cli_options.h"

namespace astrosplat {
namespace {

void add_batch(CLI::App& app, Invocation& call) {
    BatchOptions& batch = call.batch_options;
    app.add_flag("--batch", call.batch, "Renders the scene's frames without a window");
    app.add_option("SCENE", call.input, "A scene; without --batch also a picture, mesh or splat file");
    add_frame_choice(app, batch);
    app.add_flag("--resume", batch.resume, "Skips frames that are there already, renders missing ones");
    app.add_flag("--overwrite", batch.overwrite, "Replaces files that are there already");
    app.add_flag("--dry-run", batch.dry_run, "Tells frames, time, memory and bytes, and does nothing");
    app.add_flag("--sets-only", batch.sets_only, "Generates the sets into the cache, renders nothing");
    add_value(app, "--stats", batch.stats, "FILE.json", "Writes figures as JSON");
    add_progress(app, batch.progress);
}

void add_submit(CLI::App& app, SubmitOptions& submit) {
    add_value(app, "--submit", submit.system, "slurm",
              "Renders what is missing of the scene's frames on a farm, by --batch with --resume");
    add_value(app, "--chunk", submit.chunk, "N", "With --submit: frames of a task (default: 10)");
    add_value(app, "--partition", submit.partition, "NAME", "With --submit: where the tasks run");
}

void add_screenshot(CLI::App& app, Invocation& call) {
    ScreenshotOptions& shot = call.screenshot;
    add_value(app, "--screenshot", shot.output, "OUT.png|OUT.exr",
              "Saves what the window would show, without one");
    add_value(app, "--size", shot.size, "WxH", "With --screenshot: its size in pixels (default: 960x540)");
    add_value(app, "--frame", shot.frame, "N", "With --screenshot: the frame (default: the first)");
    app.add_flag("--ui", shot.ui, "With --screenshot: the whole window with its panels");
    app.add_flag("--settled", shot.settled, "With --screenshot: the final frame, not the preview");
    app.add_flag("--opengl", shot.opengl, "With --screenshot: a preview drawn by OpenGL on any machine");
}

}  // namespace

void add_program_options(CLI::App& app, Invocation& call) {
    add_common(app, call.common);
    add_batch(app, call);
    add_submit(app, call.submit);
    add_screenshot(app, call);
}

}  // namespace astrosplat
