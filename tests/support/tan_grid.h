// A tangent plane of the sky in closed form (Calabretta and Greisen 2002, A&A 395, 1077), for tests of what
// reads headers.
#pragma once

#include <array>
#include <cmath>
#include <glm/vec2.hpp>
#include <optional>

namespace astrosplat {

/// The keywords CRPIX, CRVAL and CD.
struct TanGrid {
    glm::dvec2 reference_px{0.0}, reference_deg{0.0};
    std::array<double, 4> deg_per_px{};
};

/// Right ascension and declination of a place.
inline glm::dvec2 sky_at(const TanGrid& grid, const glm::dvec2& px) {
    constexpr double degree = 3.14159265358979323846 / 180.0;
    const glm::dvec2 d = px - grid.reference_px;
    const double xi = (grid.deg_per_px[0] * d.x + grid.deg_per_px[1] * d.y) * degree;
    const double eta = (grid.deg_per_px[2] * d.x + grid.deg_per_px[3] * d.y) * degree;
    const double dec = grid.reference_deg.y * degree, towards = std::cos(dec) - eta * std::sin(dec);
    const double up = std::sin(dec) + eta * std::cos(dec);
    const double ra = grid.reference_deg.x + std::atan2(xi, towards) / degree;
    return {ra - 360.0 * std::floor(ra / 360.0), std::atan2(up, std::hypot(xi, towards)) / degree};
}

/// The inverse; empty for what lies behind the tangent plane's half of the sky.
inline std::optional<glm::dvec2> place_of(const TanGrid& grid, const glm::dvec2& sky_deg) {
    constexpr double degree = 3.14159265358979323846 / 180.0;
    const double away = (sky_deg.x - grid.reference_deg.x) * degree, dec = sky_deg.y * degree;
    const double dec0 = grid.reference_deg.y * degree;
    const double depth = std::sin(dec) * std::sin(dec0) + std::cos(dec) * std::cos(dec0) * std::cos(away);
    if (!(depth > 0.0)) return {};
    const double xi = std::cos(dec) * std::sin(away) / depth / degree;
    const double eta =
        (std::sin(dec) * std::cos(dec0) - std::cos(dec) * std::sin(dec0) * std::cos(away)) / depth / degree;
    const auto& [a, b, c, d] = grid.deg_per_px;
    return grid.reference_px + glm::dvec2(d * xi - b * eta, a * eta - c * xi) / (a * d - b * c);
}

}  // namespace astrosplat
