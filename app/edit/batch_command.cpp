// Assignments are found by comparing parameter by parameter, and then proved by loading them.
#include "edit/batch_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "edit/keyframes.h"
#include "scene/describe.h"
#include "scene/load.h"
#include "scene/tracks.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

/// Frame files are relative to the scene in its file, to the working directory on the command line.
std::string full_pattern(const Scene& scene) {
    return (scene.file.parent_path() / scene.output.path).lexically_normal().string();
}

/// Tracks by name and frame files by their full path: what counts when two scenes render the same.
Scene comparable(Scene scene) {
    std::sort(scene.animation.begin(), scene.animation.end(),
              [](const Track& a, const Track& b) { return a.key < b.key; });
    scene.output.path = full_pattern(scene);
    return scene;
}

std::vector<Assignment> assignments_between(Scene saved, Scene shown) {
    std::vector<Assignment> assignments;
    if (saved.output.path != shown.output.path) shown.output.path = full_pattern(shown);
    const Description before = describe(saved), after = describe(shown);
    for (const Parameter& parameter : after.parameters) {
        const ParameterKey& key = parameter.spec.key;
        const Parameter* old = find_parameter(before, key);
        const Value value = parameter.get();
        const bool loses_track = is_animated(saved, key) && !is_animated(shown, key);
        if (!old || !(old->get() == value) || loses_track) assignments.push_back({key, to_toml(value)});
    }
    for (const Track& track : shown.animation) {
        const Track* old = find_track(saved, track.key);
        const Parameter* parameter = find_parameter(after, track.key);
        const bool assigned = std::any_of(assignments.begin(), assignments.end(),
                                          [&](const Assignment& a) { return a.key == track.key; });
        if (parameter && (!old || !(*old == track) || assigned))
            assignments.push_back(
                {ParameterKey("animation") / track.key, track_to_toml(track, parameter->spec)});
    }
    return assignments;
}

bool gives(const fs::path& file, const std::vector<Assignment>& assignments, const Scene& wanted) {
    try {
        return comparable(load_scene(file, assignments)) == comparable(wanted);
    } catch (const InputError&) {
        return false;
    }
}

Scene shown_scene(const Document& document, const BatchCommandOptions& options) {
    Scene scene = document.scene();
    if (!options.camera) return scene;
    scene.camera = *options.camera;
    std::erase_if(scene.animation, [](const Track& track) { return track.key.is_below("camera"); });
    return scene;
}

}  // namespace

std::string shell_word(const std::string& text) {
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               std::string("_-./,:+%@=").find(c) != std::string::npos;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

BatchCommand batch_command(const Document& document, const BatchCommandOptions& options) {
    if (document.file().empty()) return {"", "save the scene first: it has no file yet"};
    const Scene shown = shown_scene(document, options);
    const std::vector<Assignment> assignments = assignments_between(document.saved_scene(), shown);
    if (!gives(document.file(), assignments, shown))
        return {"", "save the scene first: its edits cannot be said as --set"};
    std::string text = fmt::format("{} {} {}", shell_word(options.program), options.mode,
                                   shell_word(document.file().string()));
    if (options.frame) text += fmt::format(" --frames={:.0f}", std::floor(*options.frame + 0.5));
    if (options.width > 0) text += fmt::format(" --resolution {}x{}", options.width, options.height);
    if (options.region) {
        const Region& r = *options.region;
        text += fmt::format(" --region {},{},{},{}", r.x, r.y, r.width, r.height);
    }
    for (const Assignment& a : assignments)
        text += " --set " + shell_word(fmt::format("{}={}", a.key, a.value));
    for (const std::string& word : options.arguments) text += " " + shell_word(word);
    return {text, ""};
}

BatchCommand render_command(const Document& document, const RenderTask& task, const std::string& program) {
    BatchCommandOptions options;
    options.arguments = renders_by_slurm(task) ? submit_arguments(task) : batch_arguments(task);
    if (renders_by_slurm(task)) options.mode = "--submit slurm";
    options.program = program;
    BatchCommand command = batch_command(document, options);
    if (command.text.empty() || task.kind != RenderKind::movie) return command;
    const fs::path movie = render_target(task);
    command.text += " &&";
    for (const std::string& word : movie_command(movie, document.scene().output.fps))
        command.text += " " + shell_word(word);
    command.text += " && rm -r " + shell_word(movie_folder(movie).string());
    return command;
}

}  // namespace astrosplat
