// The colour of a star. In: its colour index B-V. Out: linear Rec. 709 light of luminance 1, that of a black
// body of the star's temperature.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace astrosplat {

/// Kelvin, of a star of that B-V: F. J. Ballesteros, "New insights into black bodies", EPL 97 (2012) 34008,
/// eq. 14. Falls with B-V; for B-V above -0.67.
double star_temperature(double color_index);

/// Linear Rec. 709 of a black body's light, for temperatures above 0: Planck's law weighed with the colour
/// matching functions of CIE 1931 as C. Wyman, P.-P. Sloan and P. Shirley fit them ("Simple analytic
/// approximations to the CIE XYZ color matching functions", JCGT 2/2, 2013, section 2.2), from 380 to 780 nm.
/// Channels below 0, of colours that no screen shows, become 0; then the luminance is made 1.
glm::dvec3 black_body_color(double kelvin);

/// The colours of many stars, from a table in steps of 0.01 magnitudes.
class StarColors {
  public:
    StarColors();
    /// B-V is clamped to -0.4..5; without one it is 0.65, the Sun's.
    glm::dvec3 operator()(const std::optional<double>& color_index) const;

  private:
    std::vector<glm::dvec3> table_;
};

}  // namespace astrosplat
