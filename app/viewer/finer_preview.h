// At rest, until the final frame comes: the same view with more dots, step by step, drawn beside the window.
// In: what the preview was cut from. Out: images.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/image.h"
#include "render/environment.h"
#include "render/frame.h"
#include "viewer/cpu_preview.h"
#include "viewer/latest_work.h"
#include "viewer/preview_dots.h"

namespace astrosplat {

struct FinerRequest {
    std::uint64_t number = 0;  // another one is another request
    std::vector<RenderLayer> layers;
    std::vector<CutSource> sources;  // of each layer
    Camera camera;
    std::shared_ptr<const Environment> environment;  // null: none
    CutSettings cut;
    float pixel_filter = 0.5f;
    bool operator==(const FinerRequest& other) const { return number == other.number; }
};

struct FinerFound {
    Image image;             // RGBA, linear
    std::int64_t shown = 0;  // dots
    double seconds = 0.0;
    std::string error;
};

/// Steps before a final frame, and how long each may take, s.
struct StepPlan {
    int count = 0;
    double most_s = 0.0;
};
/// For a final frame that is expected to take so long; below 0: not known. A quick one is not held up by more
/// than the rest that comes before it anyway.
StepPlan plan_steps(double final_s);

/// The share of the splats that step 1, 2 .. draws; 0: there is no such step.
double share_of_step(int step);

/// Dots of a step that are worth drawing after `shown` of `total` splats took `seconds`, within most_s; 0:
/// none are. No limit where most_s is 0.
std::int64_t dots_of_step(int step, std::int64_t total, std::int64_t shown, double seconds, double most_s);

class FinerPreview : public LatestWork<FinerRequest, FinerFound> {
  public:
    FinerPreview();
};

}  // namespace astrosplat
