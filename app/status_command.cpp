// status: every frame that --batch would render, looked at where it belongs, and counted by what was found;
// then the tasks that a farm has of them.
#include "commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "batch_plan.h"
#include "core/text.h"
#include "farm/submission.h"
#include "report.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

using Frames = std::vector<std::int64_t>;

/// Of one eye, ascending.
struct FramesFound {
    std::map<Found, Frames> frames;
    std::int64_t count = 0;

    const Frames& of(Found found) { return frames[found]; }
};
using Sequence = std::map<Eye, FramesFound>;

struct Word {
    Found found;
    const char* name;
};
constexpr std::array words = {Word{Found::same, "done"}, Word{Found::nothing, "missing"},
                              Word{Found::damaged, "damaged"}, Word{Found::other, "foreign"}};

Sequence look_at_frames(const BatchPlan& plan) {
    Sequence sequence;
    for (const FramePlan& frame : plan.frames) {
        FramesFound& found = sequence[frame.eye];
        found.frames[found_at(frame)].push_back(frame.frame);
        ++found.count;
    }
    return sequence;
}

bool is_complete(Sequence& sequence) {
    return std::ranges::all_of(
        sequence, [](auto& eye) { return std::ssize(eye.second.of(Found::same)) == eye.second.count; });
}

/// Submissions to Slurm that have tasks in the queue, and the last one; and what all of them were made of.
struct Farm {
    std::vector<Submission> submissions;
    std::vector<SubmissionState> states;
    std::string problem;
    std::vector<SubmittedFrames> submitted;
};

Farm ask_farm(const BatchPlan& plan) {
    const std::vector<Submission> all = submissions_of(plan.scene.output.path);
    const QueueState queue = ask_queue(all);
    Farm farm;
    farm.problem = queue.problem;
    farm.submitted = submitted_frames(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!queue.submissions[i].is_active() && i + 1 < all.size()) continue;
        farm.submissions.push_back(all[i]);
        farm.states.push_back(queue.submissions[i]);
    }
    return farm;
}

void print_farm(const Farm& farm) {
    if (!farm.problem.empty()) fmt::print("queue unknown: {}\n", printable(farm.problem));
    for (std::size_t i = 0; i < farm.submissions.size() && farm.problem.empty(); ++i) {
        const Submission& one = farm.submissions[i];
        const SubmissionState& state = farm.states[i];
        if (!state.sets.empty() && state.sets != "COMPLETED")
            fmt::print("queue job {}, the sets: {}\n", one.sets_job, state.sets);
        std::vector<std::string> counts;
        for (const auto& [name, count] : state.counts()) counts.push_back(fmt::format("{} {}", count, name));
        fmt::print("queue job {}, {}: {}\n", one.frames_job, counted(std::ssize(one.chunks), "task"),
                   counts.empty() ? "over" : fmt::format("{}", fmt::join(counts, ", ")));
    }
}

Report to_report(const Farm& farm) {
    Report queue = Report::array();
    for (std::size_t i = 0; i < farm.submissions.size(); ++i) {
        const Submission& one = farm.submissions[i];
        queue.push_back({{"folder", one.folder.string()},
                         {"sets_job", one.sets_job},
                         {"sets", farm.states[i].sets},
                         {"frames_job", one.frames_job},
                         {"active", farm.states[i].is_active()},
                         {"tasks", farm.states[i].counts()}});
    }
    return queue;
}

Report to_report(const std::vector<SubmittedFrames>& submitted) {
    Report all = Report::array();
    for (const SubmittedFrames& one : submitted)
        all.push_back({{"options", one.options}, {"frames", one.frames}});
    return all;
}

void print_for_people(const BatchPlan& plan, Sequence& sequence) {
    fmt::print("scene {}\n", printable(plan.scene.file.string()));
    fmt::print("frames {}\n", printable(plan.scene.output.path));
    for (auto& [eye, found] : sequence) {
        const std::string whose = sequence.size() > 1 ? fmt::format("{} ", name_of(eye)) : "";
        for (const Word& word : words) {
            const Frames& frames = found.of(word.found);
            if (frames.empty() && word.found != Found::same) continue;
            fmt::print("{}{} {}", whose, word.name, frames.size());
            if (word.found == Found::same) fmt::print(" of {}", found.count);
            if (!frames.empty()) fmt::print(": {}", frames_text(frames));
            fmt::print("\n");
        }
    }
}

void print_as_json(const BatchPlan& plan, Sequence& sequence) {
    Report eyes = Report::array();
    for (auto& [eye, found] : sequence) {
        Report one = {{"eye", name_of(eye)}, {"frames", found.count}};
        for (const Word& word : words) {
            const Frames& frames = found.of(word.found);
            one[word.name] = {{"count", frames.size()}, {"frames", frames_text(frames)}};
        }
        eyes.push_back(one);
    }
    const Farm farm = ask_farm(plan);
    print_report({{"scene", plan.scene.file.string()},
                  {"output", plan.scene.output.path},
                  {"complete", is_complete(sequence)},
                  {"eyes", eyes},
                  {"queue", to_report(farm)},
                  {"queue_problem", farm.problem},
                  {"submitted", to_report(farm.submitted)}},
                 true);
}

}  // namespace

int run_status(const StatusOptions& options) {
    const BatchPlan plan = plan_frames(options.batch);
    Sequence sequence = look_at_frames(plan);
    if (options.json) {
        print_as_json(plan, sequence);
    } else {
        print_for_people(plan, sequence);
        print_farm(ask_farm(plan));
    }
    return is_complete(sequence) ? exit_done : exit_some_failed;
}

}  // namespace astrosplat
