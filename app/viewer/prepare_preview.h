// The picture of a layer before and after its preparation, small, worked out in the background while the
// window goes on. In: a layer's source. Out: two pictures for the screen and what was done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "scene/scene.h"
#include "viewer/latest_work.h"

namespace astrosplat {

struct PrepareRequest {
    std::vector<std::filesystem::path> files;
    TextureSettings texture;
    std::uint64_t changes = 0;  // another number: files were changed
    bool operator==(const PrepareRequest&) const = default;
};

/// Empty where the layer's first mesh has no picture of the scene's own.
std::optional<PrepareRequest> prepare_request(const LayerParams& layer, std::uint64_t changes);

struct PreparedView {
    Image before, after;  // display values, RGBA, opaque, of one size
    std::vector<std::filesystem::path> files;
    std::int64_t stars = 0;  // removed from the small picture
    std::string error;       // one line: it cannot be prepared
};

/// The pictures' longer side is at most `most_px`. Throws InputError, Cancelled.
PreparedView prepared_view(const PrepareRequest& request, std::int64_t most_px, const Progress& progress);

class PreparePreview : public LatestWork<PrepareRequest, PreparedView> {
  public:
    explicit PreparePreview(std::int64_t most_px = 800);
};

}  // namespace astrosplat
