// How true the front view is to its picture, worked out in the background while the window rests. In: a scene
// as it stands and its sets. Out: measures for the badge, and the picture of where the view differs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fidelity/front.h"
#include "scene/scene.h"
#include "sets/cache_folder.h"
#include "splats/splat_set.h"
#include "viewer/latest_work.h"

namespace astrosplat {

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
    Image difference;   // display values, RGBA (signed_difference.h)
    std::string error;  // one line: there is nothing to compare with
};

class FrontCheck : public LatestWork<FrontRequest, FrontFound> {
  public:
    /// Views are at most so wide; pictures that are smaller are compared at their own size. Prepared ones are
    /// kept in the cache.
    explicit FrontCheck(std::int64_t width_px = 1280, const SetCache& cache = {});
};

}  // namespace astrosplat
