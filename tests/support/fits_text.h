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

/// `value(x, y)` of each pixel, row 0 at the bottom; `cards` besides those of its size.
template <class Value>
std::string fits_file(int width, int height, const std::string& cards, const Value& value) {
    std::string file =
        fits_card("SIMPLE  =                    T") + fits_card("BITPIX  =                  -32") +
        fits_card("NAXIS   =                    2") + fits_card(fmt::format("NAXIS1  = {:20}", width)) +
        fits_card(fmt::format("NAXIS2  = {:20}", height)) + cards + fits_card("END");
    file.resize((file.size() + 2879) / 2880 * 2880, ' ');
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto number = float(value(x, y));
            std::uint32_t bits;
            std::memcpy(&bits, &number, 4);
            for (int shift = 24; shift >= 0; shift -= 8) file += char(bits >> shift & 255u);
        }
    file.resize((file.size() + 2879) / 2880 * 2880, '\0');
    return file;
}

}  // namespace astrosplat
