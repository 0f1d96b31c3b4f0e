#include "viewer/finished_frames.h"

#include <algorithm>

#include "core/color.h"
#include "core/file_format.h"
#include "core/parallel.h"
#include "image/area.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

bool holds_light(const std::filesystem::path& file) {
    const FileFormat* const format = format_by_name(file);
    return format && format->id == "openexr";
}

float shown(float value, bool light) {
    const float inside = std::clamp(value, 0.0f, 1.0f);
    return light ? static_cast<float>(real::linear_to_srgb(static_cast<double>(inside))) : inside;
}

}  // namespace

FinishedView finished_view(const std::filesystem::path& file, std::int64_t most_px) {
    Image raw = load_raw_image(file);
    const std::int64_t longer = std::max(raw.width, raw.height);
    if (longer > most_px)
        raw = reduced_by_area(raw, std::max<std::int64_t>(1, raw.width * most_px / longer),
                              std::max<std::int64_t>(1, raw.height * most_px / longer));
    const bool light = holds_light(file);
    FinishedView view;
    view.image = make_image(raw.width, raw.height, 4, 1.0f);
    parallel_for(raw.height, [&](std::int64_t y, int) {
        for (std::int64_t x = 0; x < raw.width; ++x)
            for (int c = 0; c < 3; ++c)
                view.image.at(x, y)[c] = shown(raw.at(x, y)[raw.channels < 3 ? 0 : c], light);
    });
    return view;
}

FinishedFrames::FinishedFrames(std::int64_t most_px)
    : LatestWork([most_px](const std::filesystem::path& file, const Progress&) {
          return finished_view(file, most_px);
      }) {}

}  // namespace astrosplat
