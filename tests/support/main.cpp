// The main of every test program. Tests share their process, so each must leave it as it found it: the one
// that changes the environment, the locale, the working directory or a resource limit fails. A crash or a
// test that takes longer than the limit names the test; skipped tests are named too; a program without tests
// fails. Temporary files lie in a folder of the process, so that none stay, not even of one that was killed.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <clocale>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <locale>
#include <map>

#include "core/log.h"
#include "core/parallel.h"

namespace {

namespace fs = std::filesystem;

constexpr unsigned time_limit_s = 900;  // of one test; only a hang comes near it

std::array<char, 512> current_test;  // "Suite.Name\n", for the signal handler

/// For the temporary files of this process and of the programs it starts: $TMPDIR leads there. What is left
/// of processes that ended without removing theirs goes first.
class OwnTemporaryFolder {
  public:
    OwnTemporaryFolder() {
        const fs::path place = fs::temp_directory_path();
        for (const fs::directory_entry& entry : fs::directory_iterator(place))
            if (is_left_behind(entry.path().filename().string())) remove(entry.path());
        folder_ = place / (begin + std::to_string(getpid()));
        fs::create_directories(folder_);
        setenv("TMPDIR", folder_.c_str(), 1);
    }
    ~OwnTemporaryFolder() { remove(folder_); }
    OwnTemporaryFolder(const OwnTemporaryFolder&) = delete;
    OwnTemporaryFolder& operator=(const OwnTemporaryFolder&) = delete;

  private:
    static bool is_left_behind(const std::string& name) {
        if (!name.starts_with(begin)) return false;
        const pid_t process = std::atoi(name.c_str() + begin.size());
        return process > 0 && kill(process, 0) != 0 && errno == ESRCH;
    }
    static void remove(const fs::path& folder) {
        std::error_code ignored;  // another user's stays
        fs::remove_all(folder, ignored);
    }

    inline static const std::string begin = "astrosplat-tests-";
    fs::path folder_;
};

/// State of a process that all of its tests share, by name.
std::map<std::string, std::string> process_state() {
    std::map<std::string, std::string> state;
    for (char** entry = environ; *entry; ++entry) {
        const std::string variable = *entry;
        const std::size_t equals = variable.find('=');
        state["environment variable " + variable.substr(0, equals)] = variable.substr(equals + 1);
    }
    state["C locale"] = std::setlocale(LC_ALL, nullptr);
    state["C++ locale"] = std::locale().name();
    std::error_code gone;
    state["working directory"] = fs::current_path(gone).string();
    for (const auto& [name, which] : {std::pair("file size limit", RLIMIT_FSIZE),
                                      {"memory limit", RLIMIT_AS},
                                      {"open files limit", RLIMIT_NOFILE}}) {
        rlimit limit = {};
        getrlimit(which, &limit);
        state[name] = std::to_string(limit.rlim_cur);
    }
    return state;
}

class SharedProcess : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo& test) override {
        const std::string name = std::string(test.test_suite_name()) + "." + test.name() + "\n";
        current_test.fill('\0');
        std::copy_n(name.begin(), std::min(name.size(), current_test.size() - 1), current_test.begin());
        before_ = process_state();
        alarm(time_limit_s);
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        alarm(0);
        if (test.result()->Skipped()) std::cout << "[  SKIPPED ] " << current_test.data() << std::flush;
        astrosplat::set_thread_count(0);
        astrosplat::set_log_sink(nullptr);
        const auto after = process_state();
        for (const auto& [what, value] : after) {
            const auto found = before_.find(what);
            const std::string before = found == before_.end() ? "" : found->second;
            EXPECT_EQ(value, before) << "the test leaves another " << what << " behind";
        }
        for (const auto& [what, value] : before_)
            EXPECT_TRUE(after.count(what)) << "the test leaves no " << what << " behind; it was " << value;
    }

    std::map<std::string, std::string> before_;
};

std::map<int, struct sigaction> handlers_before;  // a sanitizer's, or none

void name_the_test(int signal) {
    const auto write_text = [](const char* text) {
        if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
    };
    write_text(signal == SIGALRM ? "\n[  FAILED  ] took too long: " : "\n[  FAILED  ] crashed: ");
    write_text(current_test.data());
    sigaction(signal, &handlers_before.at(signal),
              nullptr);  // a crash happens again on return, and is reported there
    if (signal == SIGALRM) raise(signal);
}

void watch(int signal) {
    struct sigaction action = {};
    action.sa_handler = name_the_test;
    sigaction(signal, &action, &handlers_before[signal]);
}

/// A parameter that GoogleTest can only show as bytes makes names that cannot be read, and that differ
/// between runs.
bool parameters_are_printable() {
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    for (int i = 0; i < all.total_test_suite_count(); ++i)
        for (int k = 0; k < all.GetTestSuite(i)->total_test_count(); ++k) {
            const testing::TestInfo& test = *all.GetTestSuite(i)->GetTestInfo(k);
            if (!test.value_param() || !std::strstr(test.value_param(), "-byte object <")) continue;
            std::cerr << test.test_suite_name() << "." << test.name() << ": give its parameter a PrintTo\n";
            return false;
        }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    if (testing::UnitTest::GetInstance()->total_test_count() == 0) {
        std::cerr << argv[0] << ": no tests\n";
        return 1;
    }
    if (!parameters_are_printable()) return 1;
    const OwnTemporaryFolder temporary;
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) watch(signal);
    testing::UnitTest::GetInstance()->listeners().Append(new SharedProcess);
    return RUN_ALL_TESTS();
}
