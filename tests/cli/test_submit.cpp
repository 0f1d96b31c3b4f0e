// --submit slurm: scripts that any file name survives, chunks of what is missing, and both jobs or none.
// Slurm's tools are stand-ins here, which keep what they were called with; tests/slurm has real ones.
#include "scene_fixture.h"
#include "support/errors.h"

namespace astrosplat::test {
namespace {

Words split_at_nul(const std::string& text) {
    Words words;
    for (std::size_t begin = 0, end; (end = text.find('\0', begin)) != std::string::npos; begin = end + 1)
        words.push_back(text.substr(begin, end - begin));
    return words;
}

void write_program(const fs::path& file, const std::string& text) {
    fs::remove(file);
    write_text(file, "#!/bin/bash\n" + text);
    fs::permissions(file, fs::perms::owner_all);
}

class Submit : public SceneTest {
  protected:
    Submit() {
        write_program(folder / "bin/sbatch",
                      R"sh(here=${0%/*}; n=1; [ -e "$here/jobs" ] && n=$(( $(<"$here/jobs") + 1 ))
echo $n > "$here/jobs"; printf '%s\0' "$PWD" "$@" > "$here/sbatch-$n"
[ -e "$here/refuse-$n" ] && { echo "sbatch: error: invalid partition: x" >&2; echo more >&2; exit 1; }
echo "$n;cluster"
)sh");
        write_program(folder / "bin/squeue",
                      "[ -e \"${0%/*}/queue\" ] && echo \"$(<\"${0%/*}/queue\")\"; exit 0\n");
        write_program(folder / "bin/scancel", "echo \"$@\" >> \"${0%/*}/cancelled\"\n");
    }
    RunOptions with_tools() const {
        RunOptions options;
        options.folder = folder;
        options.environment = {"PATH=" + (folder / "bin").string()};
        return options;
    }
    RunResult submit(Words more = {}) const {
        return run(joined({"--submit", "slurm", "scene.toml", "-t", "1"}, more), with_tools());
    }
    /// Words of the n-th call of sbatch, behind the folder it was called in.
    Words sbatch_call(int n) const { return split_at_nul(text_of(folder / fmt::format("bin/sbatch-{}", n))); }
    std::string script(const std::string& name, int submission = 1) const {
        return text_of(folder / fmt::format("frames/slurm/{:04}/{}", submission, name));
    }
    /// Frames of the tasks.
    static std::string chunks(const std::string& script) {
        const std::size_t begin = script.find("frames=(\n") + 9;
        return script.substr(begin, script.find("\n)", begin) - begin);
    }
    void expect_nothing_submitted(const RunResult& result, const std::string& part) {
        expect_one_line(result, 2, part);
        EXPECT_FALSE(fs::exists(folder / "frames/slurm"));
    }
};

TEST_F(Submit, ADryRunPrintsBothScriptsAndDoesNothing) {
    const RunResult result =
        expect_success(submit({"--dry-run", "-f", "1-5", "--chunk", "2", "--partition", "long,short"}));
    EXPECT_EQ(chunks(result.out), "1-2\n3-4\n5");
    EXPECT_EQ(names_in("frames"), std::set<std::string>{});
    EXPECT_FALSE(fs::exists(folder / "bin/jobs"));
    for (const char* line :
         {"#!/bin/bash\n#SBATCH ", "#SBATCH --job-name=astrosplat-scene-sets\n",
          "#SBATCH --job-name=astrosplat-scene\n", "#SBATCH --array=0-2\n",
          "#SBATCH --partition=long,short\n", "#SBATCH --cpus-per-task=1\n", "#SBATCH --requeue\n",
          " --frames=1-5 --sets-only\n", " --frames=\"${frames[SLURM_ARRAY_TASK_ID]}\" --resume\n"})
        EXPECT_HAS(result.out, line) << line << result.out;
    // The estimate, and a half more.
    const std::size_t at = result.out.find("#SBATCH --mem=") + 14;
    const int mebibytes = std::stoi(result.out.substr(at));
    EXPECT_GT(mebibytes, 100);
    EXPECT_LT(mebibytes, 512);
}

TEST_F(Submit, ArraysThatSlurmDoesNotTakeAreAnsweredWithAChunkThatFits) {
    write_program(
        folder / "bin/scontrol",
        "[ \"$*\" = \"show config\" ] && printf 'MaxArraySize            = 3\\nMaxJobCount = 9\\n'\n");
    expect_nothing_submitted(
        submit({"-f", "1-10", "--chunk", "2"}),
        "--chunk: expected 4 or more, for Slurm's MaxArraySize is 3 tasks, found 2, which "
        "makes 5 tasks");
    expect_success(submit({"-f", "1-10", "--chunk", "4", "-q"}));
    EXPECT_EQ(chunks(script("frames.sh")), "1-4\n5-8\n9-10");
}

TEST_F(Submit, TheArrayWaitsForTheSets) {
    const RunResult result = expect_success(submit({"-q"}));
    EXPECT_HAS(result.out, "3 frames in 1 task submitted as job 2, which waits for the sets of job 1\n");
    const std::string place = (folder / "frames/slurm/0001").string();
    EXPECT_EQ(sbatch_call(1), (Words{place, "--parsable", "sets.sh"}));
    EXPECT_EQ(sbatch_call(2), (Words{place, "--parsable", "--dependency=afterok:1", "frames.sh"}));
    EXPECT_EQ(names_in("frames/slurm/0001"),
              (std::set<std::string>{"sets.sh", "frames.sh", "submission.json"}));
    EXPECT_EQ(names_in("frames"), std::set<std::string>{"slurm"});
}

TEST_F(Submit, CoversWhatIsMissingAndNoMore) {
    expect_success(batch({"-q", "-f", "1-12"}));
    for (const int missing : {2, 3, 4, 7, 9, 11})
        fs::remove(folder / fmt::format("frames/shot.{:04}.exr", missing));
    write_text(folder / "frames/shot.0012.exr", "");
    expect_success(submit({"-f", "1-12", "--chunk", "4"}));
    EXPECT_EQ(chunks(script("frames.sh")), "2-4,7\n9,11-12");
    // Both scripts are plain runs of the program.
    for (const char* task : {"0", "1"}) {
        expect_success(run_program({"/bin/bash", (folder / "frames/slurm/0001/frames.sh").string()},
                                   {.environment = {std::string("SLURM_ARRAY_TASK_ID=") + task}}));
    }
    expect_success(run({"status", "scene.toml", "-f", "1-12"}));
    const RunResult again = expect_success(submit({"-f", "1-12"}));
    EXPECT_EQ(again.out, "no frame is missing: nothing to submit\n");
    EXPECT_EQ(names_in("frames/slurm"), std::set<std::string>{"0001"});
}

TEST_F(Submit, FramesMissingForOneEyeComeOnce) {
    const Words pair = {"-o", "%V/shot.##.exr", "--set", "camera.eye_separation=0.5", "-f", "1-4"};
    const auto with = [&](Words more) {
        more.insert(more.end(), pair.begin(), pair.end());
        return more;
    };
    expect_success(batch(with({"-q"})));
    for (const char* missing : {"left/shot.02.exr", "right/shot.02.exr", "right/shot.04.exr"})
        fs::remove(folder / missing);
    expect_success(submit(with({})));
    EXPECT_EQ(chunks(text_of(folder / "slurm/0001/frames.sh")), "2,4")
        << "in the folder that both eyes share";
}

TEST_F(Submit, FramesOfOtherSettingsAreReplacedOnlyWhenAsked) {
    expect_success(batch({"-q", "-f", "2"}));
    const Words other = {"--set", "layer.stars.render.opacity=0.5"};
    expect_nothing_submitted(submit(other), "shot.0002.exr: holds a frame of other settings");
    expect_success(submit({other[0], other[1], "--overwrite", "--device", "cpu"}));
    EXPECT_EQ(chunks(script("frames.sh")), "1-3");
    for (const char* option : {" --overwrite ", " --device=cpu "}) {  // which set no set
        EXPECT_HAS(script("frames.sh"), option);
        EXPECT_EQ(script("sets.sh").find(option), std::string::npos);
    }
}

/// Everything that a shell may stumble over, but for what has a meaning in a pattern of frames.
const std::string odd =
    "-o d  'q' \"d\" $(touch x) `touch x` $HOME ; & | < > * ? [a] {b,c} ! ~ = ü\xff\r\n\t'";

class SubmitNames : public Submit, public testing::WithParamInterface<std::string> {};

TEST_P(SubmitNames, ArriveAsTheyAre) {
    const fs::path place = folder / GetParam();
    fs::create_directories(place);
    for (const char* name : {"stars.pda", "dust.pda"}) fs::copy(folder / name, place / name);
    fs::copy(folder / "scene.toml", place / (GetParam() + ".toml"));
    std::error_code other_disk;
    fs::create_hard_link(ASTROSPLAT_PROGRAM, place / "astrosplat", other_disk);
    if (other_disk) fs::copy(ASTROSPLAT_PROGRAM, place / "astrosplat");
    const std::string title =
        "--set=provenance.title=\"" + std::string("$(touch x) `x` 'a' # %d \\\\ ü") + "\"";
    RunOptions options = with_tools();
    options.folder = place;
    expect_success(run_program(
        {(place / "astrosplat").string(), "--submit", "slurm", "./" + GetParam() + ".toml", "--frames=-2-1",
         "--chunk=3", "-o", GetParam() + "/s.####.exr", "--resolution=50%", "--layers=dust,stars",
         "--memory=2", "--region=1,2,10,11", title, "--threads=1", "--cache", GetParam() + ".cache", "-q"},
        options));
    const fs::path frames = place / GetParam(), scripts = frames / "slurm/0001";
    EXPECT_EQ(sbatch_call(1).front(), scripts.string());
    write_program(place / "astrosplat", "printf '%s\\0' \"$PWD\" \"$@\"; echo said >&2\n");
    Words expected = {place.string(),
                      "--batch",
                      (place / "." / (GetParam() + ".toml")).string(),
                      "--output=" + (frames / "s.####.exr").string(),
                      "--resolution=50%",
                      "--layers=dust,stars",
                      "--region=1,2,10,11",
                      "--memory=2",
                      title,
                      "--threads=1",
                      "--cache=" + (place / (GetParam() + ".cache")).string()};
    const auto arrived = [&](const std::string& script, const std::string& log) {
        RunOptions task;
        task.folder = scripts;
        task.environment = {"SLURM_JOB_ID=1", "SLURM_ARRAY_JOB_ID=2", "SLURM_ARRAY_TASK_ID=1", "LC_ALL=C"};
        const RunResult run = expect_success(run_program({"/bin/bash", script}, task));
        // In names of logs Slurm replaces what follows a %: there the script writes its log.
        const bool own_log = GetParam().find_first_of("%\\") != std::string::npos;
        EXPECT_EQ(fs::exists(scripts / log), own_log);
        if (!own_log) return split_at_nul(run.out);
        const std::string text = text_of(scripts / log);
        return split_at_nul(text.substr(0, text.rfind("said\n")));
    };
    Words sets = expected, task = expected;
    sets.insert(sets.end(), {"--frames=-2-1", "--sets-only"});
    task.insert(task.end(), {"--frames=1", "--resume"});
    EXPECT_EQ(arrived("sets.sh", "1.log"), sets);
    EXPECT_EQ(arrived("frames.sh", "2_1.log"), task);
    EXPECT_EQ(text_of(scripts / "frames.sh").find("\r\n"), std::string::npos) << "which sbatch refuses";
}

INSTANTIATE_TEST_SUITE_P(Odd, SubmitNames, testing::Values("plain", odd, "100% a\\b %j %A", "'", "-n", "ä ö"),
                         [](const auto& one) { return std::to_string(one.index); });

TEST_F(Submit, WhatIsInTheQueueIsNotSubmittedAgain) {
    expect_success(submit({"-f", "1-8", "--chunk", "2"}));  // jobs 1 and 2
    write_text(folder / "bin/queue",
               "1 N/A COMPLETED astrosplat-scene-sets\n2 0 COMPLETED astrosplat-scene\n2 1 FAILED "
               "astrosplat-scene\n2 2 RUNNING astrosplat-scene\n2 3 PENDING astrosplat-scene\n"
               "2 1 RUNNING somebody-else\n");
    const RunResult second = expect_success(submit({"-f", "1-9"}));
    EXPECT_HAS(second.out, "4 frames in the queue already, as job 2\n");
    EXPECT_EQ(chunks(script("frames.sh", 2)), "1-4,9");
    const RunResult third = expect_success(submit({"-f", "5-8"}));
    EXPECT_HAS(third.out, "no frame is missing that is not in the queue: nothing to submit\n");
    const RunResult other = submit({"-f", "9", "--set", "layer.stars.render.opacity=0.5"});
    expect_one_line(other, 2, "job 2 still makes these frames with other options");
    EXPECT_EQ(submit({"-f", "1", "-o", "frames/other.#.exr", "--set", "layer.stars.render.opacity=0.5"}).code,
              0)
        << "other names are other frames";
}

TEST_F(Submit, StatusTellsTheQueue) {
    const auto status = [&](Words more) { return run(joined({"status", "scene.toml"}, more), with_tools()); };
    EXPECT_EQ(status({}).out.find("queue"), std::string::npos);
    expect_success(submit({"--chunk", "1"}));
    EXPECT_HAS(status({}).out, "\nqueue job 2, 3 tasks: over\n");
    write_text(
        folder / "bin/queue",
        "1 N/A RUNNING astrosplat-scene-sets\n2 0 PENDING astrosplat-scene\n2 1 FAILED astrosplat-scene\n"
        "2 2 PENDING astrosplat-scene\n");
    EXPECT_HAS(status({}).out,
               "\nqueue job 1, the sets: RUNNING\nqueue job 2, 3 tasks: 1 FAILED, 2 PENDING\n");
    const nlohmann::json report = nlohmann::json::parse(status({"--json"}).out);
    EXPECT_EQ(report.at("queue").at(0).at("tasks"), (nlohmann::json{{"FAILED", 1}, {"PENDING", 2}}));
    EXPECT_EQ(report.at("queue").at(0).at("sets"), "RUNNING");
    EXPECT_EQ(report.at("queue_problem"), "");
    EXPECT_EQ(report.at("submitted").at(0).at("frames"), "1-3");
    EXPECT_EQ(report.at("submitted").at(0).at("options").at(0), (folder / "scene.toml").string());
    // Other frames have no queue; a queue that cannot be asked is no fault of the frames.
    EXPECT_EQ(status({"-o", "frames/other.#.exr"}).out.find("queue"), std::string::npos);
    fs::remove(folder / "bin/squeue");
    EXPECT_HAS(status({}).out, "\nqueue unknown: squeue is not on the PATH\n");
    write_text(folder / "frames/slurm/0001/submission.json", "{");
    EXPECT_HAS(status({}).err, "is no record of a submission");
}

TEST_F(Submit, BothJobsOrNone) {
    write_text(folder / "bin/refuse-2", "");
    expect_nothing_submitted(submit({"-q"}), "sbatch: error: invalid partition: x");
    EXPECT_EQ(text_of(folder / "bin/cancelled"), "1\n");
    write_text(folder / "bin/refuse-3", "");
    expect_nothing_submitted(submit({"-q"}), "sbatch: error: invalid partition: x");
    EXPECT_EQ(text_of(folder / "bin/cancelled"), "1\n");
    fs::remove(folder / "bin/sbatch");
    expect_nothing_submitted(submit({"-q"}), "sbatch is not on the PATH");
}

TEST_F(Submit, MistakesAreOneLine) {
    expect_nothing_submitted(run({"--submit", "pbs", "scene.toml"}, with_tools()),
                             "--submit: expected slurm");
    expect_nothing_submitted(run({"--submit", "slurm"}, with_tools()), "a scene file");
    expect_nothing_submitted(submit({"--chunk", "0"}), "--chunk");
    expect_nothing_submitted(submit({"--partition", "a b"}), "--partition");
    expect_nothing_submitted(submit({"--stats", "s.json"}), "--stats");
    expect_nothing_submitted(submit({"--no-cache"}), "a cache");
    expect_nothing_submitted(submit({"--sets-only"}), "--sets-only");
    expect_nothing_submitted(batch({"--chunk", "3"}), "--submit slurm");
    expect_nothing_submitted(submit({"--layers", "gas"}), "gas");
    write_text(folder / "file", "");
    expect_one_line(submit({"-o", "file/f.#.exr"}), 4, "file");
}

TEST_F(Submit, SetsOnlyFillsTheCacheAndRendersNothing) {
    write_text(folder / "picture.ppm", small_picture());
    const auto layer = [](const std::string& name, const std::string& more) {
        return "[[layer]]\nname = \"" + name +
               "\"\n[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"picture.ppm\" } ]\n" + more;
    };
    write_text(folder / "scene.toml",
               "astrosplat = 1\n[output]\nresolution = [32, 24]\npath = \"f.##.exr\"\n" +
                   layer("columns", "voxel_size = 0.2\n") + layer("bodies", "structure.kind = \"disk\"\n"));
    const RunResult result = expect_success(batch({"--sets-only"}));
    EXPECT_EQ(result.out, "");
    EXPECT_FALSE(fs::exists(folder / "f.01.exr"));
    EXPECT_HAS(result.err, "layer columns: ");
    expect_success(batch({"-q", "-f", "1", "--stats", "stats.json"}));
    const nlohmann::json stats = json("stats.json");
    EXPECT_EQ(stats.at("layers").size(), 2u);
    for (const auto& one : stats.at("layers")) EXPECT_TRUE(one.at("cached")) << one;
    EXPECT_EQ(batch({"--sets-only"}).code, 0) << "frames that are there are no obstacle";
    write_text(folder / "file", "");
    expect_one_line(batch({"-q", "--sets-only", "--cache", "file/sets"}), 4, "file/sets");
    expect_one_line(batch({"--sets-only", "--no-cache"}), 2, "a cache");
    expect_one_line(batch({"--sets-only", "--dry-run"}), 2, "--dry-run");
}

}  // namespace
}  // namespace astrosplat::test
