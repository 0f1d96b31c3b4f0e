// Messages of a run: --log-json; and the exit codes of interrupted ones.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// --log-json: what stands on stderr can be read line by line by a program.

using Event = nlohmann::json;

class LogJson : public SceneTest {
  protected:
    static std::vector<Event> events(const std::string& err) {
        std::vector<Event> events;
        std::istringstream lines(err);
        for (std::string line; std::getline(lines, line);) {
            events.push_back(Event::parse(line, nullptr, false));
            EXPECT_TRUE(events.back().is_object()) << line;
        }
        return events;
    }
    static std::vector<Event> of_kind(const std::vector<Event>& events, const std::string& kind) {
        std::vector<Event> found;
        for (const Event& event : events)
            if (event.at("event") == kind) found.push_back(event);
        return found;
    }
};

TEST_F(LogJson, ARunIsReportedEventByEvent) {
    const RunResult result = expect_success(batch({"--log-json", "-o", "a \"b\"/é.##.exr"}));
    const std::vector<Event> all = events(result.err);
    for (const Event& event : all) EXPECT_EQ(event.at("time").get<std::string>().size(), 24u) << event;
    EXPECT_FALSE(of_kind(all, "message").empty());
    const std::vector<Event> saved = of_kind(all, "saved");
    ASSERT_EQ(saved.size(), 3u);
    EXPECT_EQ(fs::path(saved[1].at("file").get<std::string>()).filename(), "é.02.exr");
    EXPECT_GE(saved[1].at("seconds").get<double>(), 0.0);
    std::vector<Event> second;
    for (const Event& event : of_kind(all, "progress"))
        if (event.contains("frame") && event.at("frame") == 2) second.push_back(event);
    ASSERT_FALSE(second.empty());
    EXPECT_EQ(second[0].at("index"), 2);
    EXPECT_EQ(second[0].at("count"), 3);
    EXPECT_EQ(second[0].at("fraction"), 0.0);
    EXPECT_NEAR(second[0].at("fraction_of_all").get<double>(), 1.0 / 3.0, 1e-9);
    EXPECT_GE(second[0].at("seconds_left_of_all").get<double>(), 0.0);
    EXPECT_FALSE(second[0].contains("seconds_left")) << "nothing of it is done yet";
}

TEST_F(LogJson, MistakesAreEvents) {
    for (const Words& wrong :
         {Words{"--batch", "no such.toml"}, {"--no-such-option"}, {"info", "no such.toml"}}) {
        Words words{"--log-json"};
        words.insert(words.end(), wrong.begin(), wrong.end());
        if (wrong[0] == "info") std::swap(words[0], words[1]);
        const RunResult result = run(words);
        EXPECT_EQ(result.code, 2) << result.err;
        const std::vector<Event> all = events(result.err);
        ASSERT_EQ(all.size(), 1u) << result.err;
        EXPECT_EQ(all[0].at("event"), "message");
        EXPECT_EQ(all[0].at("level"), "error");
        EXPECT_HAS(all[0].at("text").get<std::string>(), "no");
    }
}

TEST_F(LogJson, WithoutItNothingIsJson) {
    const RunResult result = batch();
    EXPECT_EQ(result.err.find('{'), std::string::npos) << result.err;
}

TEST_F(LogJson, QuietLeavesErrors) { EXPECT_EQ(batch({"--log-json", "-q"}).err, ""); }

// Ctrl-C and termination: the exit code says so, and every file that is there is whole.

class Interrupt : public SceneTest {
  protected:
    /// Starts a long job, sends the signal once the first frame is saved, and waits for the end.
    RunResult interrupted_run(int signal) {
        const RunningProgram program = started(
            {"--batch", "scene.toml", "-f", "1-2000", "--resolution", "640x480", "--stats", "stats.json"});
        program.wait_until_said("saved ");
        program.signal(signal);
        return program.wait();
    }
    void expect_whole_frames_only() {
        const std::set<std::string> names = names_in("frames");
        EXPECT_GE(names.size(), 1u);
        for (const std::string& name : names) {
            EXPECT_EQ(name.substr(0, 5), "shot.") << "a temporary file stayed: " << name;
            EXPECT_EQ(run({"info", "frames/" + name}).code, 0) << name;
        }
        EXPECT_EQ(json("stats.json").at("frames").size(), names.size());
    }
};

TEST_F(Interrupt, TheCodeSaysTheSignal) {
    for (const int signal : {SIGINT, SIGTERM}) {
        fs::remove_all(folder / "frames");
        const RunResult result = interrupted_run(signal);
        EXPECT_EQ(result.code, 128 + signal) << result.err;
        expect_whole_frames_only();
    }
}

// A file that holds nothing but takes long to read.
void make_hollow(const fs::path& file, off_t bytes) {
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    EXPECT_EQ(ftruncate(descriptor, bytes), 0);
    close(descriptor);
}

/// Runs the program, and sends the signal while it reads the file of this name. Without an answer where the
/// program was too fast to be caught.
std::optional<RunResult> signalled_while_reading(const std::string& name, Words words,
                                                 const RunOptions& options, int signal) {
    words.insert(words.begin(), ASTROSPLAT_PROGRAM);
    const RunningProgram program(words, options);
    while (program.running() && !program.has_open(name))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.signal(SIGSTOP);
    siginfo_t ignored = {};
    waitid(P_PID, static_cast<id_t>(program.id()), &ignored, WSTOPPED | WEXITED | WNOWAIT);
    const bool caught = program.running() && program.has_open(name);
    program.signal(signal);
    program.signal(SIGCONT);
    const RunResult result = program.wait();
    return caught ? std::optional(result) : std::nullopt;
}

TEST_F(Interrupt, HeardWhileFilesAreRead) {
    constexpr off_t large = off_t{64} << 20;
    make_hollow(folder / "map.exr", large);
    make_hollow(folder / "big.obj", large);
    write_scene("[environment]\nimage = \"map.exr\"\n");
    struct Case {
        std::string file;
        Words words;
        int signal;
    };
    for (const Case& c : {Case{"map.exr", {"--batch", "scene.toml"}, SIGINT},  // which hashes it
                          Case{"map.exr", {"--batch", "scene.toml", "--dry-run"}, SIGTERM},
                          Case{"big.obj", {"info", "big.obj"}, SIGINT}}) {
        std::optional<RunResult> result;
        while (!result) result = signalled_while_reading(c.file, c.words, {.folder = folder}, c.signal);
        expect_one_line(*result, 128 + c.signal, "stopped");
        EXPECT_FALSE(fs::exists(folder / "frames"));
    }
}

TEST_F(Interrupt, ResumeCompletesAnInterruptedRun) {
    interrupted_run(SIGINT);
    const std::set<std::string> names = names_in("frames");
    const std::string frames = fmt::format("1-{}", names.size() + 2);
    expect_success(batch({"-f", frames, "--resolution", "640x480", "--resume", "--stats", "stats.json"}));
    EXPECT_EQ(names_in("frames").size(), names.size() + 2);
    EXPECT_EQ(json("stats.json").at("frames").size(), 2u);
}

}  // namespace
}  // namespace astrosplat::test
