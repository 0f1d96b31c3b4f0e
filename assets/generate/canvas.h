// A picture being painted: linear light, RGBA in float, row 0 on top. In: functions of a place, and points of
// light. Out: JPEG and PNG files, sRGB, 8 bits.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace astrosplat::assets {

struct Canvas {
    int width = 0;   // px
    int height = 0;  // px
    std::vector<glm::vec4> pixels;

    glm::vec4& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
    const glm::vec4& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

Canvas make_canvas(int width, int height);

/// Sets every pixel to color(u, v): u to the right, v up, both in [0, 1] and taken at the pixel's centre.
void paint(Canvas& canvas, const std::function<glm::vec4(float u, float v)>& color);

/// Adds a round Gaussian of standard deviation `sigma_px` whose sum is `flux`, at a place in pixels from the
/// top left.
void add_glow(Canvas& canvas, glm::vec2 place_px, glm::vec3 flux, float sigma_px);

/// A telescope picture's display curve: asinh on the largest channel, so that hue survives; 0 to 0, `white`
/// to 1.
glm::vec3 asinh_curve(glm::vec3 light, float softening, float white);

/// Rec. 709 luminance.
float luminance(glm::vec3 color);

void save_jpeg(const Canvas& canvas, const std::filesystem::path& file, int quality);
/// `channels` 3 drops alpha, 4 keeps it (straight).
void save_png(const Canvas& canvas, const std::filesystem::path& file, int channels);

}  // namespace astrosplat::assets
