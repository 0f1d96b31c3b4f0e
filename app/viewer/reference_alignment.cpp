#include "viewer/reference_alignment.h"

#include <utility>

namespace astrosplat {
namespace {

/// Mean of the three channels, mirrored left to right where asked for.
Image grey_of(const Image& rgba, bool mirrored) {
    Image grey = make_image(rgba.width, rgba.height, 1);
    for (std::int64_t y = 0; y < rgba.height; ++y)
        for (std::int64_t x = 0; x < rgba.width; ++x) {
            const float* const p = rgba.at(mirrored ? rgba.width - 1 - x : x, y);
            *grey.at(x, y) = (p[0] + p[1] + p[2]) / 3.0f;
        }
    return grey;
}

}  // namespace

AlignmentFound align_reference(const AlignmentRequest& request, const Progress& progress) {
    const Image& picture = request.picture;
    const FrameOnScreen& frame = request.frame;
    ReferenceParams placed = request.reference;
    const PicturePlace now = place_of(placed, double(picture.width) / double(picture.height), frame);
    const double px_of_scale = frame.height / static_cast<double>(picture.height);
    const PictureOnPicture start{now.corner + 0.5 * (now.right + now.down), placed.scale * px_of_scale,
                                 placed.rotate};
    const std::optional<Registration> found =
        registered(grey_of(request.view, false), grey_of(picture, placed.mirrored), start, progress);
    if (!found) return {};
    const glm::dvec2 heights = (found->place.middle - frame.middle) / frame.height;
    placed.position = {heights.x, -heights.y};
    placed.scale = found->place.scale / px_of_scale;
    placed.rotate = found->place.turn_deg;
    return {rounded_place(placed), found->likeness, {}};
}

void ReferenceAlignment::begin(AlignmentRequest request) {
    request.number = ++begun_;
    request_ = std::move(request);
    taken_ = false;
    work_.want(*request_);
}

std::shared_ptr<const AlignmentFound> ReferenceAlignment::take() {
    if (taken_) return nullptr;
    std::shared_ptr<const AlignmentFound> found = work_.found(*request_);
    taken_ = found != nullptr;
    return found;
}

}  // namespace astrosplat
