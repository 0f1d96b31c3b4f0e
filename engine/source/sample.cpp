// Filtered lookup in a texture: premultiplied texels are weighted, then the colour is divided by alpha once.
#include "source/texture.h"

#include <glm/vec4.hpp>

namespace astrosplat {
namespace {

using Wrap = TextureSettings::Wrap;

// The texel that stands for index i of n, -1 where there is none (black).
std::int64_t wrapped(std::int64_t i, std::int64_t n, Wrap wrap) {
    if (i >= 0 && i < n) return i;
    if (wrap == Wrap::repeat) return ((i % n) + n) % n;
    if (wrap == Wrap::black) return -1;
    return i < 0 ? 0 : n - 1;
}

glm::vec4 texel(const Texture& texture, std::int64_t x, std::int64_t y) {
    x = wrapped(x, texture.image.width, texture.wrap);
    y = wrapped(y, texture.image.height, texture.wrap);
    if (x < 0 || y < 0) return glm::vec4(0.0f);
    const float* p = texture.image.at(x, y);
    return {p[0], p[1], p[2], p[3]};
}

// floor for |x| < 2^63, without the library call that processors before SSE4.1 need.
std::int64_t whole(double x) {
    const auto truncated = std::int64_t(x);
    return truncated - (double(truncated) > x ? 1 : 0);
}

// Position along an axis of n texels, whose edges are integers; kept within reach of 64-bit indices.
double place(double coordinate, std::int64_t n, Wrap wrap) {
    constexpr double all_whole = 4503599627370496.0;  // 2^52, from where on doubles have no fraction
    if (wrap == Wrap::repeat)
        coordinate = std::fabs(coordinate) < all_whole ? coordinate - double(whole(coordinate)) : 0.0;
    return std::clamp(coordinate, -2.0, 3.0) * double(n);
}

struct Texel {
    float channel[4];
};

// Exact at both ends, and of equal values exactly that value. Started from the nearer end, so that beside an
// empty texel the faint rest of colour and alpha keeps its digits and their quotient the colour. No branch:
// which end is nearer is chance.
Texel mix(const float* a, const float* b, float t) {
    const bool first = t < 0.5f;
    const float* const nearer = first ? a : b;
    const float share = first ? t : t - 1.0f;
    Texel result;
    for (int c = 0; c < 4; ++c) result.channel[c] = nearer[c] + (b[c] - a[c]) * share;
    return result;
}

glm::vec4 mix4(const float* c00, const float* c10, const float* c01, const float* c11, float s, float t) {
    const Texel top = mix(c00, c10, s), bottom = mix(c01, c11, s);
    const Texel p = mix(top.channel, bottom.channel, t);
    return {p.channel[0], p.channel[1], p.channel[2], p.channel[3]};
}

glm::vec4 bilinear(const Texture& texture, double x, double y) {
    const std::int64_t i = whole(x - 0.5), j = whole(y - 0.5);
    const auto s = float(x - 0.5 - double(i)), t = float(y - 0.5 - double(j));
    const Image& image = texture.image;
    if (i >= 0 && j >= 0 && i + 1 < image.width && j + 1 < image.height) {  // nearly always
        const float* p = image.at(i, j);
        const float* q = image.at(i, j + 1);
        return mix4(p, p + 4, q, q + 4, s, t);
    }
    const glm::vec4 c00 = texel(texture, i, j), c10 = texel(texture, i + 1, j),
                    c01 = texel(texture, i, j + 1), c11 = texel(texture, i + 1, j + 1);
    return mix4(&c00.x, &c10.x, &c01.x, &c11.x, s, t);
}

// How much of texel i (from i to i + 1) lies between lo and hi.
double overlap(std::int64_t i, double lo, double hi) {
    const auto left = double(i);
    return std::max(0.0, std::min(left + 1.0, hi) - std::max(left, lo));
}

// Mean over a box centred at (x, y), partly covered texels by their share. At least one texel wide, at most
// the picture.
glm::vec4 box_mean(const Texture& texture, double x, double y, glm::vec2 box) {
    const double w = std::clamp<double>(box.x, 1.0, double(texture.image.width));
    const double h = std::clamp<double>(box.y, 1.0, double(texture.image.height));
    const double x0 = x - 0.5 * w, x1 = x + 0.5 * w, y0 = y - 0.5 * h, y1 = y + 0.5 * h;
    glm::dvec4 sum(0.0);
    for (auto j = std::int64_t(std::floor(y0)); double(j) < y1; ++j) {
        glm::dvec4 row(0.0);
        for (auto i = std::int64_t(std::floor(x0)); double(i) < x1; ++i)
            row += glm::dvec4(texel(texture, i, j)) * overlap(i, x0, x1);
        sum += row * overlap(j, y0, y1);
    }
    return glm::vec4(sum / ((x1 - x0) * (y1 - y0)));
}

}  // namespace

TextureSample sample(const Texture& texture, glm::vec2 uv, glm::vec2 box_texels) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y) || texture.image.pixels.empty())
        return {glm::vec3(0.0f), 0.0f};
    const double x = place(uv.x, texture.image.width, texture.wrap);
    const double y = place(1.0 - double(uv.y), texture.image.height, texture.wrap);
    glm::vec4 p;
    if (texture.filter == TextureSettings::Filter::nearest)
        p = texel(texture, whole(x), whole(y));
    else if (texture.filter == TextureSettings::Filter::area)
        p = box_mean(texture, x, y, box_texels);
    else
        p = bilinear(texture, x, y);
    if (!(p.w > 0.0f)) return {glm::vec3(0.0f), 0.0f};
    return {glm::vec3(p.x, p.y, p.z) / p.w, std::min(p.w, 1.0f)};
}

}  // namespace astrosplat
