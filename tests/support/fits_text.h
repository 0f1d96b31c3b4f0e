// FITS files of 32-bit floats, made in memory for tests.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace astrosplat {

/// A card of a header.
inline std::string fits_card(const std::string& text) { return text + std::string(80 - text.size(), ' '); }

/// Cards that say how the sky lies on a picture: a tangent plane with its reference in px (from 1 at the
/// middle of the lower left pixel) and degrees, degrees a pixel, turned by `turn_deg`.
inline std::string fits_sky(double px, double py, double ra, double dec, double scale, double turn_deg) {
    const double angle = turn_deg * 3.14159265358979323846 / 180.0;
    const double c = scale * std::cos(angle), s = scale * std::sin(angle);
    std::string cards = fits_card("CTYPE1  = 'RA---TAN'") + fits_card("CTYPE2  = 'DEC--TAN'");
    const std::vector<std::pair<const char*, double>> values = {
        {"CRPIX1", px}, {"CRPIX2", py}, {"CRVAL1", ra}, {"CRVAL2", dec},
        {"CD1_1", -c},  {"CD1_2", s},   {"CD2_1", s},   {"CD2_2", c}};
    for (const auto& [key, value] : values) cards += fits_card(fmt::format("{:8}= {:20.12E}", key, value));
    return cards;
}

/// An HDU of such axes, NAXIS1 first; `cards` besides those of its size. The primary one where `first`.
inline std::string fits_hdu(const std::vector<int>& axes, const std::string& cards,
                            const std::vector<float>& values, bool first = true) {
    std::string file = fits_card(first ? "SIMPLE  =                    T" : "XTENSION= 'IMAGE   '") +
                       fits_card("BITPIX  =                  -32") +
                       fits_card(fmt::format("NAXIS   = {:20}", axes.size()));
    for (std::size_t i = 0; i < axes.size(); ++i)
        file += fits_card(fmt::format("{:8}= {:20}", fmt::format("NAXIS{}", i + 1), axes[i]));
    if (!first)
        file += fits_card("PCOUNT  =                    0") + fits_card("GCOUNT  =                    1");
    file += cards + fits_card("END");
    file.resize((file.size() + 2879) / 2880 * 2880, ' ');
    for (const float number : values) {
        std::uint32_t bits;
        std::memcpy(&bits, &number, 4);
        for (int shift = 24; shift >= 0; shift -= 8) file += char(bits >> shift & 255u);
    }
    file.resize((file.size() + 2879) / 2880 * 2880, '\0');
    return file;
}

/// `value(x, y)` of each pixel, row 0 at the bottom.
template <class Value>
std::string fits_file(int width, int height, const std::string& cards, const Value& value) {
    std::vector<float> values;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) values.push_back(float(value(x, y)));
    return fits_hdu({width, height}, cards, values);
}

}  // namespace astrosplat
