// One run of --batch in which a call fails, and what is to be true afterwards: a code and a line that say so,
// only whole and right frames, nothing else touched, and a --resume that finishes the sequence. In: which
// call, counted by fault_shim/shim.cpp. Out: complaints, empty where all is well.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace astrosplat::test {

/// The calls of shim.cpp.
struct Fault {
    std::string kind;     // "write", ...
    std::int64_t at = 0;  // from 1
    int error = 0;        // errno; take_half, end_process
    bool onward = false;  // all later calls fail too
};
inline constexpr int take_half = 0, end_process = -1;
std::string text_of(const Fault& fault);

/// The program's input, and how it is run.
struct FaultScene {
    std::string output;  // pattern
    int threads = 1;
};

/// Names, relative to a folder, and bytes of all files below it.
using Tree = std::map<std::string, std::string>;
Tree tree_of(const std::filesystem::path& folder);

class FaultRun {
  public:
    /// Writes the scene's files into a new folder, which the destructor removes unless complaints were made.
    FaultRun(const std::filesystem::path& folder, const FaultScene& scene);
    ~FaultRun();
    FaultRun(const FaultRun&) = delete;
    FaultRun& operator=(const FaultRun&) = delete;

    /// Runs --batch with more options; with the fault, where there is one. A run that takes longer than a
    /// minute is ended, code -SIGKILL.
    RunResult batch(const std::vector<std::string>& more, const std::optional<Fault>& fault = {}) const;
    RunOptions options(const std::optional<Fault>& fault = {}) const;
    std::vector<std::string> words(const std::vector<std::string>& more) const;
    /// How many calls of each kind the last run with a fault made; empty where it did not end by itself.
    std::map<std::string, std::int64_t> counts() const;
    Tree tree() const { return tree_of(folder_ / "work"); }
    std::filesystem::path work() const { return folder_ / "work"; }

    /// Complaints about a run that failed, and about what lies there now. `whole` is the tree of a run
    /// without faults.
    void check_result(const RunResult& result);
    void check_files(const Tree& whole, bool leftovers_allowed);
    /// --resume, which must finish.
    void resume(const Tree& whole, bool leftovers_allowed);
    void complain(const std::string& what) { complaints_ += "  " + what + "\n"; }
    const std::string& complaints() const { return complaints_; }

  private:
    std::filesystem::path folder_;
    FaultScene scene_;
    std::string complaints_;
};

/// The whole of it for one fault; the complaints.
std::string complaints_about(const Fault& fault, const FaultScene& scene, const Tree& whole,
                             const std::filesystem::path& folder);

}  // namespace astrosplat::test
