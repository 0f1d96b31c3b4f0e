#include "viewer/reference_picture.h"

#include <algorithm>
#include <utility>

#include "core/color.h"
#include "core/parallel.h"
#include "image/resample.h"
#include "source/texture.h"

namespace astrosplat {

ReferencePicture::Found ReferencePicture::read(const Request& request, const Progress& progress) {
    constexpr std::int64_t longest_px = 2560;
    Image image = load_linear_image(request.file, progress);
    const std::int64_t longest = std::max(image.width, image.height);
    if (longest > longest_px)
        image = reduced_by_area(image, std::max<std::int64_t>(1, image.width * longest_px / longest),
                                std::max<std::int64_t>(1, image.height * longest_px / longest));
    parallel_each(image.width * image.height, 1 << 14, [&](std::int64_t i) {
        float* const p = image.pixels.data() + 4 * i;
        for (int c = 0; c < 3; ++c) p[c] = display_srgb(p[c]);
    });
    return {std::move(image), {}};
}

void ReferencePicture::want(const std::filesystem::path& file) {
    request_.file = file;
    std::shared_ptr<const Found> found;
    if (!file.empty()) {
        work_.want(request_);
        found = work_.found(request_);
    }
    error_ = found ? found->error : "";
    if (found && !found->error.empty()) found = nullptr;
    shown_.show(found, [](const Found& read) -> const Image& { return read.picture; });
}

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
