// The renderer on a card against the processor's, bit by bit. Without a card Mesa's llvmpipe runs every pass.
#include "gl/card.h"

#include <glm/matrix.hpp>

#include "core/parallel.h"
#include "gl/gl_fixture.h"
#include "splats/splat_set.h"
#include "support/bits.h"
#include "support/temp_folder.h"
#include "support/test.h"
#include "unit/render/random_scene.h"

namespace astrosplat::test {
namespace {

class Cards : public GlTest {
  protected:
    static Card& card() {
        const GlInfo& info = shared_context().context->info();
        static Card the_card(info, info.software);
        return the_card;
    }
};

void expect_same(const Image& card, const Image& processor, const std::string& what) {
    ASSERT_EQ(card.pixels.size(), processor.pixels.size()) << what;
    std::size_t differ = 0, first = 0;
    for (std::size_t i = card.pixels.size(); i-- > 0;)
        if (std::memcmp(&card.pixels[i], &processor.pixels[i], sizeof(float)) != 0) ++differ, first = i;
    EXPECT_EQ(differ, 0u) << what << ": value " << first << " is " << card.pixels[first] << ", not "
                          << processor.pixels[first];
}

/// All images of the frame, by the card and by the processor.
void expect_same_frame(Card& card, std::span<const RenderLayer> layers, const Camera& camera,
                       RenderSettings settings, const std::string& what) {
    const RenderedFrame expected = render(layers, camera, nullptr, settings);
    settings.device = &card;
    const RenderedFrame frame = render(layers, camera, nullptr, settings);
    ASSERT_EQ(frame.statistics.not_on_device, "") << what;
    EXPECT_EQ(frame.statistics.device, card.name());
    expect_same(frame.beauty, expected.beauty, what);
    expect_same(frame.depth, expected.depth, what + ", depth");
    expect_same(frame.coverage, expected.coverage, what + ", coverage");
    expect_same(frame.count, expected.count, what + ", count");
    for (std::size_t l = 0; l < expected.layers.size(); ++l)
        expect_same(frame.layers[l], expected.layers[l], what + ", layer " + std::to_string(l));
    EXPECT_EQ(frame.statistics.splats_drawn, expected.statistics.splats_drawn) << what;
    EXPECT_NEAR(frame.statistics.mean_overlap, expected.statistics.mean_overlap,
                0.05 + 0.05 * expected.statistics.mean_overlap)
        << what;
}

Camera cloud_camera(double width, double height) {
    Camera camera;
    camera.eye = {0.0, 0.0, 9.0};
    camera.focal_px = 0.76 * width;
    camera.center_x_px = 0.5 * width;
    camera.center_y_px = 0.5 * height;
    return camera;
}

TEST_F(Cards, EveryBlendAndFalloff) {
    const ShadedSplats splats = cloud(3000, 1);
    for (const Blend blend :
         {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid, Blend::absorb})
        for (const Falloff::Shape shape : all_shapes) {
            const RenderLayer layer = layer_of("layer", splats, blend, shape);
            expect_same_frame(card(), {&layer, 1}, cloud_camera(211, 133), settings_of(211, 133),
                              fmt::format("blend {}, shape {}", int(blend), int(shape)));
        }
}

TEST_F(Cards, RandomScenesWithAllImages) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        RandomScene scene(seed, 400);
        scene.settings.aov_depth = scene.settings.aov_coverage = scene.settings.aov_count = seed % 2 == 0;
        scene.settings.aov_layers = seed % 4 == 0;
        expect_same_frame(card(), scene.layers, scene.camera, scene.settings, fmt::format("seed {}", seed));
    }
}

TEST_F(Cards, SplatsThatTheProcessorProjects) {
    ShadedSplats splats = cloud(500, 8), others = cloud(900, 9, 0.4f), stars = cloud(200, 10);
    for (std::size_t i = 0; i < splats.id.size(); i += 7) splats.id[i] |= star_band << 48;
    for (glm::vec3& color : stars.color) color *= 40.0f;
    for (std::size_t i = 0; i < others.id.size(); ++i)
        others.stretch.push_back(
            {glm::vec3(2.0f, 0.3f, 0.0f), glm::vec3(0.0f, 0.7f, 0.1f), glm::vec3(0.2f, 0.0f, 1.0f)});
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::hybrid}) {
        RenderLayer layers[] = {layer_of("divided", splats, blend, Falloff::Shape::gaussian),
                                layer_of("stretched", others, Blend::over, Falloff::Shape::gaussian),
                                layer_of("stars", stars, Blend::add)};
        layers[0].render.lod = {20.0f, 64, 0.7f, 6.0f};
        layers[2].stars = StarPsf{1.0f, 0.2f, 3.0f, 2.5f, 0.1f};
        for (const std::size_t count : {1, 2, 3}) {
            card().set_slabs(count == 3 ? 7 : 1);
            RenderSettings settings = settings_of(211, 133);
            settings.aov_depth = count == 2;
            if (count == 3 || blend == Blend::over)
                expect_same_frame(card(), {layers, count}, cloud_camera(211, 133), settings,
                                  fmt::format("blend {}, {} layers", int(blend), count));
        }
    }
    card().set_slabs(0);
}

TEST_F(Cards, SlabsAndRegionsChangeNoBit) {
    const ShadedSplats splats = cloud(6000, 3, 0.5f), others = cloud(2000, 4);
    const RenderLayer layers[] = {layer_of("a", splats, Blend::over, Falloff::Shape::gaussian),
                                  layer_of("b", others, Blend::screen, Falloff::Shape::linear)};
    for (const int slabs : {1, 7, 32}) {
        card().set_slabs(slabs);
        for (const std::size_t count : {1, 2}) {
            RenderSettings settings = settings_of(300, 170);
            expect_same_frame(card(), {layers, count}, cloud_camera(300, 170), settings,
                              fmt::format("{} slabs", slabs));
            settings.region = {37, 21, 190, 71};
            expect_same_frame(card(), {layers, count}, cloud_camera(300, 170), settings,
                              fmt::format("{} slabs, a region", slabs));
        }
    }
    card().set_slabs(0);
}

TEST_F(Cards, WhatACardDoesNotDrawTheProcessorDoes) {
    const ShadedSplats splats = cloud(100, 5);
    RenderLayer layer = layer_of("layer", splats);
    Camera camera = cloud_camera(64, 36);
    camera.projection = Projection::equirectangular;
    RenderSettings settings = settings_of(64, 36);
    settings.device = &card();
    const RenderedFrame frame = render({&layer, 1}, camera, nullptr, settings);
    EXPECT_EQ(frame.statistics.device, "");
    EXPECT_EQ(frame.statistics.not_on_device, "projections onto the sphere");
    settings.device = nullptr;
    expect_same(frame.beauty, render({&layer, 1}, camera, nullptr, settings).beauty, "sphere");
}

TEST(MadePrecise, LocalsResultsAndWhatComesOut) {
    EXPECT_EQ(made_precise("struct A { float x; };\n"
                           "float f(float a, inout A b) {\n"
                           "    float c = a * a, d = 1.0f;  // float e;\n"
                           "    if (c > d) return c;\n"
                           "    return c\n        + d;\n"
                           "}\n"
                           "void g() { A a; uint n = 1u; return; }\n"),
              "struct A { float x; };\n"
              "float f(float a, precise inout A b) {\n"
              "    precise float c = a * a, d = 1.0f;  // float e;\n"
              "    if (c > d) { precise float result_ = c; return result_; }\n"
              "    { precise float result_ = c\n        + d; return result_; }\n"
              "}\n"
              "void g() { precise A a; uint n = 1u; return; }\n");
}

}  // namespace
}  // namespace astrosplat::test
