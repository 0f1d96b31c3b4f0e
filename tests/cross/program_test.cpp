// The program itself on scenes drawn from seeds: batch, verify, resume, the window's jobs and its movies make
// files of the same names and pixels, each in the folder that was named.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cross/crossing_case.h"
#include "cross/inputs.h"
#include "cross/rendering.h"
#include "edit/command_lines.h"
#include "edit/document.h"
#include "output/metadata.h"
#include "output/write.h"
#include "support/printing.h"
#include "support/run_program.h"

namespace astrosplat::test {
namespace {

namespace fs = std::filesystem;

/// Relative paths of all files below a folder.
std::set<std::string> files_below(const fs::path& folder) {
    std::set<std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.insert(entry.path().lexically_relative(folder).string());
    return files;
}

class ProgramCrossings : public Crossings {
  protected:
    ProgramCrossings() : before(files_below(outside.path())) {}

    /// On the machine that the crossing has.
    RunResult run(std::vector<std::string> words, const fs::path& working_directory) const {
        const Machine machine = machine_of(crossing);
        words.insert(words.begin(), ASTROSPLAT_PROGRAM);
        words.insert(words.end(), {"--threads", std::to_string(machine.threads), "-q"});
        RunOptions options;
        options.folder = working_directory;
        options.environment = {"ASTROSPLAT_VECTOR_TARGET=" + machine.target,
                               "ASTROSPLAT_CACHE=" + shared_sets().folder.string()};
        return run_program(words, options);
    }

    /// Every frame's file in the scene's folder, absolute.
    std::vector<std::string> frame_files() const {
        std::vector<std::string> files;
        for (const std::int64_t number : frames_of(crossing))
            for (const Eye each : eyes_of(crossing))
                files.push_back((folder / file_of_frame(crossing, number, each)).string());
        return files;
    }

    /// What has come since the scene was written is exactly the frames.
    void expect_only_frames() const {
        std::set<std::string> expected = before;
        for (const std::string& file : frame_files())
            expected.insert(fs::path(file).lexically_relative(outside.path()).string());
        EXPECT_EQ(files_below(outside.path()), expected);
    }

    std::set<std::string> before;
};

std::vector<std::string> texts_of(const std::vector<std::string>& files) {
    std::vector<std::string> texts;
    for (const std::string& file : files) texts.push_back(text_of(file));
    return texts;
}

TEST_P(ProgramCrossings, BatchVerifyAndTheWindowMakeTheSameFiles) {
    const RunResult batch = expect_success(run({"--batch", "scene.toml"}, folder));
    expect_only_frames();
    const FrameHeader header = read_frame_header(folder / file_of_frame(crossing, crossing_frame, eye()));
    EXPECT_EQ(header.pixel_hash, pixel_hash(shot_of(scene, frame(), eye()).frame.beauty));
    EXPECT_EQ(header.frame_hash, hash_of(scene, crossing_frame, eye()));

    std::vector<std::string> words = {"verify", (folder / "scene.toml").string()};
    const std::vector<std::string> files = frame_files(), made = texts_of(files);
    words.insert(words.end(), files.begin(), files.end());
    expect_success(run(words, "/"));

    // A job of the window has a copy of the scene in a folder of its own.
    const TempFolder job;
    const RenderTask task =
        make_render_task(Document::open(folder / "scene.toml"), RenderKind::range, frame());
    ASSERT_EQ(render_problem(task, scene.camera), "");
    const fs::path copy =
        job.file("scene.toml", Document::open(folder / "scene.toml").text_for(job / "scene.toml"));
    words = {"--batch", copy.string()};
    for (const std::string& word : batch_arguments(task)) words.push_back(word);
    const auto written = fs::last_write_time(files.front());
    expect_success(run(words, "/"));
    EXPECT_EQ(fs::last_write_time(files.front()), written) << "the frames are there already";
    for (const std::string& file : files) fs::remove(file);
    expect_success(run(words, "/"));
    expect_only_frames();
    EXPECT_EQ(texts_of(files) == made, true) << "byte for byte";
}

TEST_P(ProgramCrossings, OutputOfTheCommandLineLiesInTheWorkingDirectory) {
    const fs::path elsewhere = outside / ("b " + folder_name(crossing));
    fs::create_directories(elsewhere);
    expect_success(run({"--batch", (folder / "scene.toml").string(), "-f", std::to_string(crossing_frame),
                        "-o", "out.exr", "--set", "output.depth=half"},
                       elsewhere));
    EXPECT_EQ(files_below(elsewhere), std::set<std::string>{"out.exr"});
    EXPECT_EQ(read_frame_header(elsewhere / "out.exr").pixel_hash,
              pixel_hash(shot_of(scene, frame(), scene.camera.eye).frame.beauty));
}

TEST_P(ProgramCrossings, AMovieIsMadeOfTheFramesThatBatchMakes) {
    if (run_program({"/bin/sh", "-c", "command -v ffmpeg ffprobe"}).code != 0)
        GTEST_SKIP() << "ffmpeg is not installed";
    if (crossing.ending != Ending::movie) return;
    const RenderTask task =
        make_render_task(Document::open(folder / "scene.toml"), RenderKind::movie, frame());
    ASSERT_EQ(render_problem(task, scene.camera), "");
    std::vector<std::string> words = {"--batch", (folder / "scene.toml").string()};
    for (const std::string& word : batch_arguments(task)) words.push_back(word);
    expect_success(run(words, "/"));
    const fs::path movie = render_target(task);
    const std::set<std::string> frames = files_below(movie_folder(movie));
    ASSERT_EQ(frames.size(), frames_of(crossing).size());
    const FrameHeader header = read_frame_header(movie_folder(movie) / *frames.begin());
    EXPECT_EQ(header.pixel_hash, pixel_hash(shot_of(scene, frame(), scene.camera.eye).frame.beauty));

    std::vector<std::string> writing = movie_command(movie, 24.0);
    writing.insert(writing.begin(), "/usr/bin/env");
    expect_success(run_program(writing));
    const RunResult probed = run_program(
        {"/usr/bin/env", "ffprobe", "-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
         "stream=width,height,nb_read_frames", "-of", "csv=p=0", movie.string()});
    EXPECT_EQ(probed.out, fmt::format("{},{},{}\n", crossing_width, crossing_height, frames.size()))
        << probed.err;
}

/// Pairs of the factors that names and files depend on.
std::vector<std::uint32_t> seeds_of_names() {
    std::vector<FeaturePair> wanted;
    const auto starts = [](int feature, const std::vector<std::string>& factors) {
        const std::string& name = feature_names()[static_cast<std::size_t>(feature)];
        return std::ranges::any_of(factors, [&](const std::string& f) { return name.starts_with(f + " "); });
    };
    for (const FeaturePair& pair : possible_pairs())
        if (starts(pair.first, {"folder", "token", "seen"}) && starts(pair.second, {"token_in_folder"}))
            wanted.push_back(pair);
    return covering_seeds(wanted, pool);
}

INSTANTIATE_TEST_SUITE_P(Runs, ProgramCrossings, testing::ValuesIn(seeds_or_one(seeds_of_names)), seed_name);
INSTANTIATE_TEST_SUITE_P(NightlyRuns, ProgramCrossings, testing::Range(pool, pool + 60u), seed_name);

}  // namespace
}  // namespace astrosplat::test
