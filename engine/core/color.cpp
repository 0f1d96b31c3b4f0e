// IEC 61966-2-1 with the engine's own pow.
#include "core/color.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "core/real.h"

namespace astrosplat::real {

double srgb_to_linear(double encoded) {
    if (encoded < 0.0) return -srgb_to_linear(-encoded);
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
    if (linear < 0.0) return -linear_to_srgb(-linear);
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace astrosplat::real

namespace astrosplat {
namespace {

constexpr int table_steps = 4096;

// The power part of the sRGB curve over s = sqrt(x), where it is so smooth that straight lines between 4097
// points are within 1e-7 of it; a pow for each of six million channels would take longer than the rest of
// the encoding.
std::array<float, table_steps + 2> make_srgb_table() {
    std::array<float, table_steps + 2> table{};
    for (int i = 0; i <= table_steps + 1; ++i) {
        const double s = static_cast<double>(i) / table_steps;
        table[static_cast<std::size_t>(i)] = static_cast<float>(1.055 * real::pow(s, 2.0 / 2.4) - 0.055);
    }
    return table;
}

}  // namespace

float display_srgb(float linear) {
    static const std::array<float, table_steps + 2> table = make_srgb_table();
    const float x = linear > 0.0f ? (linear < 1.0f ? linear : 1.0f) : 0.0f;
    if (x <= 0.0031308f) return x * 12.92f;
    const float at = std::sqrt(x) * static_cast<float>(table_steps);
    const float below = std::floor(at);
    const auto i = static_cast<std::size_t>(below);
    return table[i] + (table[i + 1] - table[i]) * (at - below);
}

}  // namespace astrosplat
