// Ways out of the window: files, movies, jobs, a farm.

#include "edit/command_lines.h"
#include "gui/parts.h"
#include "gui/widgets.h"
#include "output/metadata.h"
#include "source/texture.h"
#include "window/window_test.h"

namespace astrosplat::test {
namespace {

// Files from the window: what it shows, one frame, and a range that is cancelled.

class WindowWaysOut : public WindowTest {
  protected:
    /// In the open dialog, and begins.
    void name_files(const std::string& name, const std::string& button = "render/Render") {
        person->double_click(same_widgets().at("render/name"));
        person->press("ctrl+a");
        person->type(name);
        person->click(same_widgets().at(button));
        same_widgets().click(button);
        same_widgets().take_commands();
    }
    /// As the open dialog has it.
    void render() {
        person->press("Return");
        same_widgets().tap(key_code::enter);
        same_widgets().take_commands();
    }
    /// In the queue, until Escape.
    void look_at_movie(const fs::path& movie) {
        const Pixels before = settled_frame();
        same_widgets().status.jobs = {running_job_of("", 1.0f)};
        QueuedJob& job = same_widgets().status.jobs[0];
        job.state = QueuedJob::State::done;
        job.is_movie = true;
        job.target = movie;
        same_widgets().frame();
        choose("Render/Queue...");
        click_when_shown("queue/Play movie");
        const auto changes = [&] {
            const Pixels now = frame_pixels();
            return comes_true([&] { return frame_pixels() != now; });
        };
        EXPECT_TRUE(changes() && changes() && changes() && changes()) << "it plays on";
        person->press("Escape");
        same_widgets().tap(key_code::escape);
        same_widgets().view.movie.clear();
        expect_settled(before);
    }
    /// Where the program finds it; false where ffmpeg is not installed.
    bool link_ffmpeg() const {
        const RunResult found = run_program({"/bin/sh", "-c", "command -v ffprobe && command -v ffmpeg"});
        if (found.code != 0) return false;
        const std::string ffmpeg = found.out.substr(found.out.find('\n') + 1);
        fs::create_directories(folder / "no programs");
        fs::create_symlink(ffmpeg.substr(0, ffmpeg.size() - 1), folder / "no programs/ffmpeg");
        return true;
    }
    bool comes(const fs::path& file) const {
        return comes_true([&] { return fs::exists(folder / file); });
    }
    /// ffprobe's figures of a movie: "width,height,frames", and its rate.
    std::string facts_of(const fs::path& movie) const {
        const std::string show =
            "ffprobe -v error -count_frames -select_streams v -of csv=p=0 -show_entries ";
        return run_program(
                   {"/bin/sh", "-c",
                    show + "stream=width,height,r_frame_rate,nb_read_frames " + shell_word(movie.string())})
            .out;
    }
};

/// A picture file of the window, as the screen has it.
Pixels load_pixels(const fs::path& file) {
    const Image image = load_raw_image(file);
    Pixels pixels{int(image.width), int(image.height), {}};
    for (std::int64_t i = 0; i < image.width * image.height; ++i) {
        std::uint32_t rgb = 0;
        for (int c = 0; c < 3; ++c)
            rgb = rgb << 8 |
                  std::uint32_t(std::lround(255.0f * image.pixels[std::size_t(i * image.channels + c)]));
        pixels.rgb.push_back(rgb);
    }
    return pixels;
}

TEST_F(WindowWaysOut, AScreenshotIsTheWindow) {
    start_settled();
    person->move({width - 2.0f, height - 2.0f});
    Pixels shown = screen->pixels({0, 0, width, height});
    person->press("F12");
    person->press("ctrl+a");
    person->type("window.png");
    person->press("Return");
    ASSERT_TRUE(comes("window.png"));
    Pixels saved = load_pixels(folder / "window.png");
    ASSERT_EQ(saved.width, width);
    ASSERT_EQ(saved.height, height);
    const Rect status = layout().status;  // memory, messages
    for (Pixels* pixels : {&shown, &saved}) pixels->rgb.resize(std::size_t(status.y) * std::size_t(width));
    EXPECT_EQ(saved, shown);
}

TEST_F(WindowWaysOut, AFrameIsRendered) {
    const Pixels before = start_settled();
    choose("Render/Frame...");
    name_files("frame.png");
    ASSERT_TRUE(comes("frames/frame.png"));
    const ImageInfo info = read_image_info(folder / "frames/frame.png");
    EXPECT_EQ(info.width, 320);
    EXPECT_EQ(info.height, 180);
    expect_success(run({"--batch", scene_file.string(), "-f", "1", "-o", "batch.png", "--no-cache"}));
    EXPECT_EQ(text_of(folder / "frames/frame.png"), text_of(folder / "batch.png"));
    expect_settled(before);
}

/// The splats of the scene as it stands, merged to fewer, and a layer's own.
TEST_F(WindowWaysOut, SplatsAreExported) {
    start_settled();
    choose("File/Export splats...");
    person->click(same_widgets().at("render/most"));
    same_widgets().click("render/most");
    person->press("ctrl+a");
    person->type("200");
    name_files("cloud.spz", "render/Export");
    ASSERT_TRUE(comes("frames/cloud.spz")) << program->err_so_far();
    EXPECT_NE(run({"info", "frames/cloud.spz"}).out.find("200"), std::string::npos);
    EXPECT_TRUE(comes_true([&] { return names_in(folder / "tmp").empty(); })) << "the job's folder stays";
    expect_success(run({"export", scene_file.string(), "-o", "own.spz", "--count", "200", "--no-cache"}));
    EXPECT_EQ(text_of(folder / "own.spz"), text_of(folder / "frames/cloud.spz"));
}

TEST_F(WindowWaysOut, ACancelledRangeLeavesWholeFilesOnly) {
    replace_in_scene("1-24", "1-9000");
    start_settled();
    choose("Render/Frames...");
    render();
    ASSERT_TRUE(comes_true([&] { return names_in(folder / "frames").size() > 2; }));
    person->drag(same_widgets().at("frame in view"), {60.0f, 0.0f});  // usable meanwhile
    same_widgets().status.jobs.push_back(running_job_of("Rendering", 0.1f));
    same_widgets().frame();
    choose("Render/Cancel");
    EXPECT_TRUE(comes_true([&] { return names_in(folder / "tmp").empty(); })) << "the job's folder stays";
    const std::set<std::string> files = names_in(folder / "frames");
    EXPECT_LT(files.size(), 9000u);
    for (const std::string& file : files) {
        EXPECT_EQ(file.size(), std::string("shot.0001.png").size()) << file;
        const Image image = load_linear_image(folder / "frames" / file);
        EXPECT_EQ(image.width, 320) << file;
    }
    EXPECT_TRUE(running());
}

/// Frames that are finished and still the scene's are kept, others are rendered again.
TEST_F(WindowWaysOut, ARangeGoesOnWhereItEnded) {
    replace_in_scene("1-24", "1-3");
    expect_success(run({"--batch", scene_file.string(), "--no-cache"}));
    const fs::path frames = folder / "frames", kept = frames / "shot.0002.png";
    const std::string whole = text_of(kept);
    fs::remove(frames / "shot.0001.png");
    expect_success(run({"--batch", scene_file.string(), "-f", "3", "--set", "output.exposure=2",
                        "--overwrite", "--no-cache"}));
    const std::string other = text_of(frames / "shot.0003.png");
    const fs::file_time_type long_ago = fs::last_write_time(kept) - std::chrono::hours(1);
    fs::last_write_time(kept, long_ago);
    start_settled();
    choose("Render/Frames...");
    render();
    EXPECT_TRUE(comes_true([&] {
        return fs::exists(frames / "shot.0001.png") && text_of(frames / "shot.0003.png") != other &&
               names_in(folder / "tmp").empty();
    }));
    EXPECT_EQ(fs::last_write_time(kept), long_ago);
    EXPECT_EQ(text_of(kept), whole);
}

/// Sizes odd and even: H.264 wants even ones.
TEST_F(WindowWaysOut, AMovieHasTheScenesFramesAndSpeed) {
    if (!link_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
    const std::string untouched = text_of(scene_file);
    for (const auto& [size, facts] :
         {std::pair{"[320, 180]", "320,180,24/1,24\n"}, {"[161, 91]", "162,92,24/1,24\n"}}) {
        write_text(scene_file, untouched);
        replace_in_scene("[320, 180]", size);
        start_settled();
        same_widgets().status.has_ffmpeg = true;
        same_widgets().frame();
        choose("Render/Movie...");
        name_files("a film [1].mp4");
        const fs::path movie = folder / "frames/a film [1].mp4";
        ASSERT_TRUE(comes_true([&] { return fs::exists(movie) && names_in(folder / "frames").size() == 1; }))
            << program->err_so_far();
        EXPECT_EQ(facts_of(movie), facts);
        look_at_movie(movie);
        fs::remove(movie);
        end(SIGTERM);
    }
}

/// From an empty window to a film of a picture, without a mouse.
TEST_F(WindowWaysOut, ByKeysAloneToAMovie) {
    if (!link_ffmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
    start_settled();
    const auto find = [&](const std::string& words) {
        person->press("ctrl+k");
        person->type(words);
        person->press("Return");
    };
    person->press("alt");  // File > New > Empty scene
    person->press("Return");
    person->press("Return");
    const auto keyframes = [&] { return count_of(pixels_of(&Layout::timeline), color::attention); };
    EXPECT_TRUE(comes_true([&] { return keyframes() == 0; })) << "nothing is left";
    expect_title("Untitled");
    const Pixels no_layer = pixels_of(&Layout::panel);
    person->press("ctrl+o");
    person->type("rings.png");
    person->press("Return");
    EXPECT_TRUE(comes_true([&] { return pixels_of(&Layout::panel) != no_layer; })) << "once it was looked at";
    settled_frame();
    person->press("Tab");  // what it was taken for; the last of its buttons is for the film
    person->press("shift+Tab");
    person->press("space");
    EXPECT_TRUE(comes_true([&] { return keyframes() > 0; })) << "the film is made";
    find("output.exposure");
    person->press("Return");
    person->type("0.5");
    person->press("Return");
    expect_title("Untitled - edited");
    person->press("ctrl+s");
    person->press("ctrl+a");
    person->type("film.toml");
    person->press("Return");
    expect_title("film.toml");
    const Scene scene = load_scene(folder / "film.toml");
    EXPECT_EQ(scene.output.exposure, 0.5f);
    EXPECT_FALSE(scene.animation.empty());

    same_widgets().status.has_ffmpeg = true;  // to know where Tab leads
    open_render_dialog(same_widgets().document, same_widgets().view, RenderKind::movie);
    same_widgets().frame(3);
    stop();  // all that follows is typed ahead
    person->press("alt+r");
    person->press_often("Down", 2);  // Frame, Frames, Movie
    person->press("Return");
    const auto tab_to = [&](const std::string& name) {
        const auto there = [&] {
            return ring_shown() && glm::distance(same_widgets().ring(), same_widgets().at(name)) < 2.0f;
        };
        for (int i = 0; i < 40 && !there(); ++i) {
            same_widgets().tap(key_code::tab);
            person->press("Tab");
        }
        EXPECT_TRUE(there()) << name;
    };
    for (const auto& [field, text] :
         {std::pair{"frames", "1-6"}, {"width", "160"}, {"height", "90"}, {"name", "walk.mp4"}}) {
        tab_to(std::string("render/") + field);
        person->press("ctrl+a");
        person->type(text);
    }
    tab_to("render/Render");
    person->press("Return");
    go_on();
    const fs::path movie = folder / "frames/walk.mp4";
    ASSERT_TRUE(comes_true([&] { return fs::exists(movie); })) << program->err_so_far();
    EXPECT_EQ(facts_of(movie), "160,90,24/1,6\n");
}

TEST_F(WindowWaysOut, JobsWaitForEachOther) {
    start_settled();
    choose("Render/Frames...");
    name_files("one.####.png");
    ASSERT_TRUE(comes("frames/one.0001.png"));
    same_widgets().status.jobs.push_back(running_job_of("", 0.1f));
    choose("Render/Frames...");
    name_files("shot.####.png", "render/Add to the queue");  // the last one is kept
    ASSERT_TRUE(comes("frames/shot.0024.png"));
    EXPECT_EQ(names_in(folder / "frames").size(), 48u) << "the first was whole before the second began";
}

TEST_F(WindowWaysOut, TheFrameAsSeenIsSaved) {
    const Pixels seen = start_settled();
    choose("File/Save the frame as seen...");
    same_widgets().frame(2);
    person->press("ctrl+a");
    person->type("seen.png");
    person->press("Return");
    ASSERT_TRUE(comes("seen.png"));
    const Pixels saved = load_pixels(folder / "seen.png");
    const Rect port = layout().viewport;
    EXPECT_NEAR(float(saved.width) / float(saved.height), 320.0f / 180.0f, 0.01f);
    EXPECT_LE(saved.width, int(port.width) + 1);
    std::set<std::uint32_t> colors(saved.rgb.begin(), saved.rgb.end()),
        on_screen(seen.rgb.begin(), seen.rgb.end());
    EXPECT_GT(colors.size(), 100u);
    std::size_t known = 0;
    for (const std::uint32_t color : colors) known += on_screen.count(color);
    EXPECT_GT(known * 10, colors.size() * 9) << "its pixels are the screen's";
}

/// As pasted, from another folder.
TEST_F(WindowWaysOut, TheCommandOfTheDialogWorksInAShell) {
    const Document document = Document::open(scene_file);
    RenderTask task = make_render_task(document, RenderKind::range, 1.0);
    task.frames = "1-2";
    task.folder = folder / "it's $HOME `here`";
    const BatchCommand command = render_command(document, task, ASTROSPLAT_PROGRAM);
    RunOptions elsewhere = options();
    elsewhere.folder = "/";
    const RunResult result = run_program({"/bin/sh", "-c", command.text}, elsewhere);
    ASSERT_EQ(result.code, 0) << command.text << "\n" << result.err;
    EXPECT_EQ(names_in(task.folder), (std::set<std::string>{"shot.0001.png", "shot.0002.png"}));
}

// A farm in the window's queue. Slurm's tools are stand-ins, which keep what they were called with; the
// program that is asked to submit and to tell how it goes is the real one.

class WindowFarm : public WindowTest {
  protected:
    void SetUp() override {
        WindowTest::SetUp();
        tool("sbatch", R"sh(here=${0%/*}; n=1; [ -e "$here/jobs" ] && n=$(( $(<"$here/jobs") + 1 ))
echo $n > "$here/jobs"; echo "$@" >> "$here/submitted"
while read -r line; do [[ $line == "#SBATCH --job-name="* ]] && name=${line#*=}; done < "${@: -1}"
task=N/A; [[ ${@: -1} == frames.sh ]] && task=0
echo "$n $task PENDING $name" >> "$here/queue"; echo $n
)sh");
        tool("squeue", "[ -e \"${0%/*}/queue\" ] && echo \"$(<\"${0%/*}/queue\")\"; exit 0\n");
        tool("scancel", "echo \"$@\" >> \"${0%/*}/cancelled\"; : > \"${0%/*}/queue\"\n");
        replace_in_scene("1-24", "1-3");
    }
    /// Where the program finds it.
    void tool(const std::string& name, const std::string& script) {
        fs::create_directories(folder / "no programs");
        write_text(folder / "no programs" / name, "#!/bin/bash\n" + script);
        fs::permissions(folder / "no programs" / name, fs::perms::owner_all);
    }
    std::string logged(const std::string& file) const {
        const fs::path path = folder / "no programs" / file;
        return fs::exists(path) ? text_of(path) : "";
    }
    /// By the render dialog, with another exposure than the saved scene has.
    void submit() {
        start({scene_file.string()});
        settled_frame();
        same_widgets().status.has_slurm = true;
        same_widgets().frame();
        choose("Render/Frames...");
        for (const char* button : {"render/Slurm", "render/Submit"}) {
            const glm::vec2 at = same_widgets().at(button);
            same_widgets().click(at);
            person->click(at);
        }
        same_widgets().take_commands();
        ASSERT_TRUE(comes_true([&] { return logged("jobs") == "2\n"; })) << program->err_so_far();
    }
    /// Renders what was submitted as a node of the farm would, and empties the queue.
    void work() {
        const fs::path script = folder / "frames/slurm/0001/frames.sh";
        ASSERT_TRUE(comes_true([&] { return fs::exists(script.parent_path() / "submission.json"); }));
        expect_success(
            run_program({"/bin/bash", script.string()}, {.environment = {"SLURM_ARRAY_TASK_ID=0"}}));
        write_text(folder / "no programs/queue", "");
    }
    /// The queue's dialog with the job in this state.
    void open_queue(QueuedJob::State state, std::vector<fs::path> files) {
        QueuedJob job = running_job_of("", 0.0f);
        job.state = state;
        job.files = std::move(files);
        same_widgets().status.jobs = {job};
        same_widgets().frame();
        choose("Render/Queue...");
    }
};

TEST_F(WindowFarm, FramesAreSubmittedAndComeBack) {
    submit();
    EXPECT_HAS(logged("submitted"), "--dependency=afterok:1 frames.sh\n");
    work();
    EXPECT_EQ(names_in("frames"),
              (std::set<std::string>{"shot.0001.png", "shot.0002.png", "shot.0003.png", "slurm"}));
    expect_success(run({"--batch", scene_file.string(), "-q", "-f", "2", "-o", "here.png", "--no-cache"}));
    EXPECT_EQ(text_of(folder / "frames/shot.0002.png"), text_of(folder / "here.png"));
    open_queue(QueuedJob::State::done, {"a", "b", "c"});
    click_when_shown("queue/play");  // there is none before frames are
}

TEST_F(WindowFarm, CancelTakesTheTasksOutOfTheQueue) {
    submit();
    open_queue(QueuedJob::State::submitted, {});
    click_when_shown("queue/end 1");
    EXPECT_TRUE(comes_true([&] { return logged("cancelled") == "2 1\n"; })) << logged("cancelled");
    EXPECT_TRUE(running());
}

/// Where it can be cancelled; and what has come back meanwhile is there to be looked at.
TEST_F(WindowFarm, WhatWasSubmittedIsListedByTheNextWindow) {
    submit();
    const fs::path record = folder / "frames/slurm/0001/submission.json";
    ASSERT_TRUE(comes_true([&] { return fs::exists(record); }));
    const auto again = [&] {
        person->press("ctrl+q");
        EXPECT_EQ(end().code, 0);
        start({scene_file.string()});
    };
    again();
    open_queue(QueuedJob::State::submitted, {});
    click_when_shown("queue/end 1");
    EXPECT_TRUE(comes_true([&] { return logged("cancelled") == "1 2\n"; })) << logged("cancelled");
    work();
    person->press("Escape");
    same_widgets().tap(key_code::escape);
    again();
    open_queue(QueuedJob::State::done, {"a", "b", "c"});
    click_when_shown("queue/play");
    EXPECT_EQ(logged("jobs"), "2\n") << "nothing is submitted again";
}

TEST_F(WindowFarm, WhatWasSubmittedOutlivesTheWindow) {
    submit();
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder / "frames/slurm/0001/submission.json"); }));
    person->press("ctrl+q");
    EXPECT_EQ(end().code, 0);
    EXPECT_EQ(logged("cancelled"), "");
    work();
    EXPECT_TRUE(fs::exists(folder / "frames/shot.0003.png"));
}

}  // namespace
}  // namespace astrosplat::test
