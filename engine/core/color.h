// The sRGB curve, luminance, and the primaries of linear colour. In and out: single channel
// values (the curve is odd-symmetric, so that values below 0 and above 1 survive a round trip);
// chromaticities and the matrix from one set of primaries to another, the same bits everywhere.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

namespace astrosplat::real {

/// Display value to linear light and back, IEC 61966-2-1; every double is allowed.
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

}  // namespace astrosplat::real

namespace astrosplat {

/// Linear light as a display shows it: clamped to [0, 1] (NaN: 0), then the sRGB curve, within 2e-7.
float display_srgb(float linear);

/// Luminance of linear Rec. 709 colour (ITU-R BT.709-6, item 3.2).
template <class T>
constexpr T luminance(T r, T g, T b) {
    return T(0.2126) * r + T(0.7152) * g + T(0.0722) * b;
}

/// CIE 1931 x, y of a set's red, green and blue and of its white (1, 1, 1).
struct Chromaticities {
    glm::dvec2 red, green, blue, white;
};

/// ITU-R BT.709-6, item 1.3 and 1.4: the primaries of the program's own light, and D65.
constexpr Chromaticities rec709_chromaticities{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/// ACEScg: the primaries AP1 and the ACES white (near D60) of the Academy's S-2014-004, section 4.1.
constexpr Chromaticities acescg_chromaticities{
    {0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};

/// Linear RGB of one set to linear RGB of another. Its columns are the old primaries in the new set; white
/// becomes white, adapted as Bradford's cone responses do (K. M. Lam, "Metamerism and colour constancy",
/// 1985; the matrix as in ICC.1:2022, annex E.3). SMPTE RP 177-1993 has the way from chromaticities to XYZ.
glm::dmat3 primaries_matrix(const Chromaticities& from, const Chromaticities& to);

}  // namespace astrosplat
