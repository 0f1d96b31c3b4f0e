// The reference aligned to what the view shows, by registration in the background. In: the view's pixels, the
// reference with its picture. Out: its placement, or none where the two are not alike.
#pragma once

#include <optional>

#include "prepare/registration.h"
#include "scene/reference_place.h"
#include "viewer/latest_work.h"

namespace astrosplat {

/// What is aligned: the view's pixels, and the place of the frame among them.
struct AlignmentRequest {
    Image view, picture;  // display values, RGBA, top row first
    FrameOnScreen frame;  // px of `view`
    ReferenceParams reference;
    CameraParams camera;       // that took the view
    std::uint64_t number = 0;  // differs from request to request
    bool operator==(const AlignmentRequest& other) const { return number == other.number; }
};

struct AlignmentFound {
    std::optional<ReferenceParams> reference;  // placed; none: nothing in the view is like it
    double likeness = 0.0;
    std::string error;
};

/// Works it out here and now. Throws Cancelled.
AlignmentFound align_reference(const AlignmentRequest& request, const Progress& progress = {});

class ReferenceAlignment {
  public:
    /// In place of one that is under way.
    void begin(AlignmentRequest request);
    bool working() const { return request_ && work_.working(); }
    /// Once for each that was begun, when it is done.
    std::shared_ptr<const AlignmentFound> take();
    /// Of the last one that was begun.
    const AlignmentRequest& request() const { return *request_; }

  private:
    std::optional<AlignmentRequest> request_;
    bool taken_ = true;
    std::uint64_t begun_ = 0;
    LatestWork<AlignmentRequest, AlignmentFound> work_{align_reference};
};

}  // namespace astrosplat
