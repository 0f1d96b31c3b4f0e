// The sRGB curve and luminance. In and out: single channel values; the curve is odd-symmetric, so that values
// below 0 and above 1 survive a round trip.
#pragma once

namespace astrosplat::real {

/// Display value to linear light and back, IEC 61966-2-1; every double is allowed.
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

}  // namespace astrosplat::real

namespace astrosplat {

/// Linear light as a display shows it: clamped to [0, 1] (NaN: 0), then the sRGB curve, within 2e-7.
float display_srgb(float linear);

/// Luminance of linear Rec. 709 colour (ITU-R BT.709-6, item 3.2).
constexpr float luminance(float r, float g, float b) { return 0.2126f * r + 0.7152f * g + 0.0722f * b; }

}  // namespace astrosplat
