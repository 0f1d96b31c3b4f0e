#include "fidelity/display.h"

#include "core/color.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

float displayed_mean(const float* p) {
    return (display_srgb(p[0]) + display_srgb(p[1]) + display_srgb(p[2])) / 3.0f;
}

constexpr std::int64_t most_compared_pixels = 500'000;

// The cube root with its tangent below (6/29)^3, CIE 15.
double lab_curve(double t) {
    constexpr double knee = 6.0 / 29.0;
    return t > knee * knee * knee ? real::pow(t, 1.0 / 3.0) : t / (3.0 * knee * knee) + 4.0 / 29.0;
}

double seventh_power(double x) { return x * x * x * x * x * x * x; }

// sqrt(C^7 / (C^7 + 25^7)): how far a colour is from grey, for two of the formula's terms.
double chroma_weight(double chroma) {
    const double c7 = seventh_power(chroma);
    return std::sqrt(c7 / (c7 + seventh_power(25.0)));
}

double hue_deg(double a, double b) {
    const double h = real::degrees(real::atan2(b, a));
    return h < 0.0 ? h + 360.0 : h;
}

double cos_deg(double degrees) { return real::cos(real::radians(degrees)); }

double length(double x, double y) { return std::sqrt(x * x + y * y); }

// h' of the second minus that of the first, the shorter way round; equations 8 to 10.
double hue_step_deg(double h1, double h2, bool grey) {
    if (grey) return 0.0;
    const double step = h2 - h1;
    return step > 180.0 ? step - 360.0 : step < -180.0 ? step + 360.0 : step;
}

double mean_hue_deg(double h1, double h2, bool grey) {  // equation 14
    if (grey) return h1 + h2;
    if (std::fabs(h1 - h2) <= 180.0) return 0.5 * (h1 + h2);
    return h1 + h2 < 360.0 ? 0.5 * (h1 + h2 + 360.0) : 0.5 * (h1 + h2 - 360.0);
}

}  // namespace

Image display_colors(const Image& linear) {
    return made_by_pixel(linear, 3, [](const float* in, float* out) {
        for (int c = 0; c < 3; ++c) out[c] = display_srgb(in[c]);
    });
}

Image display_mean(const Image& linear) {
    return made_by_pixel(linear, 1, [](const float* in, float* out) { *out = displayed_mean(in); });
}

Image display_max(const Image& linear) {
    return made_by_pixel(linear, 1, [](const float* in, float* out) {
        *out = display_srgb(std::max({in[0], in[1], in[2]}));
    });
}

Image inner_colors(const Image& linear, std::int64_t margin_px) {
    const std::int64_t margin = std::min({margin_px, (linear.width - 1) / 2, (linear.height - 1) / 2});
    Image inner = make_image(linear.width - 2 * margin, linear.height - 2 * margin, 3);
    for (std::int64_t y = 0; y < inner.height; ++y)
        for (std::int64_t x = 0; x < inner.width; ++x)
            std::copy_n(linear.at(x + margin, y + margin), 3, inner.at(x, y));
    return inner;
}

Image signed_difference(const Image& a, const Image& b) {
    constexpr float none[3] = {18, 18, 22}, more[3] = {255, 150, 40}, less[3] = {70, 160, 255};
    Image shown = make_image(a.width, a.height, 4, 1.0f);
    parallel_each(a.width * a.height, 1 << 14, [&](std::int64_t i) {
        const float difference = displayed_mean(a.pixels.data() + i * a.channels) -
                                 displayed_mean(b.pixels.data() + i * b.channels);
        const float t = std::min(1.0f, std::fabs(difference) / float(full_difference));
        const float* const full = difference > 0.0f ? more : less;
        for (int c = 0; c < 3; ++c) shown.pixels[4 * i + c] = (none[c] + (full[c] - none[c]) * t) / 255.0f;
    });
    return shown;
}

Lab lab_of_linear(const float* rgb) {
    double c[3];
    for (int i = 0; i < 3; ++i) c[i] = rgb[i] > 0.0f ? std::min(1.0, double(rgb[i])) : 0.0;
    // IEC 61966-2-1, each row over its sum, so that white is (1, 1, 1).
    const double x = lab_curve((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
    const double y = lab_curve(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
    const double z = lab_curve((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.0890);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double ciede2000(const Lab& first, const Lab& second) {
    const double mean_chroma = 0.5 * (length(first.a, first.b) + length(second.a, second.b));
    const double stretch = 1.0 + 0.5 * (1.0 - chroma_weight(mean_chroma));  // 1 + G
    const double a1 = stretch * first.a, a2 = stretch * second.a;
    const double c1 = length(a1, first.b), c2 = length(a2, second.b);
    const double h1 = hue_deg(a1, first.b), h2 = hue_deg(a2, second.b);
    const bool grey = c1 * c2 == 0.0;

    const double lightness_step = second.L - first.L, chroma_step = c2 - c1;
    const double hue_step =
        2.0 * std::sqrt(c1 * c2) * real::sin(real::radians(0.5 * hue_step_deg(h1, h2, grey)));

    const double L = 0.5 * (first.L + second.L), C = 0.5 * (c1 + c2), h = mean_hue_deg(h1, h2, grey);
    const double T = 1.0 - 0.17 * cos_deg(h - 30.0) + 0.24 * cos_deg(2.0 * h) +
                     0.32 * cos_deg(3.0 * h + 6.0) - 0.20 * cos_deg(4.0 * h - 63.0);
    const double off_50 = (L - 50.0) * (L - 50.0), off_blue = (h - 275.0) / 25.0;
    const double l = lightness_step / (1.0 + 0.015 * off_50 / std::sqrt(20.0 + off_50));
    const double c = chroma_step / (1.0 + 0.045 * C);
    const double q = hue_step / (1.0 + 0.015 * C * T);
    const double rotation =
        -2.0 * chroma_weight(C) * real::sin(real::radians(60.0 * real::exp(-off_blue * off_blue)));
    return std::sqrt(std::max(0.0, l * l + c * c + q * q + rotation * c * q));
}

ColorDifferences color_differences(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height && a.channels >= 3 && b.channels >= 3);
    std::int64_t step = 1;
    while ((a.width / step) * (a.height / step) > most_compared_pixels) ++step;
    const std::int64_t columns = (a.width + step - 1) / step, rows = (a.height + step - 1) / step;
    std::vector<double> differences(std::size_t(columns * rows));
    parallel_each(rows, 8, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < columns; ++x)
            differences[y * columns + x] =
                ciede2000(lab_of_linear(a.at(x * step, y * step)), lab_of_linear(b.at(x * step, y * step)));
    });
    return {percentile(differences, 0.5), percentile(differences, 0.95)};
}

}  // namespace astrosplat
