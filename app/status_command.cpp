// status: every frame that --batch would render, looked at where it belongs, and counted by what was found.
#include "status_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "batch_plan.h"
#include "core/text.h"
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
    print_report({{"scene", plan.scene.file.string()},
                  {"output", plan.scene.output.path},
                  {"complete", is_complete(sequence)},
                  {"eyes", eyes}},
                 true);
}

}  // namespace

int run_status(const StatusOptions& options) {
    const BatchPlan plan = plan_frames(options.batch);
    Sequence sequence = look_at_frames(plan);
    if (options.json)
        print_as_json(plan, sequence);
    else
        print_for_people(plan, sequence);
    return is_complete(sequence) ? exit_done : exit_some_failed;
}

}  // namespace astrosplat
