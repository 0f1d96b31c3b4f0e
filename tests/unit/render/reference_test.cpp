// The tile renderer against the reference renderer, which is the method on one page.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "render/render.h"
#include "support/printing.h"
#include "support/random_scene.h"
#include "support/reference_renderer.h"

namespace astrosplat::test {
namespace {

/// Relative to the larger of 1 and the reference.
struct Differences {
    double mean = 0.0, largest = 0.0;
    std::string place;
};

Differences differences(const Image& got, const Image& reference) {
    Differences d;
    for (std::size_t i = 0; i < got.pixels.size(); ++i) {
        const double here =
            std::fabs(got.pixels[i] - reference.pixels[i]) / std::max(1.0f, reference.pixels[i]);
        d.mean += here / static_cast<double>(got.pixels.size());
        if (here <= d.largest) continue;
        d.largest = here;
        const auto n = static_cast<std::int64_t>(i) / got.channels;
        d.place = "channel " + std::to_string(i % 4) + " of pixel " + std::to_string(n % got.width) + ", " +
                  std::to_string(n / got.width) + ": " + std::to_string(got.pixels[i]) + " instead of " +
                  std::to_string(reference.pixels[i]);
    }
    return d;
}

Environment sky() {
    auto faces = std::make_shared<EnvironmentFaces>();
    Image one = make_image(4, 2, 3);
    for (std::size_t i = 0; i < one.pixels.size(); ++i)
        one.pixels[i] = 0.1f + 0.05f * static_cast<float>(i % 7);
    faces->push_back({one});
    return {faces, glm::dmat3(1.0), 1.0f, 0.4f, 0.4f};
}

std::string describe(const RandomScene& scene) {
    std::string text;
    for (const RenderLayer& layer : scene.layers) {
        const LayerRender& r = layer.render;
        text += " | " + testing::PrintToString(r.falloff.shape) + " " + testing::PrintToString(r.blend) +
                (r.holdout ? " holdout" : "") + (r.isolate ? " isolated" : "");
    }
    return text;
}

/// Dots with a hard rim: there a table is least like what it stands for.
bool has_rims(const RandomScene& scene) {
    return std::any_of(scene.layers.begin(), scene.layers.end(), [](const RenderLayer& layer) {
        const Falloff& falloff = layer.render.falloff;
        return falloff.shape == Falloff::Shape::constant ||
               (falloff.shape == Falloff::Shape::trapezoid && falloff.core > 0.6f);
    });
}

void expect_agreement(std::uint32_t first_seed, std::uint32_t last_seed) {
    const Environment environment = sky();
    for (std::uint32_t seed = first_seed; seed <= last_seed; ++seed) {
        const RandomScene scene(seed, 10);
        const Environment* const behind = seed % 3 == 0 ? &environment : nullptr;
        const Image reference = reference_render(scene.layers, scene.camera, behind, scene.settings);
        const Image got = render(scene.layers, scene.camera, behind, scene.settings).beauty;
        const Differences d = differences(got, reference);
        EXPECT_LT(d.mean, 1e-4) << "seed " << seed << describe(scene);
        EXPECT_LT(d.largest, has_rims(scene) ? 5e-3 : 1e-3) << "seed " << seed << describe(scene) << "\n"
                                                            << d.place;
    }
}

TEST(Reference, RandomScenesAreThoseOfTheTileRenderer) { expect_agreement(1, 12); }

TEST(Reference, MoreRandomScenesAreThoseOfTheTileRendererNightly) { expect_agreement(13, 120); }

}  // namespace
}  // namespace astrosplat::test
