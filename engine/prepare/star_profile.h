// How the light of a point spreads over pixels: a Gaussian, or one of some Moffat profiles, round, of peak 1.
// In: a squared distance from the middle. Out: the share of the peak.
#pragma once

namespace astrosplat {

inline constexpr int star_shapes = 5;  // 0 is the Gaussian, then Moffat profiles with ever stronger wings
inline constexpr double fwhm_of_sigma = 2.35482004503;  // of a Gaussian: 2 sqrt(2 ln 2)

struct StarProfile {
    double fwhm_px = 2.0;  // full width at half maximum, > 0
    int shape = 0;         // 0 .. star_shapes - 1
};

/// The scaled distance u that profiles are functions of is unit_of(profile) times the squared distance
/// (px^2).
double unit_of(const StarProfile& profile);

/// The profile and its derivative by u, at u >= 0.
struct ProfileValue {
    double value, slope;
};
ProfileValue profile_at(int shape, double u);

/// Its sum over all pixels, px^2.
double integral_of(const StarProfile& profile);

/// The distance beyond which it is below `share` (0..1) of the peak, px.
double reach_of(const StarProfile& profile, double share);

}  // namespace astrosplat
