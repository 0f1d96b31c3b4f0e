// Takes the place of RUN_ALL_TESTS in the work copy's test programs, in two ways. With
// ASTROSPLAT_MUTANT_TESTS it runs the tests and writes to that file, a line of JSON for each, which mutants
// the test reached and how long it took. (What is reached between tests, as by the set-up of a suite, counts
// for all tests of the suite.) Otherwise it waits for lines "MUTANT SECONDS LOG FILTER" on its input and
// answers each with the exit code of a child that ran those tests: the program is loaded once.
#include <signal.h>
#include <sys/wait.h>

#include <iostream>

#include "mutant.h"
#include "support/test.h"

namespace {

using Clock = std::chrono::steady_clock;

class ReachListener : public testing::EmptyTestEventListener {
    void OnTestIterationStart(const testing::UnitTest&, int) override {
        take_to(everywhere_);
        write("", "started", everywhere_);  // before main: a child of ours would come too late
    }
    void OnTestSuiteStart(const testing::TestSuite&) override { suite_ = everywhere_; }
    void OnTestStart(const testing::TestInfo&) override {
        take_to(suite_);
        start_ = Clock::now();
    }
    void OnTestEnd(const testing::TestInfo& info) override {
        std::set<int> reached = suite_;
        take_to(reached);
        const std::string name = std::string(info.test_suite_name()) + "." + info.name();
        write(name,
              info.result()->Skipped()  ? "skipped"
              : info.result()->Passed() ? "passed"
                                        : "failed",
              reached);
    }

    void write(const std::string& test, const char* state, const std::set<int>& reached) const {
        FILE* out = std::fopen(std::getenv("ASTROSPLAT_MUTANT_TESTS"), "a");
        if (!out) return;
        const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
        std::fprintf(out, "{\"test\": \"%s\", \"state\": \"%s\", \"seconds\": %.3f, \"reached\": [",
                     test.c_str(), state, seconds);
        const char* comma = "";
        for (const int id : reached) std::fprintf(out, "%s%d", std::exchange(comma, ", "), id);
        std::fprintf(out, "]}\n");
        std::fclose(out);
    }

    static void take_to(std::set<int>& ids) {
        for (int id = 0; id < 1 << 16; ++id) {
            if (std::exchange(astrosplat_mutant_reached[id], 0)) ids.insert(id);
        }
    }

    std::set<int> everywhere_, suite_;
    Clock::time_point start_;
};

[[noreturn]] void run_as_child(const std::string& mutant, const std::string& log, const std::string& filter) {
    setpgid(0, 0);
    if (!std::freopen(log.c_str(), "w", stdout) || dup2(1, 2) < 0 || !std::freopen("/dev/null", "r", stdin))
        _exit(99);
    setenv("ASTROSPLAT_MUTANT", mutant.c_str(), 1);  // for the programs that tests start
    astrosplat_mutant_active = std::atoi(mutant.c_str());
    testing::GTEST_FLAG(filter) = filter;
    const int code = RUN_ALL_TESTS();
    std::fflush(nullptr);
    _exit(code);  // libraries would wait for threads that only the parent has
}

/// Its exit code, or minus the signal that ended it; -9 when it took longer.
int wait_for(pid_t child, double seconds) {
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (Clock::now() > end) kill(-child, SIGKILL);
        usleep(2000);
    }
    kill(-child, SIGKILL);  // what it started
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

void serve() {
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string mutant, log, filter;
        double seconds = 0.0;
        words >> mutant >> seconds >> log >> filter;
        const pid_t child = fork();
        if (child == 0) run_as_child(mutant, log, filter);
        std::cout << wait_for(child, seconds) << std::endl;
    }
}

}  // namespace

int astrosplat_run_tests() {
    if (!std::getenv("ASTROSPLAT_MUTANT_TESTS")) {
        serve();
        return 0;
    }
    testing::UnitTest::GetInstance()->listeners().Append(new ReachListener);
    return RUN_ALL_TESTS();
}
