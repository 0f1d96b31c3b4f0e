// Runs a program as its users do and hands back its exit code, stdout and stderr. Own folder per test below
// the build folder, removed when the test has passed.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/standard.h"

namespace astrosplat::test {

struct RunResult {
    int code = -1;  // exit code; -signal when a signal ended it
    std::string out, err;
};

struct RunOptions {
    fs::path folder = ".";                   // working directory
    std::vector<std::string> environment{};  // NAME=VALUE, over those of the test; DISPLAY only from here
    std::vector<std::string> without{};      // names taken out of the environment
};

inline std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void write_text(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

/// A running program; its output goes to files in a private folder.
class RunningProgram {
  public:
    RunningProgram(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
        std::string pattern = (fs::temp_directory_path() / "astrosplat-run-XXXXXX").string();
        if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
        logs_ = pattern;
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 1, (logs_ / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
        posix_spawn_file_actions_addopen(&actions, 2, (logs_ / "err").c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                         0600);
        posix_spawn_file_actions_addchdir_np(&actions, options.folder.c_str());
        std::vector<std::string> words = arguments, variables = environment(options);
        std::vector<char*> argv = pointers(words), envp = pointers(variables);
        const int error = posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), envp.data());
        posix_spawn_file_actions_destroy(&actions);
        if (error) throw std::runtime_error("cannot start " + arguments[0]);
    }
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;
    ~RunningProgram() {
        std::error_code ignored;
        fs::remove_all(logs_, ignored);
    }

    void signal(int number) const { kill(process_, number); }
    std::string err_so_far() const { return text_of(logs_ / "err"); }
    /// Until stderr has this text, or the program has ended.
    void wait_until_said(const std::string& text) const {
        while (running() && err_so_far().find(text) == std::string::npos)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    pid_t id() const { return process_; }
    /// It has not ended; wait() can still tell how it did.
    bool running() const {
        siginfo_t ended = {};
        return waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               ended.si_pid == 0;
    }
    /// It has opened a file of this name.
    bool has_open(const std::string& name) const {
        const std::string descriptors = "/proc/" + std::to_string(process_) + "/fd";
        std::error_code error;
        for (fs::directory_iterator entry(descriptors, error), end; !error && entry != end;
             entry.increment(error)) {
            if (fs::read_symlink(entry->path(), error).filename() == name) return true;
            error.clear();
        }
        return false;
    }
    RunResult wait() const {
        int status = 0;
        waitpid(process_, &status, 0);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return {code, text_of(logs_ / "out"), text_of(logs_ / "err")};
    }

  private:
    static std::vector<char*> pointers(std::vector<std::string>& words) {
        std::vector<char*> result;
        for (std::string& word : words) result.push_back(word.data());
        result.push_back(nullptr);
        return result;
    }
    static std::vector<std::string> environment(const RunOptions& options) {
        std::vector<std::string> variables = options.environment;
        // A display in the developer's session would open windows, and let them wait for their user.
        std::vector<std::string> hidden = {"DISPLAY", "WAYLAND_DISPLAY"};
        hidden.insert(hidden.end(), options.without.begin(), options.without.end());
        for (const std::string& variable : options.environment)
            hidden.push_back(variable.substr(0, variable.find('=')));
        for (char** entry = environ; *entry; ++entry) {
            const std::string variable = *entry;
            const std::string name = variable.substr(0, variable.find('='));
            if (std::find(hidden.begin(), hidden.end(), name) == hidden.end()) variables.push_back(variable);
        }
        return variables;
    }

    fs::path logs_;
    pid_t process_ = -1;
};

inline RunResult run_program(const std::vector<std::string>& arguments, const RunOptions& options = {}) {
    return RunningProgram(arguments, options).wait();
}

/// Of a run that must succeed.
inline RunResult expect_success(const RunResult& result) {
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    return result;
}

/// A test with an empty folder of its own, kept for a look when the test has failed.
class FolderTest : public testing::Test {
  protected:
    FolderTest() {
        const testing::TestInfo& info = *testing::UnitTest::GetInstance()->current_test_info();
        folder = fs::path(ASTROSPLAT_BINARY_DIR) / "test-output" / info.test_suite_name() / info.name();
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    ~FolderTest() override {
        std::error_code ignored;
        if (!HasFailure()) fs::remove_all(folder, ignored);
    }

    /// Of what lies in a folder below that one; empty where there is none.
    std::set<std::string> names_in(const fs::path& place) const {
        std::set<std::string> names;
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder / place, ignored))
            names.insert(entry.path().filename().string());
        return names;
    }

    fs::path folder;
};

}  // namespace astrosplat::test
