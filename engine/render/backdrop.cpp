// Blocks of 8x8 px between exact places; blocks round a pole of the picture, where places are not nearly
// linear, are looked up pixel by pixel.
#include "render/environment.h"

#include <glm/vec2.hpp>

#include "core/parallel.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr std::int64_t block_px = 8;
constexpr float pole_share =
    0.04f;  // of the picture's height, above and below: rows that count as round a pole

void draw_exactly(const Environment& environment, const Camera& camera, const Region& part, Image& image) {
    for (std::int64_t y = part.y; y < part.y + part.height; ++y) {
        for (std::int64_t x = part.x; x < part.x + part.width; ++x) {
            const glm::dvec3 ray = ray_direction(camera, double(x) + 0.5, double(y) + 0.5);
            const glm::vec3 color = sample_environment(environment, camera.eye, ray, pixel_spread(camera));
            std::copy_n(&color[0], 3, image.at(x, y));
        }
    }
}

/// The mip level nearest to the pixels' spacing along the equator.
const Image& nearest_level(const Environment& environment, double spread) {
    const std::vector<Image>& levels = (*environment.faces)[0];
    const double texels = spread * double(levels[0].width - 2) / (2.0 * real::pi);
    const double level = texels > 1.0 ? real::log(texels) / real::log(2.0) + 0.5 : 0.0;
    return levels[std::min(std::size_t(level), levels.size() - 1)];
}

/// Places of the blocks' corners on the level, texels; longitudes as they come from atan2.
class Places {
  public:
    Places(const Environment& environment, const Camera& camera, const Image& level, const Image& image)
        : columns_(image.width / block_px + 2), size_(level.width - 2, level.height - 2) {
        const std::int64_t rows = image.height / block_px + 2;
        places_.resize(columns_ * rows);
        parallel_each(columns_ * rows, 8 * columns_, [&](std::int64_t i) {
            const glm::dvec3 ray = ray_direction(camera, double(i % columns_ * block_px) + 0.5,
                                                 double(i / columns_ * block_px) + 0.5);
            const glm::dvec2 place = latlong_place(environment.environment_from_world *
                                                   seen_place(environment, camera.eye, ray).direction);
            places_[i] = glm::vec2(place * glm::dvec2(size_));
        });
    }

    /// The four corners of a block, longitudes within half the picture of the first; false near a pole.
    bool corners(std::int64_t column, std::int64_t row, glm::vec2 (&corner)[4]) const {
        const auto first = std::size_t(row * columns_ + column);
        const auto below = first + std::size_t(columns_);
        const glm::vec2 found[4] = {places_[first], places_[first + 1], places_[below], places_[below + 1]};
        for (int i = 0; i < 4; ++i) {
            corner[i] = found[i];
            const float turn = corner[i].x - corner[0].x;
            if (turn > 0.5f * size_.x) corner[i].x -= size_.x;
            if (turn < -0.5f * size_.x) corner[i].x += size_.x;
            const float latitude = corner[i].y / size_.y;
            if (latitude < pole_share || latitude > 1.0f - pole_share) return false;
        }
        return true;
    }

  private:
    std::int64_t columns_;
    glm::vec2 size_;
    std::vector<glm::vec2> places_;
};

/// Bilinear, times the gain; the level has a border of one texel. Four floats a texel, so that compilers use
/// vectors: the fourth is the next texel's, which there is away from the poles.
void look_up(const Image& level, glm::vec2 place, float gain, float* __restrict out) {
    const float width = float(level.width - 2);
    if (place.x < 0.0f) place.x += width;
    if (place.x >= width) place.x -= width;
    const float x = place.x + 0.5f, y = place.y + 0.5f;  // from the border's first centre on
    const auto ix = std::int32_t(x), iy = std::int32_t(y);
    const float u = x - float(ix), v = y - float(iy);
    const float a = (1.0f - u) * (1.0f - v) * gain, b = u * (1.0f - v) * gain;
    const float c = (1.0f - u) * v * gain, d = u * v * gain;
    const float* __restrict top = level.at(ix, iy);
    const float* __restrict bottom = level.at(ix, iy + 1);
    for (int k = 0; k < 4; ++k) out[k] = a * top[k] + b * top[k + 3] + c * bottom[k] + d * bottom[k + 3];
}

void draw_block(const Image& level, float gain, const glm::vec2 (&corner)[4], const Region& part,
                Image& image) {
    constexpr float step = 1.0f / float(block_px);
    for (std::int64_t y = 0; y < part.height; ++y) {
        const float v = float(y) * step;
        const glm::vec2 left = corner[0] + (corner[2] - corner[0]) * v;
        const glm::vec2 right = corner[1] + (corner[3] - corner[1]) * v;
        const glm::vec2 move = (right - left) * step;
        float* out = image.at(part.x, part.y + y);
        for (std::int64_t x = 0; x < part.width; ++x)
            look_up(level, left + move * float(x), gain, out + 4 * x);
    }
}

}  // namespace

void draw_backdrop(const Environment& environment, const Camera& camera, std::int64_t width,
                   std::int64_t height, Image& image) {
    if (image.width != width || image.height != height || image.channels != 4)
        image = make_image(width, height, 4);
    if (environment.faces->size() != 1) {  // a cube needs no arc functions
        parallel_chunks(height, block_px, [&](std::int64_t begin, std::int64_t end, int) {
            draw_exactly(environment, camera, {0, begin, width, end - begin}, image);
        });
        return;
    }
    const Image& level = nearest_level(environment, pixel_spread(camera));
    const Places places(environment, camera, level, image);
    parallel_chunks(height, block_px, [&](std::int64_t begin, std::int64_t end, int) {
        for (std::int64_t x = 0; x < width; x += block_px) {
            const Region part{x, begin, std::min(block_px, width - x), end - begin};
            glm::vec2 corner[4];
            if (places.corners(x / block_px, begin / block_px, corner))
                draw_block(level, environment.gain, corner, part, image);
            else
                draw_exactly(environment, camera, part, image);
        }
    });
}

}  // namespace astrosplat
