// A cluster of the test's own: munge, Slurm's controller and one node on loopback, in a temporary folder,
// which end with the test.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace astrosplat::test {

class Cluster {
  public:
    /// Starts it; problem() says why that could not be.
    Cluster();
    ~Cluster();
    Cluster(const Cluster&) = delete;
    Cluster& operator=(const Cluster&) = delete;

    /// One line; empty where the cluster runs.
    const std::string& problem() const { return problem_; }

    /// With these variables Slurm's tools find it, NAME=VALUE.
    std::string environment() const { return "SLURM_CONF=" + (folder_ / "slurm.conf").string(); }

    /// One of Slurm's tools, found as daemons are.
    RunResult tool(std::vector<std::string> words) const;

    /// Returns when no job waits or runs; false where that takes longer than any job of a test may.
    bool wait_until_idle() const;

  private:
    class Daemon;
    void write_configuration() const;
    void start(const std::string& name, std::vector<std::string> arguments);
    bool node_is_ready() const;
    std::string last_words() const;

    std::filesystem::path folder_;
    std::vector<std::unique_ptr<Daemon>> daemons_;  // ended in reverse
    std::string problem_;
};

}  // namespace astrosplat::test
