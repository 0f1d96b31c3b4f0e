// Edits become --set words by comparing parameter by parameter; loading the file with these words
// then proves them.
#include "edit/command_lines.h"

#include <fmt/format.h>

#include <system_error>

#include "core/error.h"
#include "core/file_format.h"
#include "edit/edits.h"
#include "frame/output_pattern.h"
#include "scene/describe.h"
#include "scene/describe_layer.h"
#include "scene/entries.h"
#include "scene/frames.h"
#include "scene/load.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

constexpr const char* own_ending = ".splats";

/// Of [output] path, with an absolute folder.
OutputPattern pattern_of(const Document& document) {
    std::error_code ignored;
    const fs::path folder = document.file().empty() ? fs::current_path(ignored)
                                                    : fs::absolute(document.file(), ignored).parent_path();
    return output_pattern(folder, document.scene().output.path);
}

bool is_of_one_frame(RenderKind kind) { return kind == RenderKind::frame || kind == RenderKind::splats; }

std::string splats_problem(const RenderTask& task) {
    if (task.most_splats < 0) return "splats are merged to a number above 0";
    if (is_own_format(task) && task.layer.empty())
        return "choose a layer: such a file holds one layer's own splats";
    if (is_own_format(task) && task.most_splats > 0) return "such a file holds all of the layer's splats";
    try {
        if (parse_frames(task.frames, "frames").size() == 1) return "";
    } catch (const InputError& error) {
        return error.what();
    }
    return "splats are those of one frame";
}

std::string frame_problem(const RenderTask& task, const CameraParams& camera) {
    try {
        const std::size_t count = parse_frames(task.frames, "frames").size();
        const OutputPattern name{{}, task.name};
        if (task.kind == RenderKind::movie && (name.is_numbered() || name.is_stereo()))
            return "a movie is one file: its name has no place for a number or an eye";
        const OutputPattern files = output_pattern("/", render_files(task).string());
        eyes_of(files, camera);
        if (task.kind == RenderKind::range && count > 1 && !files.is_numbered())
            return "the name needs #### where the number of the frame goes";
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::string usual_words(const Document& document, RenderKind kind) {
    const RenderTask usual = make_render_task(document, kind, 1.0);
    return render_title(usual) + " " + render_target(usual).string();
}

}  // namespace

RenderTask make_render_task(const Document& document, RenderKind kind, double frame) {
    const OutputParams& output = document.scene().output;
    const OutputPattern pattern = pattern_of(document);
    const fs::path name(pattern.name);
    RenderTask task;
    task.kind = kind;
    task.frames = is_of_one_frame(kind) ? fmt::format("{}", std::lround(frame)) : output.frames;
    task.width = output.width;
    task.height = output.height;
    const bool movie = kind == RenderKind::movie, splats = kind == RenderKind::splats;
    task.folder =
        (movie || splats ? pattern.common_folder() : pattern.folder / name.parent_path()).lexically_normal();
    task.name = movie ? pattern.stem() + ".mp4" : splats ? pattern.stem() + ".ply" : name.filename().string();
    return task;
}

RenderTask kept_render(const std::vector<KeptRender>& kept, const Document& document, RenderKind kind,
                       double frame) {
    RenderTask task = make_render_task(document, kind, frame);
    const auto found = std::ranges::find_if(kept, [&](const KeptRender& k) {
        return k.scene == document.file() && k.task.kind == kind && k.usual == usual_words(document, kind);
    });
    if (found == kept.end()) return task;
    const std::string now = std::exchange(task, found->task).frames;
    if (is_of_one_frame(kind)) task.frames = now;
    task.existing = ExistingFrames::resume;
    return task;
}

void keep_render(std::vector<KeptRender>& kept, const Document& document, const RenderTask& task) {
    constexpr std::size_t most = 24;
    std::erase_if(
        kept, [&](const KeptRender& k) { return k.scene == document.file() && k.task.kind == task.kind; });
    kept.insert(kept.begin(), {document.file(), usual_words(document, task.kind), task});
    if (kept.size() > most) kept.pop_back();
}

fs::path render_target(const RenderTask& task) { return task.folder / task.name; }

std::vector<std::string> render_endings(RenderKind kind) {
    if (kind == RenderKind::movie) return endings_of(FileUse::movie);
    if (kind != RenderKind::splats) return endings_of({FileKind::picture}, FileUse::written);
    std::vector<std::string> endings = endings_of(FileUse::exported);
    endings.push_back(own_ending);
    return endings;
}

std::string with_ending(const std::string& name, const std::string& ending) {
    return fs::path(name).replace_extension(ending).string();
}

std::string render_problem(const RenderTask& task, const CameraParams& camera) {
    constexpr std::int64_t largest = 65536, largest_chunk = 1'000'000;
    if (task.width < 1 || task.height < 1 || task.width > largest || task.height > largest)
        return fmt::format("a side is 1 to {} px long, not {} and {}", largest, task.width, task.height);
    if (task.folder.empty() || !task.folder.is_absolute()) return "choose a folder";
    if (task.name.empty() || task.name.find('/') != std::string::npos)
        return "give the files a name, without /";
    const std::vector<std::string> endings = render_endings(task.kind);
    const std::string ending = fs::path(task.name).extension().string();
    if (std::find(endings.begin(), endings.end(), ending) == endings.end())
        return fmt::format("the name ends with one of {}, not with '{}'", fmt::join(endings, " "), ending);
    if (renders_by_slurm(task) && (task.chunk < 1 || task.chunk > largest_chunk))
        return fmt::format("a task has 1 to {} frames, not {}", largest_chunk, task.chunk);
    return task.kind == RenderKind::splats ? splats_problem(task) : frame_problem(task, camera);
}

std::string render_title(const RenderTask& task) {
    if (task.kind == RenderKind::splats) return "Splats of frame " + task.frames;
    const char* const what = task.kind == RenderKind::movie   ? "Movie of "
                             : task.kind == RenderKind::frame ? "Frame "
                                                              : "Frames ";
    return fmt::format("{}{}, {}x{}", what, task.frames, task.width, task.height);
}

std::vector<std::string> frame_arguments(const RenderTask& task) {
    return {"--frames=" + task.frames,  // also where it begins with a minus
            fmt::format("--resolution={}x{}", task.width, task.height),
            "--output=" + render_files(task).string()};
}

bool is_own_format(const RenderTask& task) { return fs::path(task.name).extension() == own_ending; }

std::string export_mode(const RenderTask& task) { return is_own_format(task) ? "generate" : "export"; }

std::vector<std::string> export_arguments(const RenderTask& task) {
    std::vector<std::string> words = {"--output=" + render_target(task).string()};
    if (!is_own_format(task)) words.push_back("--frame=" + task.frames);
    if (!task.layer.empty()) words.push_back("--layer=" + task.layer);
    if (task.most_splats > 0) words.push_back(fmt::format("--count={}", task.most_splats));
    if (task.existing == ExistingFrames::replace) words.push_back("--overwrite");
    return words;
}

bool renders_by_slurm(const RenderTask& task) {
    return task.by_slurm && (task.kind == RenderKind::frame || task.kind == RenderKind::range);
}

std::vector<std::string> submit_arguments(const RenderTask& task) {
    std::vector<std::string> words = frame_arguments(task);
    words.push_back(fmt::format("--chunk={}", task.chunk));
    if (!task.partition.empty()) words.push_back("--partition=" + task.partition);
    words.push_back("--overwrite");
    return words;
}

std::vector<std::string> batch_arguments(const RenderTask& task, const MachineLimits& limits) {
    std::vector<std::string> words = frame_arguments(task);
    // A movie's frames lie in a folder of its own, where nothing is in the way, and are plain PNG whatever
    // the scene's own files hold.
    const bool refuse = task.existing == ExistingFrames::refuse && task.kind != RenderKind::movie;
    if (task.existing != ExistingFrames::replace && !refuse) words.push_back("--resume");
    if (!refuse) words.push_back("--overwrite");
    if (task.kind == RenderKind::movie) {
        words.push_back("--ffmetadata=" + movie_words(render_target(task)).string());
        if (task.existing == ExistingFrames::resume)
            words.push_back("--movie=" + render_target(task).string());
        for (const char* const key : {"aovs=[]", "depth=auto", "compression=auto", "alpha=auto"})
            words.insert(words.end(), {"--set", std::string("output.") + key});
    }
    const std::vector<std::string> limited = limit_arguments(limits);
    words.insert(words.end(), limited.begin(), limited.end());
    return words;
}

fs::path movie_folder(const fs::path& movie) { return movie.string() + ".frames"; }

fs::path movie_part(const fs::path& movie) {
    return movie_folder(movie) / ("movie" + movie.extension().string());
}

fs::path movie_words(const fs::path& movie) { return movie_folder(movie) / "movie.ffmetadata"; }

fs::path render_files(const RenderTask& task) {
    const fs::path target = render_target(task);
    return task.kind == RenderKind::movie ? movie_folder(target) / "frame.######.png" : target;
}

std::vector<std::string> movie_command(const fs::path& movie, double fps) {
    std::vector<std::string> words = {"ffmpeg", "-y", "-loglevel", "error", "-framerate"};
    words.push_back(fmt::format("{}", fps));
    words.insert(words.end(), {"-pattern_type", "glob", "-i"});
    words.push_back(with_backslashes(movie_folder(movie).string(), "*?[]{}\\") + "/frame.*.png");
    words.insert(words.end(), {"-f", "ffmetadata", "-i", movie_words(movie).string(), "-map_metadata", "1"});
    words.insert(words.end(), {"-c:v", "libx264", "-crf", "16", "-preset", "slow", "-pix_fmt", "yuv420p"});
    // Without a matrix ffmpeg takes that of standard definition, which players take for small pictures only;
    // without tags each guesses.
    words.insert(words.end(), {"-vf",
                               "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv:"
                               "flags=accurate_rnd+full_chroma_int"});
    for (const char* const tag : {"-colorspace", "-color_primaries", "-color_trc"})
        words.insert(words.end(), {tag, "bt709"});
    words.insert(words.end(), {"-color_range", "tv", "-movflags", "+faststart"});
    words.push_back(movie_part(movie).string());
    return words;
}

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

std::string with_backslashes(const std::string& text, std::string_view special) {
    std::string escaped;
    for (const char c : text) {
        if (special.find(c) != special.npos) escaped += '\\';
        escaped += c;
    }
    return escaped;
}

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
    const bool splats = task.kind == RenderKind::splats;
    options.arguments = splats                   ? export_arguments(task)
                        : renders_by_slurm(task) ? submit_arguments(task)
                                                 : batch_arguments(task);
    if (renders_by_slurm(task)) options.mode = "--submit slurm";
    if (splats) options.mode = export_mode(task);
    options.program = program;
    BatchCommand command = batch_command(document, options);
    if (command.text.empty() || task.kind != RenderKind::movie) return command;
    const fs::path movie = render_target(task);
    const std::string file = shell_word(movie.string());
    if (task.existing == ExistingFrames::refuse) command.text = "[ ! -e " + file + " ] && " + command.text;
    // There are no words of a movie that was kept.
    command.text += " && if [ -e " + shell_word(movie_words(movie).string()) + " ]; then";
    for (const std::string& word : movie_command(movie, document.scene().output.fps))
        command.text += " " + shell_word(word);
    command.text += " && mv " + shell_word(movie_part(movie).string()) + " " + file + " && rm -r " +
                    shell_word(movie_folder(movie).string()) + "; fi";
    return command;
}

namespace {

void add_inputs(const SourceParams& source, std::vector<std::string>& words) {
    if (source.kind != SourceKind::mesh || source.meshes.empty() || source.meshes[0].texture.empty())
        throw InputError("source.meshes: expected a picture to prepare, found none");
    const std::vector<fs::path>& files = source.meshes[0].texture;
    if (files.size() == 1) return words.push_back(files[0].string());
    constexpr const char* filters[] = {"--r", "--g", "--b"};
    for (std::size_t i = 0; i < 3; ++i) words.insert(words.end(), {filters[i], files[i].string()});
}

}  // namespace

std::vector<std::string> prepare_command(const SourceParams& source, const fs::path& folder) {
    std::vector<std::string> words{"prepare"};
    add_inputs(source, words);
    words.insert(words.end(), {"-o", folder.string()});
    TextureSettings texture = source.texture, standard;
    if (texture.prepare.lupton || !is_fits(source.meshes[0].texture[0])) texture.stretch = standard.stretch;
    const Description description = describe_preparation(texture), defaults = describe_preparation(standard);
    const auto find = [&](const ParameterKey& key) { return find_parameter(description, key); };
    for (std::size_t i = 0; i < description.parameters.size(); ++i) {
        const Parameter& parameter = description.parameters[i];
        const Value value = parameter.get();
        const ParameterKey& key = parameter.spec.key;
        const bool said_anyway = key == "stars" || key == "lupton";  // whose defaults the command chooses
        if (!has_effect(parameter.spec, find)) continue;
        if (!said_anyway && value == defaults.parameters[i].get()) continue;
        words.insert(words.end(), {prepare_option(key), value.text() ? *value.text() : to_toml(value)});
    }
    return words;
}

}  // namespace astrosplat
