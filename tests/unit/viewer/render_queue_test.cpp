// Jobs that fail in the window's queue, and what becomes of those behind them. The program is a stand-in;
// tests/window has the real one.
#include "viewer/render_queue.h"

#include "gl/gl_fixture.h"
#include "source/write_image.h"
#include "support/run_program.h"
#include "support/test.h"
#include "viewer/movie_player.h"

namespace astrosplat {
namespace {

class QueueTest : public testing::Test {
  protected:
    using State = QueuedJob::State;
    /// A program that does this for every job, in the folder "here".
    RenderQueue queue(const std::string& script) {
        const fs::path program = folder / "program";
        test::write_text(program, "#!/bin/sh\ncd '" + folder.path().string() + "'\n" + script);
        fs::permissions(program, fs::perms::owner_all);
        return RenderQueue(SetCache{}, program.string());
    }
    RenderTask task(RenderKind kind = RenderKind::range) const {
        RenderTask task = make_render_task(document, kind, 1.0);
        task.frames = "1-4";
        task.folder = folder.path();
        return task;
    }
    template <class Done>
    bool comes(RenderQueue& jobs, const Done& done) {
        for (int i = 0; i < 2000 && !done(); ++i) {
            if (const auto news = jobs.poll(now_ += 0.005)) news_.push_back(*news);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return done();
    }
    bool becomes(RenderQueue& jobs, std::size_t index, State state) {
        return comes(jobs, [&] { return jobs.jobs()[index].state == state; });
    }

    const TempFolder folder;
    const Document document =
        Document::untitled("astrosplat = 1\n[output]\npath = \"a.####.png\"\n", folder / "scene.toml");
    std::vector<Message> news_;

  private:
    double now_ = 0.0;
};

const std::string no_space = "frame 2: a.0002.png: cannot be written: No space left on device";

// The stand-in would go on for a minute.
TEST_F(QueueTest, AFailedFrameSaysWhyAtOnceAndStopsTheQueue) {
    RenderQueue jobs = queue(
        "echo run >> runs; echo saved a.0001.png 0.1s\n"
        "[ -e space ] && exit 0\n"
        "echo 'astrosplat: error: " +
        no_space +
        "'\n"
        "echo saved a.0003.png 0.1s\nexec sleep 60\n");
    jobs.add(task(), document);
    jobs.add(task(), document);
    ASSERT_TRUE(becomes(jobs, 0, State::failed));
    EXPECT_EQ(jobs.jobs()[0].text, no_space);
    ASSERT_EQ(news_.size(), 1u);
    EXPECT_EQ(news_[0].text, no_space);
    EXPECT_TRUE(news_[0].error);
    EXPECT_EQ(jobs.jobs()[0].files.at(0), "a.0001.png") << "what is done stays";
    for (int i = 0; i < 20; ++i) jobs.poll(1e6 + i);
    EXPECT_EQ(jobs.jobs()[1].state, State::waiting);
    EXPECT_EQ(jobs.jobs()[1].held_by, jobs.jobs()[0].number);
    folder.file("space", "");
    jobs.retry(jobs.jobs()[0].number);
    ASSERT_TRUE(becomes(jobs, 1, State::done));
    EXPECT_EQ(jobs.jobs()[0].state, State::done);
    EXPECT_EQ(test::text_of(folder / "runs"), "run\nrun\nrun\n");
}

TEST_F(QueueTest, TheOthersGoOnWithoutWhatFailed) {
    RenderQueue jobs =
        queue("[ -e run ] && exit 0; : > run; echo 'astrosplat: error: " + no_space + "'; exit 3\n");
    jobs.add(task(), document);
    jobs.add(task(), document);
    ASSERT_TRUE(becomes(jobs, 0, State::failed));
    jobs.remove(jobs.jobs()[0].number);
    EXPECT_TRUE(becomes(jobs, 0, State::done));
}

TEST_F(QueueTest, SplatsSayHowManyTheyAreAndHowLarge) {
    RenderQueue jobs = queue(
        "echo \"$1 $3 $4 $5 $6\" > words\nprintf 0123456789 > a.ply\n"
        "echo 'astrosplat: baking 40% eta 00:00:01'\necho \"$PWD/a.ply: 12 splats; 0.00 % of the light "
        "lost\"\n");
    RenderTask splats = make_render_task(document, RenderKind::splats, 3.0);
    EXPECT_EQ(splats.name, "a.ply");
    splats.folder = folder.path();
    jobs.add(splats, document);
    ASSERT_TRUE(becomes(jobs, 0, State::done));
    const std::string file = (folder / "a.ply").string();
    EXPECT_EQ(jobs.jobs()[0].text, file + ": 12 splats; 0.00 % of the light lost, 10 B");
    EXPECT_EQ(news_.back().text, "Saved " + jobs.jobs()[0].text);
    EXPECT_EQ(test::text_of(folder / "words"), "export --progress plain --output=" + file + " --frame=3\n");
}

// Which says what it did last, not why.
TEST_F(QueueTest, AProgramThatFailsSaysItsFirstError) {
    RenderQueue jobs = queue(
        "echo 'astrosplat: error: scene.toml: camera.fov: expected an angle, found 0'\n"
        "echo 'astrosplat: error: 1 frame failed: 2'; exit 2\n");
    jobs.add(task(), document);
    ASSERT_TRUE(becomes(jobs, 0, State::failed));
    EXPECT_EQ(jobs.jobs()[0].text, "scene.toml: camera.fov: expected an angle, found 0");
}

TEST(RenderEstimateText, IsWhatTheDryRunSays) {
    const std::string frames = "frames 240: 228 to render, 12 there already",
                      time = "time about 0.40 s a frame, 00:01:36 in all",
                      files = "files about 3.1 MB a frame, 744 MB in all";
    EXPECT_EQ(estimate_text({"scene /a.toml", frames, "memory about 1 GB, threads 2", time, files}),
              "About 00:01:36 and 744 MB in all; 12 of 240 frames are there already");
    EXPECT_EQ(estimate_text({time, files}, true),
              "About 00:01:36, with 744 MB of frames until the movie is written");
    EXPECT_EQ(estimate_text({"frames 2: 2 to render, 0 there already", time}), "About 00:01:36 in all");
    EXPECT_EQ(estimate_text({"frames 2: 0 to render, 2 there already"}), "All frames are there already");
    EXPECT_EQ(estimate_text({"kept /a.mp4, which was made of these very frames"}),
              "A movie of these very frames is there already");
    EXPECT_EQ(estimate_text({}), "");
}

TEST_F(QueueTest, WhatARenderingTakesIsKnownBeforeItBegins) {
    const RenderQueue jobs = queue(
        "echo \"$@\" >> runs\n[ -e bad ] && { echo 'astrosplat: error: no'; exit 2; }\n"
        "echo 'time about 1 s a frame, 4 s in all'\n");
    RenderEstimate estimate;
    double now = 0.0;
    const auto text = [&](const RenderTask& wanted, double step) {
        do {
            estimate.want(jobs, wanted, document, now += step);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        } while (estimate.working() && now < 2000.0);
        return estimate.text();
    };
    for (int i = 0; i < 10; ++i) estimate.want(jobs, task(), document, now += 0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // a program that had begun would be there
    EXPECT_FALSE(fs::exists(folder / "runs")) << "it may still be typed";
    EXPECT_EQ(text(task(), 1.0), "About 4 s in all");
    EXPECT_HAS(test::text_of(folder / "runs"), " --dry-run\n");
    text(task(), 1.0);
    EXPECT_EQ(std::ranges::count(test::text_of(folder / "runs"), '\n'), 1) << "the same is known";
    folder.file("bad", "");
    RenderTask other = task();
    other.width = 64;
    EXPECT_EQ(text(other, 1.0), "no");
    other.width = 0;
    EXPECT_EQ(text(other, 1.0), "");
    EXPECT_EQ(std::ranges::count(test::text_of(folder / "runs"), '\n'), 2);
}

/// A film that is there, and an encoder that is a stand-in, too.
class MovieTest : public QueueTest {
  protected:
    void encoder(const std::string& script) {
        folder.file("ffmpeg", "#!/bin/sh\nfor file; do :; done\n" + script);
        fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
    }
    /// Renders nothing, as the folder of the frames is there, and says `said`.
    State end_of(ExistingFrames existing, const std::string& said = "") {
        RenderTask wanted = task(RenderKind::movie);
        wanted.existing = existing;
        RenderQueue jobs =
            queue("mkdir '" + movie_folder(render_target(wanted)).string() + "'; " + said + "\n");
        jobs.add(wanted, document);
        comes(jobs,
              [&] { return jobs.jobs()[0].state == State::done || jobs.jobs()[0].state == State::failed; });
        last = jobs.jobs()[0];
        return last.state;
    }
    std::string film() const { return test::text_of(folder / "a.mp4"); }

    const Variable path{"PATH", (folder.path().string() + ":" + std::getenv("PATH")).c_str()};
    QueuedJob last;
};

TEST_F(MovieTest, AMovieThatCannotBeWrittenSaysWhyAndLeavesTheOneThatIsThere) {
    folder.file("a.mp4", "old");
    encoder(
        "echo half > \"$file\"; echo '[mp4 @ 0x5] Error writing: No space left on device'\n"
        "echo 'Conversion failed!'; exit 1\n");
    EXPECT_EQ(end_of(ExistingFrames::replace), State::failed);
    EXPECT_EQ(last.text, "[mp4 @ 0x5] Error writing: No space left on device");
    EXPECT_EQ(film(), "old");
}

TEST_F(MovieTest, OneOfTheseFramesStays) {
    folder.file("a.mp4", "old");
    encoder("echo new > \"$file\"; : > '" + (folder / "encoded").string() + "'\n");
    EXPECT_EQ(end_of(ExistingFrames::resume, "echo 'astrosplat: kept a.mp4, which was made of these'"),
              State::done);
    EXPECT_TRUE(last.kept);
    EXPECT_FALSE(fs::exists(folder / "encoded"));
    EXPECT_EQ(film(), "old");
    EXPECT_HAS(news_.at(0).text, "Kept ");
    EXPECT_EQ(end_of(ExistingFrames::resume), State::done) << "it was another's";
    EXPECT_EQ(film(), "new\n");
    EXPECT_FALSE(fs::exists(folder / "a.mp4.frames"));
}

TEST_F(MovieTest, OneInTheWayStopsIt) {
    encoder("echo new > \"$file\"; echo came > '" + (folder / "a.mp4").string() + "'\n");
    EXPECT_EQ(end_of(ExistingFrames::refuse), State::failed) << "it came meanwhile";
    EXPECT_HAS(last.text, "a.mp4: exists already");
    EXPECT_EQ(film(), "came\n");
    EXPECT_THROW(end_of(ExistingFrames::refuse), InputError);
}

class PlayerTest : public test::GlTest {
  protected:
    /// Of so many frames, each of another red.
    fs::path film(int frames, double fps) const {
        fs::path movie = folder / "a film.mp4";
        fs::create_directory(movie_folder(movie));
        for (int i = 0; i < frames; ++i) {
            std::vector<unsigned char> rgba(4 * 64 * 32, 255);
            for (std::size_t p = 0; p < rgba.size(); p += 4)
                rgba[p] = static_cast<unsigned char>(200 - 50 * i);
            write_image(movie_folder(movie) / fmt::format("frame.{:06}.png", i), 64, 32, rgba);
        }
        test::write_text(movie_words(movie), ";FFMETADATA1\n");
        std::vector<std::string> writing = movie_command(movie, fps);
        writing.insert(writing.begin(), "/usr/bin/env");
        EXPECT_EQ(test::run_program(writing).code, 0);
        fs::rename(movie_part(movie), movie);
        return movie;
    }
    /// Red of the middle of each frame that is seen for two seconds.
    std::vector<int> seen(const fs::path& movie) {
        std::vector<int> reds;
        std::uint64_t version = player.image().version();
        for (int i = 0; i < 400; ++i) {
            player.want(movie, {100, 100});
            if (player.image().version() != std::exchange(version, player.image().version()))
                reds.push_back(player.image().found()->codes[3 * (50 * 100 + 50)]);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return reds;
    }

    const TempFolder folder;
    MoviePlayer player;
};

TEST_F(PlayerTest, PlaysAtTheMoviesRateOverAndOver) {
    if (test::run_program({"/bin/sh", "-c", "command -v ffmpeg"}).code != 0)
        GTEST_SKIP() << "ffmpeg is not installed";
    const fs::path movie = film(4, 8.0);
    const std::vector<int> reds = seen(movie);
    ASSERT_GE(reds.size(), 6u);
    EXPECT_LE(reds.size(), 26u) << "8 frames a second, and some more where the machine was busy";
    for (std::size_t i = 0; i < reds.size(); ++i) EXPECT_NEAR(reds[i], 200 - 50 * int(i % 4), 3) << i;
    EXPECT_EQ(player.image().found()->codes[3 * 50], 0) << "it is wide, and black above";
    std::this_thread::sleep_for(std::chrono::seconds(1));  // ffmpeg waits to be read
    player.want({}, {100, 100});
    EXPECT_EQ(player.image().found(), nullptr);
}

TEST_F(PlayerTest, WhatIsNoMovieIsSaid) {
    if (test::run_program({"/bin/sh", "-c", "command -v ffmpeg"}).code != 0)
        GTEST_SKIP() << "ffmpeg is not installed";
    EXPECT_THROW(seen(folder.file("a.mp4", "no movie")), OutputError);
    EXPECT_NO_THROW(seen({}));
}

}  // namespace
}  // namespace astrosplat
