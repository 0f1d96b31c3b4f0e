// What a farm has made of the frames it was given, as the program's own `status --json` tells it. In: what
// that has written. Out: numbers, and a line for a person.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace astrosplat {

struct FarmReport {
    bool complete = false;  // every frame is there
    bool active = false;    // a task waits or runs, or nobody knows
    std::int64_t frames = 0, done = 0;
    std::vector<std::int64_t> done_frames;  // their numbers, ascending; of pairs those of the first eye
    std::vector<std::int64_t> jobs;         // in Slurm's queue, of submissions that are not over
    std::string text;                       // "12 of 240 done, in the queue: 3 running, 21 pending"
};

/// Nothing where it is no report.
std::optional<FarmReport> read_farm_report(const std::string& output);

/// Jobs of "30 frames in 3 tasks submitted as job 2, which waits for the sets of job 1": 2, 1. None where
/// nothing was submitted.
std::vector<std::int64_t> submitted_jobs(const std::string& output);

}  // namespace astrosplat
