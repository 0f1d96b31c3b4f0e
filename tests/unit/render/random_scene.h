// Splats and layers drawn from seeds, the same on every machine: for renderers that have to agree.
#pragma once

#include <glm/matrix.hpp>
#include <random>

#include "unit/render/scenes.h"

namespace astrosplat::test {

struct RandomScene {
    std::vector<ShadedSplats> sets;  // one a layer
    std::vector<RenderLayer> layers;
    Camera camera;
    RenderSettings settings;

    RandomScene(const RandomScene&) = delete;  // layers point to sets
    RandomScene& operator=(const RandomScene&) = delete;

    /// The same scene for the same seed on every machine: 1 to 4 layers of `splats` splats, 48x36 px.
    RandomScene(std::uint32_t seed, int splats) : random_(seed), dust_(seed + 1000) {
        const std::size_t count = 1 + random_() % 4;
        sets.resize(count);
        for (std::size_t l = 0; l < count; ++l) add_layer(l, splats);
        settings.width = 48;
        settings.height = 36;
        settings.pixel_filter = pick({0.3f, 0.5f, 1.0f});
        camera.projection = random_() % 3 == 0 ? Projection::orthographic : Projection::perspective;
        camera.eye = {between(-1, 1), between(-1, 1), 9.0};
        const glm::dvec3 back = glm::normalize(camera.eye),
                         right = glm::normalize(glm::cross({0.1, 1.0, 0.0}, back));
        camera.world_from_camera = {right, glm::cross(back, right), back};
        camera.focal_px = camera.projection == Projection::orthographic ? 6.0 : 50.0;
        camera.center_x_px = 24.0;
        camera.center_y_px = 18.0;
        camera.near = pick({0.01f, 0.01f, 8.0f});
        camera.far = pick({0.0f, 0.0f, 10.0f});
        camera.near_fade = pick({0.0f, 1.5f});
        camera.aspect = 48.0 / 36.0;
    }

  private:
    double between(double lo, double hi) { return lo + (hi - lo) * double(random_() >> 8) / 16777216.0; }
    float pick(const std::vector<float>& values) { return values[random_() % values.size()]; }

    void add_layer(std::size_t number, int splats) {
        ShadedSplats& set = sets[number];
        for (int i = 0; i < splats; ++i) {
            set.id.push_back(random_());
            set.position.push_back({between(-3, 3), between(-2, 2), between(-2, 2)});
            set.radius.push_back(float(std::exp2(between(-5, 1))));
            set.alpha.push_back(float(between(0.05, 1)));
            set.color.push_back({between(0, 1.5), between(0, 1.5), between(0, 1.5)});
        }
        RenderLayer& layer = layers.emplace_back();
        layer.name = "layer " + std::to_string(number);
        layer.splats = &set;
        layer.render.falloff = {static_cast<Falloff::Shape>(random_() % 5), pick({0.2f, 0.5f, 0.9f}),
                                pick({2.0f, 4.5f, 12.0f})};
        layer.render.blend = static_cast<Blend>(random_() % 5);
        layer.render.opacity = pick({1.0f, 0.6f});
        layer.render.holdout = random_() % 6 == 0;
        layer.render.isolate = random_() % 4 == 0;
        layer.scale = between(0.6, 1.2);
        const double c = std::cos(between(0, 6)), s = std::sqrt(1.0 - c * c);
        layer.world_from_layer = {glm::dvec3(c, 0, -s), glm::dvec3(0, 1, 0), glm::dvec3(s, 0, c)};
        layer.translate = {between(-0.5, 0.5), between(-0.5, 0.5), between(-0.5, 0.5)};
        layer.axis = glm::normalize(glm::dvec3(between(-1, 1), 1.0, between(-1, 1)));
        if (dust_() % 4 == 0) layer.render.blend = Blend::absorb;
        layer.render.absorb = exponents();
        layer.absorbs = layer.render.blend != Blend::lighten && dust_() % 3 == 0;
        for (std::size_t i = 0; layer.absorbs && i < set.color.size(); i += 3) set.color[i] = -exponents();
    }

    glm::vec3 exponents() {
        const auto one = [this] { return 0.2f + 1.8f * float(dust_() >> 8) / 16777216.0f; };
        const float r = one(), g = one();
        return {r, g, one()};
    }

    std::mt19937 random_, dust_;
};

inline constexpr Random cloud_random{7};

/// A cloud seen in perspective: sizes from far below a pixel to half the picture, many equal depths.
inline ShadedSplats cloud(std::uint32_t count, std::uint32_t seed, float largest = 1.5f) {
    std::vector<OneSplat> splats;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t n = i + seed * 1000003u;
        const float size = cloud_random(n, 5);
        OneSplat s;
        s.position = {cloud_random(n, 1) * 8.0f - 4.0f, cloud_random(n, 2) * 6.0f - 3.0f,
                      std::floor(cloud_random(n, 3) * 24.0f) / 4.0f};
        s.radius = 0.005f + largest * size * size * size * size * size;
        s.alpha = cloud_random(n, 4);
        s.color = {cloud_random(n, 6) * 1.5f, cloud_random(n, 7), cloud_random(n, 8)};
        splats.push_back(s);
    }
    return make_splats(splats);
}

}  // namespace astrosplat::test
