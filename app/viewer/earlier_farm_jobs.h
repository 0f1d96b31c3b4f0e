// What was submitted to a farm of this scene's frames before the window was opened: the records beside the
// frames tell. In: the pattern of the frames. Out: jobs for the queue.
#pragma once

#include <string>
#include <vector>

#include "viewer/farm_job.h"
#include "viewer/latest_work.h"

namespace astrosplat {

/// Submissions of the same scene with the same options count as one.
struct EarlierFarmJob {
    std::string frames;     // of all of them: "1-240"
    FarmCommands commands;  // without those that submit
};
/// In the order in which they were first submitted; one of a scene or frames that nobody can read any more is
/// left out.
std::vector<EarlierFarmJob> earlier_farm_jobs(const std::string& pattern);

struct FoundFarmJobs {
    std::vector<EarlierFarmJob> jobs;
    std::string error;
};

/// Finds them beside the window: the folder may be a network's.
class EarlierFarmJobs : public LatestWork<std::string, FoundFarmJobs> {
  public:
    EarlierFarmJobs();
};

}  // namespace astrosplat
