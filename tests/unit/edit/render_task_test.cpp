// Renderings from the window as words of --batch and of ffmpeg.
#include "edit/command_lines.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace astrosplat {
namespace {

RenderTask task_of(RenderKind kind, const std::string& name) {
    RenderTask task;
    task.kind = kind;
    task.frames = "1-24";
    task.width = 320;
    task.height = 180;
    task.folder = "/films/[one]*";
    task.name = name;
    return task;
}

bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

TEST(RenderTask, SaysWhyItCannotBeRendered) {
    const RenderTask good = task_of(RenderKind::range, "a.####.exr");
    EXPECT_EQ(render_problem(good, {}), "");
    const auto with = [&](auto change) {
        RenderTask task = good;
        change(task);
        return render_problem(task, {});
    };
    EXPECT_NE(with([](RenderTask& t) { t.width = 0; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.height = 65537; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.folder = "relative"; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = ""; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = "b/a.####.exr"; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = "a.####.mp4"; }), "");
    EXPECT_NE(with([](RenderTask& t) { t.name = "a.exr"; }), "") << "24 frames in one file";
    EXPECT_NE(with([](RenderTask& t) { t.frames = "9-"; }), "");
    EXPECT_EQ(with([](RenderTask& t) { t.frames = "9", t.name = "a.exr"; }), "");
    EXPECT_EQ(render_problem(task_of(RenderKind::movie, "a.mkv"), {}), "");
    EXPECT_NE(render_problem(task_of(RenderKind::movie, "a.exr"), {}), "");
}

TEST(RenderTask, KeepsReplacesOrRefusesWhatIsThere) {
    RenderTask task = task_of(RenderKind::range, "a.####.exr");
    EXPECT_TRUE(has(batch_arguments(task), "--resume") && has(batch_arguments(task), "--overwrite"));
    task.existing = ExistingFrames::replace;
    EXPECT_TRUE(!has(batch_arguments(task), "--resume") && has(batch_arguments(task), "--overwrite"));
    task.existing = ExistingFrames::refuse;
    EXPECT_TRUE(!has(batch_arguments(task), "--resume") && !has(batch_arguments(task), "--overwrite"));
    EXPECT_TRUE(has(batch_arguments(task), "--output=/films/[one]*/a.####.exr"));
}

TEST(RenderTask, AJobTakesNoMoreThanTheWindow) {
    const RenderTask task = task_of(RenderKind::range, "a.####.exr");
    std::vector<std::string> words = batch_arguments(task);
    EXPECT_EQ(batch_arguments(task, limits_with(Settings(), 0)), words) << "the settings say nothing";
    words.insert(words.end(), {"--threads=4", "--memory=8"});
    EXPECT_EQ(batch_arguments(task, limits_with({.threads = 4, .memory_gib = 8}, 0)), words);
    EXPECT_EQ(batch_arguments(task, limits_with({.threads = 2, .memory_gib = 8}, 4)), words) << "--threads 4";
}

TEST(RenderTask, AMoviesFramesLieBesideIt) {
    const RenderTask task = task_of(RenderKind::movie, "a.mp4");
    EXPECT_EQ(render_files(task), "/films/[one]*/a.mp4.frames/frame.######.png");
    const std::vector<std::string> words = movie_command(render_target(task), 23.976);
    EXPECT_TRUE(has(words, "/films/\\[one\\]\\*/a.mp4.frames/frame.*.png")) << "a pattern of ffmpeg";
    EXPECT_TRUE(has(words, "23.976"));
    EXPECT_EQ(words.back(), "/films/[one]*/a.mp4");
    EXPECT_TRUE(has(batch_arguments(task), "output.aovs=[]")) << "which PNG files cannot hold";
    EXPECT_FALSE(has(batch_arguments(task_of(RenderKind::range, "a.####.exr")), "output.aovs=[]"));
}

TEST(RenderTask, PlacesMayStandInTheNamesOfFolders) {
    const std::string text = "astrosplat = 1\n[output]\nframes = \"1-2\"\npath = \"%V/take.####/shot.exr\"\n";
    const Document document = Document::untitled(text, "/films/scene.toml");
    EXPECT_EQ(render_problem(make_render_task(document, RenderKind::range, 1.0), {}), "");
    const RenderTask movie = make_render_task(document, RenderKind::movie, 1.0);
    EXPECT_EQ(render_target(movie).parent_path(), std::filesystem::current_path());
    EXPECT_EQ(movie.name, "shot.mp4");
}

/// What --batch would refuse is refused before it becomes a job.
TEST(RenderTask, AMovieIsOneFileWhateverItsFramesAreCalled) {
    for (const char* name : {"a.####.mp4", "a.%04d.mp4", "a{frame:04}.mp4", "%V.mp4", "a.%v.mp4"})
        EXPECT_NE(render_problem(task_of(RenderKind::movie, name), {}), "") << name;
    for (const std::string pattern : {"frame.####.exr", "frame.%04d.exr", "{frame:04}.exr", "%V.####.exr"}) {
        const Document document =
            Document::untitled("astrosplat = 1\n[output]\npath = \"" + pattern + "\"\n", "/films/scene.toml");
        const RenderTask movie = make_render_task(document, RenderKind::movie, 1.0);
        EXPECT_EQ(movie.name, "frame.mp4") << pattern;
        EXPECT_EQ(render_problem(movie, {}), "") << pattern;
        EXPECT_EQ(render_problem(make_render_task(document, RenderKind::range, 1.0), {}), "") << pattern;
    }
}

TEST(RenderTask, PairsNeedACameraWithTwoEyes) {
    CameraParams camera;
    const RenderTask pairs = task_of(RenderKind::range, "a.%v.####.exr");
    EXPECT_EQ(render_problem(pairs, camera), "");
    camera.projection = Projection::fisheye;
    EXPECT_NE(render_problem(pairs, camera), "");
    EXPECT_EQ(render_problem(task_of(RenderKind::movie, "a.mp4"), camera), "");
}

TEST(RenderTask, AnotherEndingKeepsTheName) {
    EXPECT_EQ(with_ending("a.b.####.exr", ".png"), "a.b.####.png");
}

TEST(RenderTask, AFarmGetsChunksAndKeepsWhatIsFinished) {
    RenderTask task = task_of(RenderKind::range, "a.####.exr");
    EXPECT_FALSE(renders_by_slurm(task));
    task.by_slurm = true;
    task.existing = ExistingFrames::replace;
    task.chunk = 25;
    std::vector<std::string> words = frame_arguments(task);
    words.insert(words.end(), {"--chunk=25", "--overwrite"});
    EXPECT_EQ(submit_arguments(task), words);
    task.partition = "long,short";
    EXPECT_EQ(submit_arguments(task)[4], "--partition=long,short");
    for (const std::int64_t chunk : {0, 1'000'001}) {
        task.chunk = chunk;
        EXPECT_NE(render_problem(task, {}), "") << chunk;
    }
    task.kind = RenderKind::movie;
    EXPECT_FALSE(renders_by_slurm(task)) << "a movie is written here";
}

}  // namespace
}  // namespace astrosplat
