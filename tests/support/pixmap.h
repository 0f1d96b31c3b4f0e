// Pictures as portable pixmaps, the plainest format that every reader of pictures knows.
#pragma once

#include <cmath>
#include <string>

namespace astrosplat::test {

/// The bytes of the pixmap of value(x, y, channel), 0 to 255.
template <class Value>
std::string pixmap(int width, int height, const Value& value) {
    std::string text = "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = 0; k < 3; ++k) text += char(static_cast<unsigned char>(value(x, y, k)));
    return text;
}

/// Round stars on a lattice over a ground with some noise, for what takes stars away.
struct StarryPicture {
    int width, height;    // px
    int step_x, step_y;   // px between stars, of which the first is half a step from the corner
    double peak, spread;  // 8-bit values above the ground; px^2, twice the variance
    double slope, noise;  // 8-bit values a px along x; between one value of the noise and the next
};

inline std::string starry_pixmap(const StarryPicture& p) {
    return pixmap(p.width, p.height, [&](int x, int y, int) {
        const double u = x % p.step_x - p.step_x / 2, v = y % p.step_y - (p.step_y - 1) / 2;
        return int(60.0 + p.slope * x + p.noise * ((x * 7 + y * 13) % 5) +
                   p.peak * std::exp(-(u * u + v * v) / p.spread));
    });
}

}  // namespace astrosplat::test
