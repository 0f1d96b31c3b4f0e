// A frame file as it looks, small, read in the background. In: a file, and the view that scene light is seen
// through. Out: an image for the screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/image.h"
#include "scene/scene.h"
#include "viewer/latest_work.h"

namespace astrosplat {

struct FinishedView {
    Image image;        // display values, RGBA, opaque
    std::string error;  // one line: it cannot be read
};

/// How files of scene light are seen; others are as they look.
struct FinishedRequest {
    std::filesystem::path file;
    OutputParams::View view = OutputParams::View::srgb;  // never automatic
    std::shared_ptr<const DisplayTransform> ocio;        // in place of `view`; null: none
    double exposure = 0.0;                               // stops
    bool operator==(const FinishedRequest&) const = default;
};

/// Its longer side is at most `most_px`. Throws InputError.
FinishedView finished_view(const FinishedRequest& request, std::int64_t most_px);

class FinishedFrames : public LatestWork<FinishedRequest, FinishedView> {
  public:
    explicit FinishedFrames(std::int64_t most_px = 720);
};

}  // namespace astrosplat
