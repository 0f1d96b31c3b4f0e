// status: every frame that --batch would render, looked at where it belongs, and counted by what was found;
// then the tasks that a farm has of them.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "batch_plan.h"
#include "command.h"
#include "core/text.h"
#include "device.h"
#include "exit.h"
#include "farm/submission.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

using Frames = std::vector<std::int64_t>;

using FramesFound = std::map<Found, Frames>;  // ascending
struct EyeFrames {
    FramesFound found;
    std::map<std::string, Frames> drawn_by;  // those done, by device, where that is known
};
using Sequence = std::map<Eye, EyeFrames>;

constexpr std::array words = {std::pair(Found::same, "done"), std::pair(Found::nothing, "missing"),
                              std::pair(Found::damaged, "damaged"), std::pair(Found::other, "foreign")};

Sequence look_at_frames(const BatchPlan& plan) {
    Sequence sequence;
    for (const FramePlan& frame : plan.frames) {
        EyeFrames& eye = sequence[frame.eye];
        const Found found = found_at(frame);
        eye.found[found].push_back(frame.frame);
        if (found != Found::same) continue;
        if (const std::string device = noted_device(frame.file); !device.empty())
            eye.drawn_by[device].push_back(frame.frame);
    }
    return sequence;
}

std::size_t count_of(const FramesFound& found) {
    std::size_t count = 0;
    for (const auto& [what, frames] : found) count += frames.size();
    return count;
}

bool is_complete(const Sequence& sequence) {
    return std::ranges::all_of(sequence, [](const auto& eye) {
        const FramesFound& found = eye.second.found;
        return found.size() == 1 && found.contains(Found::same);
    });
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

void print_for_people(const BatchPlan& plan, Sequence sequence) {
    fmt::print("scene {}\n", printable(plan.scene.file.string()));
    fmt::print("frames {}\n", printable(plan.scene.output.path));
    for (auto& [eye, of_eye] : sequence) {
        auto& [found, drawn_by] = of_eye;
        const std::string whose = sequence.size() > 1 ? fmt::format("{} ", name_of(eye)) : "";
        for (const auto& [what, word] : words) {
            const Frames& frames = found[what];
            if (frames.empty() && what != Found::same) continue;
            fmt::print("{}{} {}", whose, word, frames.size());
            if (what == Found::same) fmt::print(" of {}", count_of(found));
            if (!frames.empty()) fmt::print(": {}", frames_text(frames));
            fmt::print("\n");
        }
        for (const auto& [device, frames] : drawn_by)
            fmt::print("{}drawn by {}: {}\n", whose, printable(device), frames_text(frames));
    }
}

void print_as_json(const BatchPlan& plan, Sequence sequence) {
    const bool complete = is_complete(sequence);
    Report eyes = Report::array();
    for (auto& [eye, of_eye] : sequence) {
        auto& [found, drawn_by] = of_eye;
        Report one = {{"eye", name_of(eye)}, {"frames", count_of(found)}};
        for (const auto& [what, word] : words)
            one[word] = {{"count", found[what].size()}, {"frames", frames_text(found[what])}};
        for (const auto& [device, frames] : drawn_by) one["drawn_by"][device] = frames_text(frames);
        eyes.push_back(one);
    }
    const Farm farm = ask_farm(plan);
    print_report({{"scene", plan.scene.file.string()},
                  {"output", plan.scene.output.path},
                  {"complete", complete},
                  {"eyes", eyes},
                  {"queue", to_report(farm)},
                  {"queue_problem", farm.problem},
                  {"submitted", to_report(farm.submitted)}},
                 true);
}

int run_status(const CommandOptions& options) {
    const BatchPlan plan = plan_frames(options);
    const Sequence sequence = look_at_frames(plan);
    if (options.json) {
        print_as_json(plan, sequence);
    } else {
        print_for_people(plan, sequence);
        print_farm(ask_farm(plan));
    }
    return is_complete(sequence) ? exit_done : exit_some_failed;
}

}  // namespace

void add_status(CLI::App& app, Invocation& call) {
    CLI::App& command =
        add_command(app, call, "status", "Lists which frames are done, missing, damaged or of other settings",
                    run_status);
    add_input(command, call.options, "SCENE", "The scene");
    add_frame_choice(command, call.options);
    add_json(command, call.options);
}

}  // namespace astrosplat
