// Blending by hand: one and two splats under every blend, holdout, hybrid, isolation, alpha,
// the stop rule, AOVs.
#include "render/shared_render.h"
#include "support/test.h"
#include "unit/render/scenes.h"

namespace astrosplat {
namespace {

using namespace astrosplat::test;

constexpr int size_px = 32;

/// Two large discs, `far` behind `near`, whose insides cover the middle pixel with weight 1.
struct Pair {
    OneSplat near_splat{{0.0f, 0.0f, 10.0f}, 14.0f, 0.25f, {0.5f, 0.25f, 1.0f}};
    OneSplat far_splat{{0.0f, 0.0f, -10.0f}, 14.0f, 0.5f, {0.125f, 1.0f, 0.75f}};
};

const float* middle(const Image& image) { return image.at(size_px / 2, size_px / 2); }

RenderedFrame render_layers(const std::vector<RenderLayer>& layers,
                            const Environment* environment = nullptr) {
    return render(layers, pixel_camera(size_px, size_px), environment, settings_of(size_px, size_px));
}

RenderedFrame render_pair(Blend blend, const Pair& pair = {}) {
    const ShadedSplats splats = make_splats({pair.near_splat, pair.far_splat});
    return render_layers({layer_of("both", splats, blend)});
}

TEST(Blend, OneOpaqueSplatWritesItsColourExactly) {
    const ShadedSplats splats = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 1.0f, {0.5f, 0.25f, 1.0f}}});
    for (const Blend blend : {Blend::over, Blend::lighten, Blend::hybrid}) {
        RenderLayer layer = layer_of("one", splats, blend);
        layer.axis = {0.0, 0.0, 1.0};  // hybrid: face-on
        const RenderedFrame frame = render_layers({layer});
        for (int y = 0; y < size_px; ++y)
            for (int x = 0; x < size_px; ++x) {
                const double d = std::hypot(x + 0.5 - 16.0, y + 0.5 - 16.0);
                const float* p = frame.beauty.at(x, y);
                if (d <= 12.0) {
                    EXPECT_EQ(p[0], 0.5f);
                    EXPECT_EQ(p[1], 0.25f);
                    EXPECT_EQ(p[2], 1.0f);
                    EXPECT_EQ(p[3], 1.0f);
                } else if (d >= 16.0) {
                    EXPECT_EQ(p[0] + p[1] + p[2] + p[3], 0.0f);
                }
            }
    }
}

TEST(Blend, OverAddScreenLightenOfTwo) {
    const Pair pair;
    const float s1 = pair.near_splat.alpha, s2 = pair.far_splat.alpha;
    const RenderedFrame over = render_pair(Blend::over), add = render_pair(Blend::add);
    const RenderedFrame screen = render_pair(Blend::screen), lighten = render_pair(Blend::lighten);
    double screen_hidden_1 = 0.0, screen_hidden_2 = 0.0;
    for (int k = 0; k < 3; ++k) {
        const float a = s1 * pair.near_splat.color[k], b = s2 * pair.far_splat.color[k];
        EXPECT_FLOAT_EQ(middle(over.beauty)[k], a + (1.0f - s1) * b);
        EXPECT_FLOAT_EQ(middle(add.beauty)[k], a + b);
        EXPECT_FLOAT_EQ(middle(screen.beauty)[k], 1.0f - (1.0f - a) * (1.0f - b));
        EXPECT_FLOAT_EQ(middle(lighten.beauty)[k], std::max(a, b));
        screen_hidden_1 += a / 3.0;
        screen_hidden_2 += b / 3.0;
    }
    EXPECT_FLOAT_EQ(middle(over.beauty)[3], s1 + (1.0f - s1) * s2);
    EXPECT_EQ(middle(add.beauty)[3], 0.0f);
    EXPECT_NEAR(middle(screen.beauty)[3], 1.0 - (1.0 - screen_hidden_1) * (1.0 - screen_hidden_2), 1e-6);
    EXPECT_FLOAT_EQ(middle(lighten.beauty)[3], s1 + (1.0f - s1) * s2);
}

// Also of splats that are not round, and where frames show directions.
TEST(Blend, AScreensAlphaIsTheMeanOfItsLight) {
    const Pair pair;
    const ShadedSplats round = make_splats({pair.near_splat});
    ShadedSplats flat = make_splats({pair.near_splat});
    flat.stretch.push_back(glm::mat3(1.0f, 0.0f, 0.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.0f, 1.0f));
    CameraParams panorama;
    panorama.projection = Projection::equirectangular;
    panorama.position = glm::dvec3(0.0, 0.0, 40.0);
    const Camera plane = pixel_camera(size_px, size_px), sphere = make_camera(panorama, size_px, size_px, {});
    for (const Camera* camera : {&plane, &sphere})
        for (const ShadedSplats* splats : std::initializer_list<const ShadedSplats*>{&round, &flat}) {
            const RenderLayer layer = layer_of("one", *splats, Blend::screen);
            const Image beauty =
                render(std::span(&layer, 1), *camera, nullptr, settings_of(size_px, size_px)).beauty;
            EXPECT_GT(middle(beauty)[2], 0.1f);
            for (std::size_t i = 0; i < beauty.pixels.size(); i += 4)
                ASSERT_NEAR(beauty.pixels[i + 3],
                            (beauty.pixels[i] + beauty.pixels[i + 1] + beauty.pixels[i + 2]) / 3.0f, 1e-6f);
        }
}

// The near splat has no light and lets (1 - s)^a of each channel through.
void expect_absorbed(const RenderedFrame& frame, const glm::vec3& exponents, const Pair& pair) {
    const double s1 = pair.near_splat.alpha, s2 = pair.far_splat.alpha;
    double hidden = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double through = std::pow(1.0 - s1, double(exponents[k]));
        EXPECT_NEAR(middle(frame.beauty)[k], through * s2 * pair.far_splat.color[k], 1e-6) << k;
        hidden += (1.0 - through) / 3.0;
    }
    EXPECT_NEAR(middle(frame.beauty)[3], hidden + (1.0 - hidden) * s2, 1e-6);
}

TEST(Blend, AbsorbLetsAPowerOfEachChannelThrough) {
    const Pair pair;
    const ShadedSplats dust = make_splats({pair.near_splat}), light = make_splats({pair.far_splat});
    RenderLayer absorbing = layer_of("dust", dust, Blend::absorb);
    expect_absorbed(render_layers({absorbing, layer_of("light", light, Blend::over)}), {0.8f, 1.0f, 1.35f},
                    pair);
    absorbing.render.absorb = {2.0f, 0.0f, 0.5f};
    for (const bool isolated : {false, true}) {
        absorbing.render.isolate = isolated;
        expect_absorbed(render_layers({layer_of("light", light, Blend::over), absorbing}), {2.0f, 0.0f, 0.5f},
                        pair);
    }
}

TEST(Blend, ColoursBelowZeroAbsorbInAnyLayer) {
    Pair pair;
    pair.near_splat.color = {-0.5f, -1.0f, -1.5f};
    const ShadedSplats splats = make_splats({pair.near_splat, pair.far_splat});
    RenderLayer layer = layer_of("both", splats, Blend::over);
    layer.absorbs = true;
    expect_absorbed(render_layers({layer}), {0.5f, 1.0f, 1.5f}, pair);
    layer.render.blend = Blend::add;
    const RenderedFrame added = render_layers({layer});
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(middle(added.beauty)[k],
                    std::pow(0.75, 0.5 * (k + 1)) * pair.far_splat.alpha * pair.far_splat.color[k], 1e-6);
}

TEST(Blend, OpaqueAbsorbersLetNothingThrough) {
    Pair pair;
    pair.near_splat.alpha = 1.0f;
    const ShadedSplats dust = make_splats({pair.near_splat}), light = make_splats({pair.far_splat});
    const RenderedFrame frame =
        render_layers({layer_of("dust", dust, Blend::absorb), layer_of("light", light, Blend::over)});
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(middle(frame.beauty)[k], 0.0f, 1e-6);
    EXPECT_NEAR(middle(frame.beauty)[3], 1.0f, 1e-6);
}

TEST(Blend, ScreenOfBrightColoursStaysPositive) {
    Pair pair;
    pair.near_splat.color = {8.0f, 2.0f, 0.5f};
    const RenderedFrame frame = render_pair(Blend::screen, pair);
    // near: s c = (2, 0.5, 0.125), B = (0, 0.5, 0.875)
    EXPECT_FLOAT_EQ(middle(frame.beauty)[0], 2.0f);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[1], 0.5f + 0.5f * 0.5f);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[2], 0.125f + 0.875f * 0.375f);
    const double hidden_near = (1.0 + 0.5 + 0.125) / 3.0, hidden_far = (0.0625 + 0.5 + 0.375) / 3.0;
    EXPECT_NEAR(middle(frame.beauty)[3], 1.0 - (1.0 - hidden_near) * (1.0 - hidden_far), 1e-6);
}

TEST(Blend, OrderIsByDistanceNotByRow) {
    const Pair pair;
    const ShadedSplats one = make_splats({pair.near_splat, pair.far_splat});
    const ShadedSplats other = make_splats({pair.far_splat, pair.near_splat});
    const Image a = render_layers({layer_of("a", one)}).beauty,
                b = render_layers({layer_of("a", other)}).beauty;
    EXPECT_EQ(a.pixels, b.pixels);
}

TEST(Blend, TiesGoToTheLowerLayerThenTheLowerId) {
    const ShadedSplats red = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 1.0f, {1.0f, 0.0f, 0.0f}}});
    const ShadedSplats both = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 1.0f, {0.0f, 1.0f, 0.0f}},
                                           {{0.0f, 0.0f, 0.0f}, 14.0f, 1.0f, {0.0f, 0.0f, 1.0f}}});
    EXPECT_EQ(middle(render_layers({layer_of("both", both)}).beauty)[1], 1.0f);
    EXPECT_EQ(middle(render_layers({layer_of("red", red), layer_of("both", both)}).beauty)[0], 1.0f);
}

TEST(Blend, HybridEqualsOverFaceOnAndScreenEdgeOn) {
    const Pair pair;
    const ShadedSplats splats = make_splats({pair.near_splat, pair.far_splat});
    RenderLayer hybrid = layer_of("h", splats, Blend::hybrid, Falloff::Shape::gaussian);
    const auto other = [&](Blend blend) {
        return render_layers({layer_of("o", splats, blend, Falloff::Shape::gaussian)}).beauty.pixels;
    };
    hybrid.axis = {0.0, 0.0, 1.0};  // along the view: face-on
    EXPECT_EQ(render_layers({hybrid}).beauty.pixels, other(Blend::over));
    hybrid.axis = {1.0, 0.0, 0.0};  // across: edge-on
    EXPECT_EQ(render_layers({hybrid}).beauty.pixels, other(Blend::screen));
}

TEST(Blend, HybridInBetweenFollowsTheFormula) {
    const Pair pair;
    const ShadedSplats splats = make_splats({pair.near_splat, pair.far_splat});
    RenderLayer hybrid = layer_of("h", splats, Blend::hybrid);
    hybrid.axis = {std::sin(real::radians(55.0)), 0.0, std::cos(real::radians(55.0))};  // half way: h = 1/2
    const RenderedFrame frame = render_layers({hybrid});
    for (int k = 0; k < 3; ++k) {
        const double c = pair.near_splat.color[k], s = pair.near_splat.alpha;
        const double through = 1.0 - s * (0.5 + 0.5 * std::min(1.0, c));
        EXPECT_NEAR(middle(frame.beauty)[k], s * c + through * pair.far_splat.alpha * pair.far_splat.color[k],
                    2e-5);
    }
}

// h rises as smoothstep does, not straight: a fifth of the way it is 0.104.
TEST(Blend, HybridRisesSmoothly) {
    const auto at = [](double deg) {
        return shared::hybrid_amount(float(real::cos(real::radians(deg))), 30.0f, 80.0f);
    };
    EXPECT_NEAR(at(40.0), 0.104, 1e-4);
    EXPECT_NEAR(at(55.0), 0.5, 1e-4);
    EXPECT_NEAR(at(70.0), 0.896, 1e-4);
    EXPECT_EQ(at(29.0), 0.0f);
    EXPECT_EQ(at(81.0), 1.0f);
}

TEST(Blend, HoldoutTakesLightAndAlphaOfWhatIsBehind) {
    const Pair pair;
    const ShadedSplats near_set = make_splats({pair.near_splat}), far_set = make_splats({pair.far_splat});
    RenderLayer holdout = layer_of("h", near_set);
    holdout.render.holdout = true;
    const RenderedFrame frame = render_layers({holdout, layer_of("far", far_set)});
    for (int k = 0; k < 3; ++k)
        EXPECT_FLOAT_EQ(middle(frame.beauty)[k], 0.75f * 0.5f * pair.far_splat.color[k]);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[3], 0.75f * 0.5f);
}

TEST(Blend, OpaqueHoldoutLeavesExactlyNothing) {
    Pair pair;
    pair.near_splat.alpha = 1.0f;
    const ShadedSplats near_set = make_splats({pair.near_splat}), far_set = make_splats({pair.far_splat});
    RenderLayer holdout = layer_of("h", near_set);
    holdout.render.holdout = true;
    const RenderedFrame frame = render_layers({holdout, layer_of("far", far_set)});
    for (int k = 0; k < 4; ++k) EXPECT_EQ(middle(frame.beauty)[k], 0.0f);
}

TEST(Blend, AnOpaqueStackHasAlphaExactlyOne) {
    std::vector<OneSplat> stack;
    for (int i = 0; i < 400; ++i) stack.push_back({{0.0f, 0.0f, float(-i)}, 14.0f, 0.05f, glm::vec3(0.5f)});
    const ShadedSplats splats = make_splats(stack);
    const RenderedFrame frame = render_layers({layer_of("stack", splats)});
    EXPECT_EQ(middle(frame.beauty)[3], 1.0f);
    EXPECT_NEAR(middle(frame.beauty)[0], 0.5f, 0.5f * 0x1p-15);
}

Environment grey_environment(float value) {
    Environment environment;
    environment.faces =
        std::make_shared<const EnvironmentFaces>(EnvironmentFaces{{make_image(4, 2, 3, value)}});
    environment.largest = value;
    return environment;
}

/// Nine black splats of alpha 3/4 in front of a white one, or of the environment: 2^-18 of its light arrives.
RenderedFrame light_behind_a_dark_stack(float exposure, const Environment* environment) {
    std::vector<OneSplat> stack;
    for (int i = 0; i < 9; ++i) stack.push_back({{0.0f, 0.0f, float(-i)}, 14.0f, 0.75f, glm::vec3(0.0f)});
    if (!environment) stack.push_back({{0.0f, 0.0f, -20.0f}, 14.0f, 1.0f, glm::vec3(1.0f)});
    const ShadedSplats splats = make_splats(stack);
    const RenderLayer layer = layer_of("stack", splats);
    RenderSettings settings = settings_of(size_px, size_px);
    settings.exposure = exposure;
    return render({&layer, 1}, pixel_camera(size_px, size_px), environment, settings);
}

// Light that exposure makes visible is not cut off by the stop rule; below it the pixel is closed exactly.
TEST(StopRule, KnowsOfTheExposure) {
    EXPECT_EQ(middle(light_behind_a_dark_stack(0.0f, nullptr).beauty)[0], 0.0f);
    EXPECT_EQ(middle(light_behind_a_dark_stack(-8.0f, nullptr).beauty)[0], 0.0f);
    EXPECT_FLOAT_EQ(middle(light_behind_a_dark_stack(4.0f, nullptr).beauty)[0], 0x1p-18f);
}

TEST(StopRule, KnowsOfABrightSky) {
    const Environment dim = grey_environment(1.0f), bright = grey_environment(4096.0f);
    EXPECT_EQ(middle(light_behind_a_dark_stack(0.0f, &dim).beauty)[0], 0.0f);
    EXPECT_FLOAT_EQ(middle(light_behind_a_dark_stack(0.0f, &bright).beauty)[0], 4096.0f * 0x1p-18f);
}

TEST(Blend, AlphaOfAFaintStackFollowsTheProduct) {
    std::vector<OneSplat> stack;
    for (int i = 0; i < 20; ++i) stack.push_back({{0.0f, 0.0f, float(-i)}, 14.0f, 0.05f, glm::vec3(1.0f)});
    const ShadedSplats splats = make_splats(stack);
    EXPECT_NEAR(middle(render_layers({layer_of("stack", splats)}).beauty)[3], 1.0 - std::pow(0.95, 20.0),
                1e-6);
}

TEST(Blend, FaintLightOfManySplatsIsNotLost) {
    const std::vector<OneSplat> many(20000, {{0.0f, 0.0f, 0.0f}, 14.0f, 1e-4f, glm::vec3(1.0f)});
    const ShadedSplats splats = make_splats(many);
    // Twenty thousand sums below 2, each rounded by at most 2^-24 of it: at most 2.4e-3 away.
    EXPECT_NEAR(middle(render_layers({layer_of("many", splats, Blend::add)}).beauty)[0], 2.0, 2.4e-3);
}

TEST(Blend, OpacityOfTheLayerMultipliesAlpha) {
    const ShadedSplats splats = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 0.5f, glm::vec3(1.0f)}});
    RenderLayer layer = layer_of("one", splats);
    layer.render.opacity = 0.25f;
    EXPECT_FLOAT_EQ(middle(render_layers({layer}).beauty)[3], 0.125f);
}

// Layers interleaved in depth are one sorted pass: dust between two stars hides the far one only.
TEST(Blend, MergedLayersInterleaveByDepth) {
    const ShadedSplats stars = make_splats({{{0.0f, 0.0f, 10.0f}, 14.0f, 0.5f, {1.0f, 0.0f, 0.0f}},
                                            {{0.0f, 0.0f, -10.0f}, 14.0f, 1.0f, {0.0f, 1.0f, 0.0f}}});
    const ShadedSplats dust = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 0.5f, {0.0f, 0.0f, 0.0f}}});
    const RenderedFrame frame = render_layers({layer_of("stars", stars, Blend::add), layer_of("dust", dust)});
    EXPECT_FLOAT_EQ(middle(frame.beauty)[0], 0.5f);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[1], 0.5f);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[3], 0.5f);
}

TEST(Isolate, LaysTheLayerOnWholeWithItsBlend) {
    const ShadedSplats back = make_splats({{{0.0f, 0.0f, 50.0f}, 14.0f, 0.5f, {0.8f, 0.4f, 0.2f}}});
    const ShadedSplats front = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 0.25f, {0.4f, 0.8f, 1.0f}}});
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid}) {
        RenderLayer isolated = layer_of("front", front, blend);
        isolated.axis = {0.0, 0.0, 1.0};
        isolated.render.isolate = true;
        const RenderedFrame frame =
            render_layers({layer_of("back", back), isolated});  // in front by file order
        for (int k = 0; k < 3; ++k) {
            const float b = 0.5f * back.color[0][k], f = 0.25f * front.color[0][k];
            const float expected = blend == Blend::add       ? f + b
                                   : blend == Blend::screen  ? 1.0f - (1.0f - f) * (1.0f - b)
                                   : blend == Blend::lighten ? std::max(f, b)
                                                             : f + 0.75f * b;
            EXPECT_FLOAT_EQ(middle(frame.beauty)[k], expected) << int(blend);
        }
    }
}

TEST(Isolate, BeforeTheMergedLayersMeansBehind) {
    const ShadedSplats near_set = make_splats({{{0.0f, 0.0f, 50.0f}, 14.0f, 1.0f, {1.0f, 0.0f, 0.0f}}});
    const ShadedSplats far_set = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 1.0f, {0.0f, 1.0f, 0.0f}}});
    RenderLayer isolated = layer_of("near", near_set);
    isolated.render.isolate = true;
    EXPECT_EQ(middle(render_layers({isolated, layer_of("far", far_set)}).beauty)[1], 1.0f);
    EXPECT_EQ(middle(render_layers({layer_of("far", far_set), isolated}).beauty)[0], 1.0f);
}

RenderSettings with_aovs() {
    RenderSettings settings = settings_of(size_px, size_px);
    settings.aov_depth = settings.aov_coverage = settings.aov_count = settings.aov_layers = true;
    return settings;
}

TEST(Aov, LayersAndEnvironmentSumToTheBeauty) {
    std::vector<OneSplat> a, b, c;
    for (int i = 0; i < 60; ++i) {
        const float t = float(i);
        const glm::vec3 p(std::fmod(t * 7.3f, 24.0f) - 12.0f, std::fmod(t * 3.1f, 24.0f) - 12.0f,
                          std::fmod(t * 5.7f, 40.0f));
        (i % 3 == 0   ? a
         : i % 3 == 1 ? b
                      : c)
            .push_back({p, 5.0f, 0.3f, {0.2f + 0.01f * t, 0.5f, 1.1f - 0.01f * t}});
    }
    const ShadedSplats sa = make_splats(a), sb = make_splats(b), sc = make_splats(c);
    const Environment environment = grey_environment(0.125f);
    for (const Blend blend : {Blend::over, Blend::add, Blend::screen, Blend::lighten, Blend::hybrid}) {
        std::vector<RenderLayer> layers = {layer_of("a", sa, Blend::over, Falloff::Shape::gaussian),
                                           layer_of("b", sb, Blend::screen, Falloff::Shape::linear),
                                           layer_of("c", sc, blend)};
        layers[2].render.isolate = true;
        const RenderedFrame plain =
            render(layers, pixel_camera(size_px, size_px), &environment, settings_of(size_px, size_px));
        const RenderedFrame frame = render(layers, pixel_camera(size_px, size_px), &environment, with_aovs());
        EXPECT_EQ(plain.beauty.pixels, frame.beauty.pixels);
        const Environment black = grey_environment(0.0f);
        const RenderedFrame lit = render(layers, pixel_camera(size_px, size_px), &black, with_aovs());
        for (std::size_t i = 0; i < frame.beauty.pixels.size(); ++i) {
            if (i % 4 == 3) continue;
            double sum = 0.0;
            for (const Image& layer : lit.layers) sum += layer.pixels[i];
            EXPECT_NEAR(sum, lit.beauty.pixels[i], 2e-6);
        }
    }
}

TEST(Aov, DepthCoverageAndCount) {
    const Pair pair;
    const ShadedSplats splats = make_splats({pair.near_splat, pair.far_splat});
    const RenderedFrame frame = render(std::vector<RenderLayer>{layer_of("both", splats)},
                                       pixel_camera(size_px, size_px), nullptr, with_aovs());
    const double near_share = 0.25, far_share = 0.75 * 0.5;
    EXPECT_NEAR(middle(frame.depth)[0], (near_share * 990.0 + far_share * 1010.0) / (near_share + far_share),
                1e-2);
    EXPECT_EQ(middle(frame.coverage)[0], 1.0f);
    EXPECT_EQ(middle(frame.count)[0], 2.0f);
    EXPECT_EQ(*frame.depth.at(0, 0), 0.0f);
    EXPECT_EQ(*frame.coverage.at(0, 0), 0.0f);
    EXPECT_EQ(*frame.count.at(0, 0), 0.0f);
}

TEST(Statistics, MeanOverlapIsOfCoveredPixels) {
    const ShadedSplats splats = make_splats({{{0.0f, 0.0f, 0.0f}, 6.0f}, {{1.0f, 0.0f, 0.0f}, 3.0f}});
    const RenderLayer layer = layer_of("one", splats);
    const RenderedFrame frame = render({&layer, 1}, pixel_camera(32, 32), nullptr, settings_of(32, 32));
    int covered = 0;
    for (std::int64_t i = 0; i < 32 * 32; ++i) covered += frame.beauty.pixels[std::size_t(4 * i)] > 0.0f;
    EXPECT_NEAR(frame.statistics.mean_overlap, real::pi * (36.0 + 9.0) / covered, 1e-9);
    const RenderedFrame empty = render({}, pixel_camera(32, 32), nullptr, settings_of(32, 32));
    EXPECT_EQ(empty.statistics.mean_overlap, 0.0);
}

TEST(Environment, IsTheBottomAndMakesAlphaOne) {
    const ShadedSplats splats = make_splats({{{0.0f, 0.0f, 0.0f}, 14.0f, 0.25f, {1.0f, 0.5f, 0.0f}}});
    const Environment environment = grey_environment(0.5f);
    const RenderedFrame frame = render_layers({layer_of("one", splats)}, &environment);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[0], 0.25f + 0.75f * 0.5f);
    EXPECT_FLOAT_EQ(middle(frame.beauty)[2], 0.75f * 0.5f);
    EXPECT_EQ(middle(frame.beauty)[3], 1.0f);
    EXPECT_EQ(frame.beauty.at(0, 0)[1], 0.5f);
    EXPECT_EQ(frame.beauty.at(0, 0)[3], 1.0f);
}

}  // namespace
}  // namespace astrosplat
