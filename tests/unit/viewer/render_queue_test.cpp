// Jobs that fail in the window's queue, and what becomes of those behind them. The program is a stand-in;
// tests/window has the real one.
#include "viewer/render_queue.h"

#include "support/run_program.h"
#include "support/test.h"

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

// Which says what it did last, not why.
TEST_F(QueueTest, AProgramThatFailsSaysItsFirstError) {
    RenderQueue jobs = queue(
        "echo 'astrosplat: error: scene.toml: camera.fov: expected an angle, found 0'\n"
        "echo 'astrosplat: error: 1 frame failed: 2'; exit 2\n");
    jobs.add(task(), document);
    ASSERT_TRUE(becomes(jobs, 0, State::failed));
    EXPECT_EQ(jobs.jobs()[0].text, "scene.toml: camera.fov: expected an angle, found 0");
}

TEST_F(QueueTest, AMovieThatCannotBeWrittenSaysWhy) {
    folder.file("ffmpeg",
                "#!/bin/sh\necho '[mp4 @ 0x5] Error writing: No space left on device'\n"
                "echo 'Conversion failed!'; exit 1\n");
    fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
    const Variable path("PATH", (folder.path().string() + ":" + std::getenv("PATH")).c_str());
    RenderQueue jobs = queue("exit 0\n");
    jobs.add(task(RenderKind::movie), document);
    ASSERT_TRUE(becomes(jobs, 0, State::failed));
    EXPECT_EQ(jobs.jobs()[0].text, "[mp4 @ 0x5] Error writing: No space left on device");
}

}  // namespace
}  // namespace astrosplat
