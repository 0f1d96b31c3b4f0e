// A picture of round stars on a lattice over a ground with some noise, for what takes stars away.
#pragma once

#include <cmath>
#include <string>

namespace astrosplat::test {

struct StarryPicture {
    int width, height;    // px
    int step_x, step_y;   // px between stars, of which the first is half a step from the corner
    double peak, spread;  // 8-bit values above the ground; px^2, twice the variance
    double slope, noise;  // 8-bit values a px along x; between one value of the noise and the next
};

/// As the bytes of a portable pixmap.
inline std::string starry_pixmap(const StarryPicture& p) {
    std::string text = "P6\n" + std::to_string(p.width) + " " + std::to_string(p.height) + "\n255\n";
    for (int y = 0; y < p.height; ++y) {
        for (int x = 0; x < p.width; ++x) {
            const double u = x % p.step_x - p.step_x / 2, v = y % p.step_y - (p.step_y - 1) / 2;
            const double light = 60.0 + p.slope * x + p.noise * ((x * 7 + y * 13) % 5) +
                                 p.peak * std::exp(-(u * u + v * v) / p.spread);
            text.append(3, static_cast<char>(static_cast<int>(light)));
        }
    }
    return text;
}

}  // namespace astrosplat::test
