#include "fidelity_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/text.h"
#include "fidelity/display.h"
#include "fidelity_table.h"
#include "output/encode.h"
#include "source/write_image.h"

namespace astrosplat {
namespace {

constexpr double full_colour = 0.1;  // share of light that is shown in full colour

std::string png_url(const Image& size, std::span<const unsigned char> rgb) {
    return "data:image/png;base64," + base64(png_bytes(size.width, size.height, rgb));
}

Image opaque(const Image& linear) {
    Image image = make_image(linear.width, linear.height, 4, 1.0f);
    for (std::int64_t i = 0; i < linear.width * linear.height; ++i)
        std::copy_n(linear.pixels.data() + i * linear.channels, 3, image.pixels.data() + 4 * i);
    return image;
}

/// -1 .. 1: how far light that is amiss is from none to full colour.
double strength(double amiss) { return std::clamp(amiss / full_colour, -1.0, 1.0); }

constexpr double chart_width = 440, chart_height = 250, chart_left = 44, chart_top = 14, chart_bottom = 40;

double chart_x(std::size_t band, std::size_t bands) {
    return chart_left +
           (static_cast<double>(band) + 0.5) * (chart_width - chart_left - 12) / static_cast<double>(bands);
}

double chart_y(double ratio, double top) {
    return chart_top + (1.0 - std::clamp(ratio, 0.0, top) / top) * (chart_height - chart_top - chart_bottom);
}

std::string power_line(const FrontFidelity& front, std::size_t bands, double top, std::size_t number) {
    std::string points, dots;
    for (std::size_t i = 0; i < front.power.size(); ++i) {
        const ScalePower& band = front.power[i];
        if (std::isnan(band.ratio)) continue;
        const double x = chart_x(i, bands), y = chart_y(band.ratio, top);
        points += fmt::format("{:.1f},{:.1f} ", x, y);
        dots += fmt::format(
            "<circle cx='{:.1f}' cy='{:.1f}' r='3.5'><title>{:g} to {:g} px: {:.3f}</title></circle>\n", x, y,
            band.finer_px, band.coarser_px, band.ratio);
    }
    return fmt::format("<g class='line{}'><polyline points='{}'/>\n{}</g>\n", number, points, dots);
}

}  // namespace

std::string image_url(const Image& linear) {
    const FrameFormat format{FrameKind::png,
                             OutputParams::Depth::uint8,
                             OutputParams::Compression::deflate,
                             OutputParams::Alpha::none,
                             OutputParams::View::srgb,
                             OutputParams::Primaries::rec709,
                             0.0,
                             {}};
    return png_url(linear, encode_8bit(format, opaque(linear), 0, 0));
}

std::string difference_url(const Image& a, const Image& b) {
    const Image shown = signed_difference(a, b);
    std::vector<unsigned char> rgb;
    rgb.reserve(static_cast<std::size_t>(a.width * a.height * 3));
    for (std::size_t i = 0; i < shown.pixels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            rgb.push_back(static_cast<unsigned char>(shown.pixels[i + c] * 255.0f + 0.5f));
    return png_url(a, rgb);
}

std::string cell_map(const FluxRatios& flux, double aspect) {
    const double width = 10.0, height = width / aspect;
    std::string svg = fmt::format(
        "<svg class='cells' viewBox='0 0 {:g} {:g}' role='img' aria-label='light of each cell'>\n",
        width * flux_cells, height * flux_cells);
    for (std::int64_t i = 0; i < flux_cells * flux_cells; ++i) {
        const double ratio = flux.cells[static_cast<std::size_t>(i)], t = strength(ratio - 1.0);
        const std::string place = fmt::format("x='{:g}' y='{:g}' width='{:g}' height='{:g}'",
                                              width * static_cast<double>(i % flux_cells),
                                              height * static_cast<double>(i / flux_cells), width, height);
        if (std::isnan(ratio))
            svg += fmt::format("<rect class='dark' {}/>\n", place);
        else
            svg += fmt::format("<rect class='{}' opacity='{:.2f}' {}><title>{}</title></rect>\n",
                               t > 0.0 ? "more" : "less", std::fabs(t), place, percent_off(ratio));
    }
    return svg + "</svg>\n";
}

std::string power_chart(const std::vector<const FrontFidelity*>& fronts) {
    std::size_t bands = 1;
    double top = 1.25;
    for (const FrontFidelity* front : fronts) {
        bands = std::max(bands, front->power.size());
        for (const ScalePower& band : front->power) top = std::max(top, std::min(2.0, 1.05 * band.ratio));
    }
    std::string svg =
        fmt::format("<svg class='power' viewBox='0 0 {:g} {:g}' role='img' aria-label='power by scale'>\n",
                    chart_width, chart_height);
    for (double ratio = 0.0; ratio <= top; ratio += 0.25) {
        const double y = chart_y(ratio, top);
        svg += fmt::format("<line class='{}' x1='{:g}' x2='{:g}' y1='{:.1f}' y2='{:.1f}'/>\n",
                           ratio == 1.0 ? "one" : "grid", chart_left, chart_width - 12, y, y);
        svg += fmt::format("<text x='{:g}' y='{:.1f}' text-anchor='end'>{:g}</text>\n", chart_left - 8, y + 4,
                           ratio);
    }
    for (std::size_t i = 0; i < bands; ++i)
        svg += fmt::format("<text x='{:.1f}' y='{:g}' text-anchor='middle'>{:g}</text>\n", chart_x(i, bands),
                           chart_height - chart_bottom + 18,
                           i == 0 ? 0.5 : std::ldexp(0.75, static_cast<int>(i)));
    svg += fmt::format("<text x='{:g}' y='{:g}' text-anchor='middle'>size of the detail, px</text>\n",
                       0.5 * (chart_left + chart_width), chart_height - 4);
    for (std::size_t i = 0; i < fronts.size(); ++i) svg += power_line(*fronts[i], bands, top, i);
    return svg + "</svg>\n";
}

}  // namespace astrosplat
