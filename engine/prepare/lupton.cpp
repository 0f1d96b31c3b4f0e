// One factor a pixel for all three channels.
#include "prepare/lupton.h"

#include <algorithm>
#include <array>

#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {

void apply_lupton(Image& image, const LuptonSettings& settings) {
    const double tenth = 0.1 / real::asinh(0.1 * settings.q);
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            float* const p = image.at(x, y);
            std::array<double, 3> light;
            for (std::size_t c = 0; c < 3; ++c) light[c] = std::max(0.0, static_cast<double>(p[c]));
            const double mean = (light[0] + light[1] + light[2]) / 3.0;
            if (!(mean > 0.0)) {
                std::fill_n(p, 3, 0.0f);
                continue;
            }
            double factor = tenth * real::asinh(settings.q * mean / settings.stretch) / mean;
            factor /= std::max(1.0, factor * *std::max_element(light.begin(), light.end()));
            for (std::size_t c = 0; c < 3; ++c)
                p[c] = static_cast<float>(real::srgb_to_linear(factor * light[c]));
        }
    });
}

}  // namespace astrosplat
