// A frame file as it looks, small, read in the background. In: a file. Out: an image for the screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/image.h"
#include "viewer/latest_work.h"

namespace astrosplat {

struct FinishedView {
    Image image;        // display values, RGBA, opaque
    std::string error;  // one line: it cannot be read
};

/// Its longer side is at most `most_px`. Linear light gets the screen's curve. Throws InputError.
FinishedView finished_view(const std::filesystem::path& file, std::int64_t most_px);

class FinishedFrames : public LatestWork<std::filesystem::path, FinishedView> {
  public:
    explicit FinishedFrames(std::int64_t most_px = 720);
};

}  // namespace astrosplat
