// How true the front view is to its picture, worked out in the background while the window rests. In: a scene
// as it stands and its sets. Out: measures for the badge, and the picture of where the view differs.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/worker.h"
#include "fidelity/front.h"
#include "scene/scene.h"
#include "sets/cache_folder.h"
#include "splats/splat_set.h"

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

class FrontCheck {
  public:
    /// Views are at most so wide; pictures that are smaller are compared at their own size. Prepared ones are
    /// kept in the cache.
    explicit FrontCheck(std::int64_t width_px = 1280, SetCache cache = {});
    ~FrontCheck();  // cancels and waits

    /// Begins, unless this was the last request. Returns at once.
    void want(const FrontRequest& request);
    /// Cancels what is under way; what is found stays. Returns at once.
    void cancel();
    bool working() const;
    /// Null while there is nothing, or where this was not the last request.
    std::shared_ptr<const FrontFound> found(const FrontRequest& request) const;

  private:
    Worker::Task next_task();
    void work(const FrontRequest& request, const std::shared_ptr<std::atomic<bool>>& cancelled);

    std::int64_t width_px_;
    SetCache cache_;
    FrontRequest request_;
    bool asked_ = false, pending_ = false;
    std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
    std::shared_ptr<const FrontFound> found_;
    Worker worker_{[this] { return next_task(); }};
};

}  // namespace astrosplat
