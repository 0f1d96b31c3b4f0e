// What the records beside the frames tell a window that was not there when they were written.
#include "viewer/farm_job.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "farm/submission.h"
#include "support/temp_folder.h"
#include "viewer/render_queue.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

class EarlierFarmJobsTest : public testing::Test {
  protected:
    void submitted(const std::string& number, std::vector<std::string> options,
                   std::vector<std::string> chunks) const {
        Submission one;
        one.folder = submissions_folder(pattern) / number;
        one.name = "astrosplat-m51";
        one.output = comparable_output(pattern);
        one.options = std::move(options);
        one.sets_job = 1;
        one.frames_job = 2;
        one.chunks = std::move(chunks);
        fs::create_directories(one.folder);
        write_submission(one);
    }

    const TempFolder folder;
    const std::string pattern = (folder / "frames/m51.####.exr").string();
};

TEST_F(EarlierFarmJobsTest, SubmissionsOfTheSameAreOneJob) {
    submitted("0001", {"/a.toml", "--output=" + pattern}, {"1-10", "11-20"});
    submitted("0002", {"/b.toml"}, {"3"});
    submitted("0003", {"/a.toml", "--output=" + pattern}, {"15-25"});
    const std::vector<EarlierFarmJob> jobs = earlier_farm_jobs(pattern);
    ASSERT_EQ(jobs.size(), 2U);
    EXPECT_EQ(jobs[0].frames, "1-25");
    EXPECT_EQ(jobs[1].frames, "3");
    EXPECT_TRUE(jobs[0].commands.submit.empty());
    const std::vector<std::string> words(jobs[0].commands.status.begin() + 1, jobs[0].commands.status.end());
    EXPECT_EQ(words, (std::vector<std::string>{"status", "/a.toml", "--output=" + pattern, "--frames=1-25",
                                               "--json"}));
    EXPECT_EQ(jobs[0].commands.pattern, pattern);
}

TEST_F(EarlierFarmJobsTest, WhatCannotBeReadIsLeftOut) {
    EXPECT_TRUE(earlier_farm_jobs(pattern).empty());
    submitted("0001", {"/a.toml"}, {"nonsense"});
    submitted("0002", {}, {"1"});
    EXPECT_TRUE(earlier_farm_jobs(pattern).empty());
}

TEST_F(EarlierFarmJobsTest, AJobIsListedOnce) {
    submitted("0001", {"/a.toml"}, {"1-3"});
    submitted("0002", {"/a.toml", "--resolution=8x8"}, {"1-3"});
    RenderQueue queue{SetCache()};
    for (int i = 0; i < 2; ++i)
        for (EarlierFarmJob job : earlier_farm_jobs(pattern)) {
            job.commands.status[0] = "/bin/true";
            queue.add_earlier(job, "m51.toml");
        }
    ASSERT_EQ(queue.jobs().size(), 2U);
    EXPECT_EQ(queue.jobs()[0].title, "m51.toml: Frames 1-3, Slurm");
    EXPECT_EQ(queue.jobs()[0].state, QueuedJob::State::submitted);
}

}  // namespace
}  // namespace astrosplat
