#include "viewer/earlier_farm_jobs.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "farm/submission.h"
#include "scene/frames.h"
#include "viewer/render_job.h"

namespace astrosplat {
namespace {

/// Of the record's chunks. Throws InputError.
void add_frames(const Submission& submission, std::set<std::int64_t>& frames) {
    for (const std::string& chunk : submission.chunks)
        for (const std::int64_t frame : parse_frames(chunk, submission.folder.string())) frames.insert(frame);
}

FarmCommands commands_for(const Submission& submission, const std::string& frames) {
    FarmCommands commands;
    commands.pattern = submission.output;
    commands.status = {own_program(), "status"};
    commands.status.insert(commands.status.end(), submission.options.begin(), submission.options.end());
    commands.status.insert(commands.status.end(), {"--frames=" + frames, "--json"});
    return commands;
}

}  // namespace

std::vector<EarlierFarmJob> earlier_farm_jobs(const std::string& pattern) {
    struct Group {
        Submission first;
        std::set<std::int64_t> frames;
    };
    std::vector<Group> groups;
    for (const Submission& one : submissions_of(pattern)) {
        try {
            std::set<std::int64_t> frames;
            add_frames(one, frames);
            if (one.options.empty() || frames.empty()) continue;
            auto same =
                std::ranges::find_if(groups, [&](const Group& g) { return have_same_options(g.first, one); });
            if (same == groups.end()) same = groups.insert(groups.end(), {one, {}});
            same->frames.merge(frames);
        } catch (const InputError&) {
            continue;
        }
    }
    std::vector<EarlierFarmJob> jobs;
    for (const Group& group : groups) {
        const std::string frames = frames_text({group.frames.begin(), group.frames.end()});
        jobs.push_back({frames, commands_for(group.first, frames)});
    }
    return jobs;
}

EarlierFarmJobs::EarlierFarmJobs()
    : LatestWork([](const std::string& pattern, const Progress&) {
          return FoundFarmJobs{earlier_farm_jobs(pattern), {}};
      }) {}

}  // namespace astrosplat
