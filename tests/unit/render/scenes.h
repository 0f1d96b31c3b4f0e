// Small hand-made sets of splats and cameras whose pictures can be worked out by hand.
#pragma once

#include <glm/vec3.hpp>

#include "render/footprint.h"
#include "render/render.h"
#include "support/all_values.h"
#include "support/test.h"

namespace astrosplat::test {

inline constexpr auto all_shapes = all_values<Falloff::Shape>;

struct OneSplat {
    glm::vec3 position{0.0f};
    float radius = 1.0f;
    float alpha = 1.0f;
    glm::vec3 color{1.0f};
};

/// Of 0..1, for things that are numbered, by purpose.
struct Random {
    std::uint32_t seed;
    float operator()(std::uint32_t n, std::uint32_t purpose) const {
        return shared::as_uniform(shared::as_hash(seed, n, 0u, purpose));
    }
};

inline ShadedSplats make_splats(const std::vector<OneSplat>& splats) {
    ShadedSplats set;
    for (const OneSplat& s : splats) {
        set.id.push_back(set.id.size());
        set.position.push_back(s.position);
        set.radius.push_back(s.radius);
        set.alpha.push_back(s.alpha);
        set.color.push_back(s.color);
    }
    return set;
}

/// Orthographic, one scene unit is one pixel, x right, y up, the origin in the middle of the picture, looking
/// at -z from z = 1000.
inline Camera pixel_camera(double width_px, double height_px) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.eye = {0.0, 0.0, 1000.0};
    camera.focal_px = 1.0;
    camera.center_x_px = 0.5 * width_px;
    camera.center_y_px = 0.5 * height_px;
    camera.aspect = width_px / height_px;
    return camera;
}

inline RenderLayer layer_of(const char* name, const ShadedSplats& splats, Blend blend = Blend::over,
                            Falloff::Shape shape = Falloff::Shape::constant) {
    RenderLayer layer;
    layer.name = name;
    layer.splats = &splats;
    layer.render.blend = blend;
    layer.render.falloff.shape = shape;
    return layer;
}

inline RenderSettings settings_of(std::int64_t width, std::int64_t height) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    return settings;
}

/// Sum of one channel over all pixels.
inline double total(const Image& image, int channel) {
    double sum = 0.0;
    for (std::size_t i = std::size_t(channel); i < image.pixels.size(); i += std::size_t(image.channels))
        sum += image.pixels[i];
    return sum;
}

/// `part` is that region of `whole`, bit by bit.
inline void expect_crop(const Image& part, const Image& whole, const Region& region) {
    for (std::int64_t y = 0; y < region.height; ++y)
        for (std::int64_t x = 0; x < 4 * region.width; ++x)
            ASSERT_EQ(part.at(0, y)[x], whole.at(region.x, region.y + y)[x]) << x / 4 << ", " << y;
}

/// The picture draw(settings) has the same bits for any threads, instruction set and tiles, in bands when
/// memory is little, and in regions.
template <class Draw>
void expect_same_picture(const Draw& draw, const RenderSettings& usual, std::int64_t little_bytes,
                         const std::vector<Region>& regions) {
    const Image expected = draw(usual);
    EXPECT_GT(total(expected, 3), 100.0);
    expect_same_bits([&] { return Bits() << draw(usual); });
    RenderSettings settings = usual;
    for (const int tile : {16, 48, 128}) {
        settings.tile_px = tile;
        EXPECT_EQ(expected.pixels, draw(settings).pixels) << "tiles of " << tile;
    }
    settings = usual;
    settings.memory_limit_bytes = little_bytes;
    EXPECT_EQ(expected.pixels, draw(settings).pixels) << "in bands";
    settings = usual;
    for (const Region& region : regions) {
        settings.region = region;
        expect_crop(draw(settings), expected, region);
    }
}

}  // namespace astrosplat::test
