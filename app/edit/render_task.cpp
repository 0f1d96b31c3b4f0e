#include "edit/render_task.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "core/file_format.h"
#include "frame/output_pattern.h"
#include "scene/frames.h"

namespace astrosplat {
namespace fs = std::filesystem;
namespace {

/// Of [output] path, with an absolute folder.
OutputPattern pattern_of(const Document& document) {
    std::error_code ignored;
    const fs::path folder = document.file().empty() ? fs::current_path(ignored)
                                                    : fs::absolute(document.file(), ignored).parent_path();
    return output_pattern(folder, document.scene().output.path);
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

// What ffmpeg's pattern takes for this very text.
std::string literal_in_glob(const std::string& text) {
    std::string literal;
    for (const char c : text) {
        if (std::string_view("*?[]{}\\").find(c) != std::string_view::npos) literal += '\\';
        literal += c;
    }
    return literal;
}

}  // namespace

RenderTask make_render_task(const Document& document, RenderKind kind, double frame) {
    const OutputParams& output = document.scene().output;
    const OutputPattern pattern = pattern_of(document);
    const fs::path name(pattern.name);
    RenderTask task;
    task.kind = kind;
    task.frames = kind == RenderKind::frame ? fmt::format("{}", std::lround(frame)) : output.frames;
    task.width = output.width;
    task.height = output.height;
    const bool movie = kind == RenderKind::movie;
    task.folder = (movie ? pattern.common_folder() : pattern.folder / name.parent_path()).lexically_normal();
    task.name = movie ? pattern.stem() + endings_of(FileUse::movie).front() : name.filename().string();
    return task;
}

fs::path render_target(const RenderTask& task) { return task.folder / task.name; }

std::vector<std::string> render_endings(RenderKind kind) {
    if (kind == RenderKind::movie) return endings_of(FileUse::movie);
    return endings_of({FileKind::picture}, FileUse::written);
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
    return frame_problem(task, camera);
}

std::string render_title(const RenderTask& task) {
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

bool renders_by_slurm(const RenderTask& task) { return task.by_slurm && task.kind != RenderKind::movie; }

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
    if (task.kind == RenderKind::movie)
        for (const char* const key : {"aovs=[]", "depth=auto", "compression=auto", "alpha=auto"})
            words.insert(words.end(), {"--set", std::string("output.") + key});
    const std::vector<std::string> limited = limit_arguments(limits);
    words.insert(words.end(), limited.begin(), limited.end());
    return words;
}

fs::path movie_folder(const fs::path& movie) { return movie.string() + ".frames"; }

fs::path render_files(const RenderTask& task) {
    const fs::path target = render_target(task);
    return task.kind == RenderKind::movie ? movie_folder(target) / "frame.######.png" : target;
}

std::vector<std::string> movie_command(const fs::path& movie, double fps) {
    return {"ffmpeg",
            "-y",
            "-loglevel",
            "error",
            "-framerate",
            fmt::format("{}", fps),
            "-pattern_type",
            "glob",
            "-i",
            literal_in_glob(movie_folder(movie).string()) + "/frame.*.png",
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
            movie.string()};
}

}  // namespace astrosplat
