#include "viewer/difference_meter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/color.h"

namespace astrosplat {
namespace {

/// Linear light of display values, from a table: 3e-7 of white off at most.
class LightTable {
  public:
    LightTable() {
        for (std::size_t i = 0; i < light_.size(); ++i)
            light_[i] = real::srgb_to_linear(std::min(1.0, double(i) / steps));
    }
    double operator()(float displayed) const {
        const double at = std::clamp(double(displayed), 0.0, 1.0) * steps;
        const auto i = static_cast<std::size_t>(at);
        return light_[i] + (light_[i + 1] - light_[i]) * (at - double(i));
    }

  private:
    static constexpr int steps = 1024;
    std::array<double, steps + 2> light_;
};

}  // namespace

std::optional<DifferenceStatus> difference_of(const Image& a, const Image& b) {
    static const LightTable light;
    double sum = 0.0, squares = 0.0, light_a = 0.0, light_b = 0.0;
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < a.width * a.height; ++i) {
        const float *const pa = a.pixels.data() + 4 * i, *const pb = b.pixels.data() + 4 * i;
        if (pb[3] < 1.0f) continue;
        for (int c = 0; c < 3; ++c) {
            const double difference = double(pa[c]) - double(pb[c]);
            sum += difference;
            squares += difference * difference;
            light_a += light(pa[c]);
            light_b += light(pb[c]);
        }
        count += 3;
    }
    if (count == 0) return std::nullopt;
    const double mean_square = squares / double(count);
    DifferenceStatus found;
    found.mean = sum / double(count);
    found.psnr_db =
        mean_square > 0.0 ? -10.0 * std::log10(mean_square) : std::numeric_limits<double>::infinity();
    found.light = light_b > 0.0   ? light_a / light_b
                  : light_a > 0.0 ? std::numeric_limits<double>::infinity()
                                  : 1.0;
    return found;
}

void DifferenceMeter::measure(Display& display, const DisplaySettings& shown, glm::ivec2 target_px,
                              double now) {
    constexpr double every_s = 0.25;
    waiting_ = !(shown == measured_ && target_px == target_px_);
    if (!waiting_ || (measured_at_ >= 0.0 && now - measured_at_ < every_s)) return;
    const Display::Compared sides = display.read_compared(shown, target_px.x, target_px.y);
    found_ = difference_of(sides.a, sides.b);
    measured_ = shown;
    target_px_ = target_px;
    measured_at_ = now;
    waiting_ = false;
}

}  // namespace astrosplat
