// Background work on a layer's own picture: its preparation, before and after, and the likeness of the view
// from the front. In: a layer's source; a scene as it stands and its sets. Out: pictures for the screen and
// measures for the badge.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "fidelity/front.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "splats/splat_set.h"
#include "viewer/background_work.h"

namespace astrosplat {

/// A scene whose view from the front is compared with its picture.
struct FrontRequest {
    Scene scene;                                        // as it stands, without animation
    std::vector<std::shared_ptr<const SplatSet>> sets;  // one a layer; null: the layer is not drawn
    std::uint64_t files = 0;                            // another number: files were changed
    bool operator==(const FrontRequest&) const = default;
};

/// `now` without what no front view depends on: camera, sky, size and exposure of the output.
FrontRequest front_request(Scene now, std::vector<std::shared_ptr<const SplatSet>> sets, std::uint64_t files);

/// A visible layer has a picture that the front view can be compared with.
bool has_front_picture(const Scene& now);
/// A visible layer's look or render settings are not the default ones, which show a picture as it is. Level
/// of detail does not count.
bool front_changed_by_look(const Scene& now);

struct FrontFound {
    FrontFidelity fidelity;
    Image difference;   // display values, RGBA (fidelity/display.h)
    std::string error;  // one line: there is nothing to compare with
};

using FrontCheck = LatestWork<FrontRequest, FrontFound>;
/// Views are at most so wide; pictures that are smaller are compared at their own size. Prepared ones are
/// kept in the cache.
FrontCheck::Work front_check(std::int64_t width_px = 1280, const SetCache& cache = {});

/// A picture to be prepared.
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

using PreparePreview = LatestWork<PrepareRequest, PreparedView>;
PreparePreview::Work prepare_preview(std::int64_t most_px = 800);

}  // namespace astrosplat
