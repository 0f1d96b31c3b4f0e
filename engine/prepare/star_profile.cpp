// exp(-u), and (1 + u)^-beta with u = (r / a)^2 (Moffat 1969, A&A 3, 455).
#include "prepare/star_profile.h"

#include <array>
#include <cassert>
#include <cmath>

#include "core/real.h"

namespace astrosplat {
namespace {

// Exponents; the first stands for the Gaussian.
constexpr std::array<double, star_shapes> betas{0.0, 6.0, 4.0, 3.0, 2.5};

double inverse_power(int shape, double q) {
    const double squared = 1.0 / (q * q);
    switch (shape) {
        case 1:
            return squared * squared * squared;
        case 2:
            return squared * squared;
        case 3:
            return squared / q;
        default:
            return squared / std::sqrt(q);
    }
}

// u at half of the peak.
double half_unit(int shape) {
    static const std::array<double, star_shapes> units = [] {
        std::array<double, star_shapes> u{real::log(2.0)};
        for (std::size_t i = 1; i < u.size(); ++i) u[i] = real::pow(2.0, 1.0 / betas[i]) - 1.0;
        return u;
    }();
    return units[static_cast<std::size_t>(shape)];
}

}  // namespace

double unit_of(const StarProfile& profile) {
    return 4.0 * half_unit(profile.shape) / (profile.fwhm_px * profile.fwhm_px);
}

ProfileValue profile_at(int shape, double u) {
    assert(shape >= 0 && shape < star_shapes);
    if (shape == 0) {
        const double value = real::exp(-u);
        return {value, -value};
    }
    const double q = 1.0 + u, value = inverse_power(shape, q);
    return {value, -betas[static_cast<std::size_t>(shape)] * value / q};
}

double integral_of(const StarProfile& profile) {
    const double gaussian = real::pi / unit_of(profile);
    return profile.shape == 0 ? gaussian : gaussian / (betas[static_cast<std::size_t>(profile.shape)] - 1.0);
}

double reach_of(const StarProfile& profile, double share) {
    if (!(share < 1.0)) return 0.0;
    const double beta = betas[static_cast<std::size_t>(profile.shape)];
    const double u = profile.shape == 0 ? -real::log(share) : real::pow(share, -1.0 / beta) - 1.0;
    return std::sqrt(u / unit_of(profile));
}

}  // namespace astrosplat
