#include "viewer/reference_picture.h"

#include <algorithm>

#include "core/color.h"
#include "core/parallel.h"
#include "image/area.h"
#include "source/texture.h"

namespace astrosplat {

Image read_displayed(const std::filesystem::path& file, std::int64_t longest_px, const Progress& progress) {
    Image image = load_linear_image(file, progress);
    const std::int64_t longest = std::max(image.width, image.height);
    if (longest > longest_px)
        image = reduced_by_area(image, std::max<std::int64_t>(1, image.width * longest_px / longest),
                                std::max<std::int64_t>(1, image.height * longest_px / longest));
    parallel_each(image.width * image.height, 1 << 14, [&](std::int64_t i) {
        float* const p = image.pixels.data() + 4 * i;
        for (int c = 0; c < 3; ++c) p[c] = display_srgb(p[c]);
    });
    return image;
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
    if (found == shown_) return;
    shown_ = found;
    ++version_;
    if (shown_) texture_.upload(shown_->picture);
}

}  // namespace astrosplat
