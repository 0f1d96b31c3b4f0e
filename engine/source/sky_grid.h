// How the sky lies on a FITS picture: its header as WCSLIB reads it (Calabretta and Greisen 2002, A&A 395,
// 1061 and 1077; distortions of SIP, TPV and SCAMP included), and its frame brought to ICRS by ERFA. In:
// cards. Out: which pixel of another picture shows the same. Both libraries use the C library's mathematics,
// so places are snapped to 2^-12 px: their last bits reach no pixel.
#pragma once

#include <glm/vec2.hpp>

#include "core/standard.h"

struct wcsprm;

namespace astrosplat {

/// Of right ascension and declination, or what stands for them.
enum class SkyFrame { icrs, fk4, fk5, galactic, ecliptic };

class SkyGrid {
  public:
    /// Degrees of the sky to the east and to the north that a pixel to the right and one upwards are, where
    /// the header's reference is: CD1_1, CD1_2, CD2_1, CD2_2.
    const std::array<double, 4>& degrees_per_px() const { return cd_; }
    /// Right ascension and declination of that place, degrees, ICRS.
    glm::dvec2 reference_deg() const { return reference_; }
    /// Nothing of the two headers' skies is different.
    bool operator==(const SkyGrid& other) const;

    /// Of pixels, from 1 in the middle of the lower left one, right ascension and declination, degrees, ICRS;
    /// NaN where there is no sky.
    void to_sky(std::span<glm::dvec2> places) const;
    /// The inverse, snapped; NaN for what the projection does not show.
    void to_pixels(std::span<glm::dvec2> places) const;

  private:
    friend struct FitsSky read_fits_sky(const fs::path& file, std::string cards, std::int64_t height,
                                        bool top_down);

    std::shared_ptr<const wcsprm> wcs_;
    SkyFrame frame_ = SkyFrame::icrs;
    double equinox_ = 2000.0;  // of FK5
    double flip_ = 0.0;        // of a picture whose first row is on top: its height + 1
    std::array<double, 4> cd_{};
    glm::dvec2 reference_{0.0};
};

/// What a header tells of the sky.
struct FitsSky {
    std::shared_ptr<const SkyGrid> grid;  // null: nothing
    std::string unfollowed;               // or something that is not followed: "the frame HPLN-TAN"
};

/// `cards` of 80 characters, of a picture whose rows are counted from the top where `top_down`. A table of
/// distortions is left out with a warning that names `file`.
FitsSky read_fits_sky(const fs::path& file, std::string cards, std::int64_t height, bool top_down);

}  // namespace astrosplat
