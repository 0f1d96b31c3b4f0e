#include "viewer/finished_frames.h"

#include <algorithm>
#include <vector>

#include "output/encode.h"
#include "viewer/small_picture.h"

namespace astrosplat {

FinishedView finished_view(const FinishedRequest& request, std::int64_t most_px) {
    SmallPicture small = read_small_picture(request.file, most_px);
    FinishedView view{std::move(small.image), {}};
    if (small.light) {
        FrameFormat format;
        format.kind = FrameKind::png;
        format.depth = OutputParams::Depth::uint8;
        format.alpha = OutputParams::Alpha::none;
        format.view = request.view;
        format.exposure = request.exposure;
        format.ocio = request.ocio;
        const std::vector<std::uint8_t> codes = encode_8bit(format, view.image, 0, 0);
        for (std::size_t i = 0; i < codes.size(); ++i)
            view.image.pixels[i / 3 * 4 + i % 3] = static_cast<float>(codes[i]) * (1.0f / 255.0f);
    }
    for (float& value : view.image.pixels) value = std::clamp(value, 0.0f, 1.0f);
    return view;
}

FinishedFrames::FinishedFrames(std::int64_t most_px)
    : LatestWork([most_px](const FinishedRequest& request, const Progress&) {
          return finished_view(request, most_px);
      }) {}

}  // namespace astrosplat
