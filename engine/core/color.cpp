// IEC 61966-2-1 with the engine's own pow. Primaries: chromaticities to XYZ, Bradford's adaptation between
// two whites, and back.
#include "core/color.h"

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

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
        const double s = double(i) / table_steps;
        table[i] = float(1.055 * real::pow(s, 2.0 / 2.4) - 0.055);
    }
    return table;
}

// XYZ of a chromaticity at Y = 1.
glm::dvec3 xyz_of(const glm::dvec2& c) { return {c.x / c.y, 1.0, (1.0 - c.x - c.y) / c.y}; }

glm::dmat3 diagonal(const glm::dvec3& d) {
    return {glm::dvec3(d.x, 0, 0), glm::dvec3(0, d.y, 0), glm::dvec3(0, 0, d.z)};
}

// The primaries in XYZ, each as bright as lets their sum be the white.
glm::dmat3 to_xyz(const Chromaticities& set) {
    const glm::dmat3 directions(xyz_of(set.red), xyz_of(set.green), xyz_of(set.blue));
    return directions * diagonal(glm::inverse(directions) * xyz_of(set.white));
}

glm::dmat3 adaptation(const glm::dvec2& from_white, const glm::dvec2& to_white) {
    const glm::dmat3 cones({0.8951, -0.7502, 0.0389}, {0.2664, 1.7135, -0.0685},
                           {-0.1614, 0.0367, 1.0296});  // by columns
    const glm::dvec3 from = cones * xyz_of(from_white), to = cones * xyz_of(to_white);
    return glm::inverse(cones) * diagonal(to / from) * cones;
}

}  // namespace

float display_srgb(float linear) {
    static const std::array<float, table_steps + 2> table = make_srgb_table();
    const float x = linear > 0.0f ? (linear < 1.0f ? linear : 1.0f) : 0.0f;
    if (x <= 0.0031308f) return x * 12.92f;
    const float at = std::sqrt(x) * float(table_steps);
    const float below = std::floor(at);
    const auto i = std::size_t(below);
    return table[i] + (table[i + 1] - table[i]) * (at - below);
}

glm::dmat3 primaries_matrix(const Chromaticities& from, const Chromaticities& to) {
    return glm::inverse(to_xyz(to)) * adaptation(from.white, to.white) * to_xyz(from);
}

}  // namespace astrosplat
