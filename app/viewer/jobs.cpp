#include "viewer/jobs.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "edit/prepare_command.h"
#include "scene/frames.h"

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
    std::vector<std::string> words = {"ffmpeg", "-y", "-loglevel", "error"};
    const auto add = [&](const char* option, std::string value) {
        words.insert(words.end(), {option, std::move(value)});
    };
    add("-framerate", fmt::format("{}", fps));
    add("-pattern_type", "glob");
    add("-i", (folder / "frame.*.png").string());
    add("-c:v", "libx264");
    add("-crf", "16");
    add("-preset", "slow");
    add("-pix_fmt", "yuv420p");
    add("-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2");
    add("-movflags", "+faststart");
    words.push_back(movie.string());
    return {"Writing the movie", words};
}

fs::path make_job_folder() {
    std::string pattern = (fs::temp_directory_path() / "astrosplat-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw OutputError(pattern + ": cannot be made");
    return pattern;
}

}  // namespace

void Jobs::start(const Command& command, const Document& document, double frame) {
    const fs::path folder = make_job_folder();
    try {
        start_in(folder, command, document, frame);
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
        throw;
    }
}

void Jobs::start_in(const fs::path& folder, const Command& command, const Document& document, double frame) {
    using Kind = Command::Kind;
    const OutputParams& output = document.scene().output;
    std::vector<std::string> arguments = {"--overwrite"};
    if (!cache_.folder.empty()) arguments.insert(arguments.end(), {"--cache", cache_.folder.string()});
    std::vector<ProcessStep> afterwards;
    auto frames = static_cast<std::int64_t>(parse_frames(output.frames, "output.frames").size());
    fs::path target = command.path;
    if (command.kind == Kind::render_movie) {
        arguments.insert(arguments.end(), {"-o", (folder / "frame.######.png").string()});
        afterwards.push_back(movie_step(folder, output.fps, command.path));
    } else if (command.kind == Kind::render_frame) {
        frames = 1;
        arguments.insert(arguments.end(),
                         {"-f", frame_text(frame), "-o", fs::absolute(command.path).string()});
    } else {
        target = absolute_pattern(document);
        arguments.insert(arguments.end(), {"-o", target.string(), "--resume"});  // what is done stays
    }
    job_.start(folder, document.text_for(folder / "scene.toml"), frames, arguments, std::move(afterwards));
    target_ = std::move(target);
}

void Jobs::prepare(const SourceParams& source, const fs::path& folder) {
    job_.start({"Preparing", prepare_command(source, folder)});
    target_ = folder;
}

std::optional<Jobs::News> Jobs::poll(JobStatus& status) {
    job_.poll();
    status = {};
    if (running()) status = {job_.text(), job_.progress()};
    const std::string last = job_.text();
    switch (job_.take_result()) {
        case RenderJob::State::done:
            return News{"Saved " + target_.string()};
        case RenderJob::State::failed:
            return News{last, true};
        case RenderJob::State::cancelled:
            return News{"Cancelled; finished files are kept"};
        default:
            return std::nullopt;
    }
}

}  // namespace astrosplat
