#include "fidelity/signed_difference.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/parallel.h"

namespace astrosplat {
namespace {

float displayed_mean(const float* p) {
    return (display_srgb(p[0]) + display_srgb(p[1]) + display_srgb(p[2])) / 3.0f;
}

}  // namespace

Image signed_difference(const Image& a, const Image& b) {
    constexpr float none[3] = {18, 18, 22}, more[3] = {255, 150, 40}, less[3] = {70, 160, 255};
    Image shown = make_image(a.width, a.height, 4, 1.0f);
    parallel_chunks(a.height, 16, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t y = begin; y < end; ++y)
            for (std::int64_t x = 0; x < a.width; ++x) {
                const float difference = displayed_mean(a.at(x, y)) - displayed_mean(b.at(x, y));
                const float t = std::min(1.0f, std::fabs(difference) / static_cast<float>(full_difference));
                const float* const full = difference > 0.0f ? more : less;
                for (int c = 0; c < 3; ++c) shown.at(x, y)[c] = (none[c] + (full[c] - none[c]) * t) / 255.0f;
            }
    });
    return shown;
}

}  // namespace astrosplat
