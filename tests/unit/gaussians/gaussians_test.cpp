// Dots as Gaussians: the integral by summing over a fine grid, blends by hand, and fewer splats with the same
// light.
#include "gaussians/gaussians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/color.h"
#include "render/footprint.h"
#include "render/render.h"

namespace astrosplat::test {
namespace {

Falloff falloff_of(Falloff::Shape shape, float sharpness = 4.5f) {
    Falloff falloff;
    falloff.shape = shape;
    falloff.sharpness = sharpness;
    return falloff;
}

/// Sum of f(r) over a grid of the square from -6 to 6.
template <class F>
double sum_over_plane(F&& f) {
    constexpr double step = 0.01;
    double sum = 0.0;
    for (double y = -6.0 + step / 2; y < 6.0; y += step)
        for (double x = -6.0 + step / 2; x < 6.0; x += step) sum += f(std::hypot(x, y)) * step * step;
    return sum;
}

ShadedSplats one_splat(const glm::vec3& color, float alpha, float radius = 1.0f) {
    ShadedSplats splats;
    splats.position.push_back({1.0f, 2.0f, 3.0f});
    splats.color.push_back(color);
    splats.alpha.push_back(alpha);
    splats.radius.push_back(radius);
    splats.id.push_back(0);
    return splats;
}

struct One {
    Gaussians gaussians;
    BakeCounts counts;
    double peak;
};

One baked(const ShadedSplats& splats, const LayerRender& render, double gain = 1.0) {
    RenderLayer layer;
    layer.splats = &splats;
    layer.render = render;
    layer.scale = 2.0;
    layer.translate = {0.0, 0.0, -1.0};
    One one;
    one.peak = nearest_gaussian(render.falloff).peak;
    bake_layer(layer, Camera{}, gain, one.gaussians, one.counts);
    return one;
}

LayerRender blend_of(Blend blend) {
    LayerRender render;
    render.blend = blend;
    return render;
}

TEST(Gaussians, HaveTheIntegralOfTheDot) {
    for (const Falloff& falloff :
         {falloff_of(Falloff::Shape::constant), falloff_of(Falloff::Shape::linear),
          falloff_of(Falloff::Shape::trapezoid), falloff_of(Falloff::Shape::gaussian),
          falloff_of(Falloff::Shape::gaussian, 20.0f), falloff_of(Falloff::Shape::exponential, 6.0f)}) {
        const GaussianProfile g = nearest_gaussian(falloff);
        const double dot = sum_over_plane([&](double r) { return falloff_value(falloff, r); });
        const double gaussian =
            sum_over_plane([&](double r) { return g.peak * std::exp(-r * r / (2 * g.sigma * g.sigma)); });
        EXPECT_NEAR(gaussian / dot, 1.0, 2e-3) << int(falloff.shape);
    }
}

TEST(Gaussians, OfAConstantDotHasALogarithmInClosedForm) {
    const GaussianProfile g = nearest_gaussian(falloff_of(Falloff::Shape::constant));
    EXPECT_NEAR(g.peak, std::log(4.0), 1e-5);
    EXPECT_NEAR(g.sigma, std::sqrt(0.5 / std::log(4.0)), 1e-5);
}

TEST(Gaussians, OfAGaussianDotIsNearlyItself) {
    const GaussianProfile g = nearest_gaussian(falloff_of(Falloff::Shape::gaussian, 20.0f));
    EXPECT_NEAR(g.peak, 1.0, 1e-4);
    EXPECT_NEAR(g.sigma, std::sqrt(0.5 / 20.0), 1e-4);
}

TEST(Gaussians, StandWhereTheLayerPutsThem) {
    const One one = baked(one_splat({0.5f, 0.25f, 0.125f}, 0.5f, 0.5f), blend_of(Blend::over));
    ASSERT_EQ(one.gaussians.size(), 1);
    EXPECT_EQ(one.gaussians.position[0], glm::vec3(2.0f, 4.0f, 5.0f));
    EXPECT_NEAR(one.gaussians.scale[0].x, nearest_gaussian(Falloff{}).sigma, 1e-6);  // radius 0.5, scale 2
    EXPECT_NEAR(one.gaussians.alpha[0], 0.5 * one.peak, 1e-6);
    EXPECT_NEAR(one.gaussians.color[0].y, 0.25f, 1e-6);
}

TEST(Gaussians, OfOpaqueDiscsAreWiderInsteadOfMoreThanOpaque) {
    LayerRender render;
    render.falloff = falloff_of(Falloff::Shape::constant);
    const One one = baked(one_splat(glm::vec3(0.5f), 1.0f, 0.5f), render);
    EXPECT_EQ(one.gaussians.alpha[0], 1.0f);
    EXPECT_NEAR(2.0 * std::numbers::pi * std::pow(one.gaussians.scale[0].x, 2.0), std::numbers::pi, 1e-4);
    EXPECT_NEAR(one.gaussians.color[0].x, 0.5f, 1e-6);
    EXPECT_EQ(one.counts.lost, 0.0);
}

TEST(Gaussians, RaiseAlphaForBrightColoursAndCountWhatIsLost) {
    const One fits = baked(one_splat({1.5f, 0.75f, 0.0f}, 0.1f), blend_of(Blend::over), 2.0);
    EXPECT_NEAR(fits.gaussians.alpha[0], 0.3 * fits.peak, 1e-6);
    EXPECT_NEAR(fits.gaussians.color[0].x, 1.0f, 1e-6);
    EXPECT_NEAR(fits.gaussians.color[0].y, 0.5f, 1e-6);
    EXPECT_EQ(fits.counts.bright, 0);
    EXPECT_EQ(fits.counts.share_lost(), 0.0);
    const One clipped = baked(one_splat(glm::vec3(4.0f), 0.8f), blend_of(Blend::over));
    EXPECT_EQ(clipped.gaussians.alpha[0], 1.0f);
    EXPECT_EQ(clipped.counts.bright, 1);
    EXPECT_NEAR(clipped.counts.share_lost(), 1.0 - 1.0 / (0.8 * clipped.peak * 4.0), 1e-5);
}

TEST(Gaussians, HideWhatTheBlendHides) {
    const ShadedSplats splats = one_splat({0.5f, 0.25f, 0.0f}, 0.4f);
    for (const Blend blend : {Blend::add, Blend::screen}) {  // the least that shows the light
        const One one = baked(splats, blend_of(blend));
        EXPECT_NEAR(one.gaussians.alpha[0], 0.2 * one.peak, 1e-6);
        EXPECT_NEAR(one.gaussians.color[0].y, 0.5f, 1e-6);
    }
    const One dust = baked(splats, blend_of(Blend::absorb));
    EXPECT_EQ(dust.gaussians.color[0], glm::vec3(0.0f));
    EXPECT_EQ(dust.counts.dust, 1);
    EXPECT_EQ(baked(one_splat(glm::vec3(0.0f), 0.4f), blend_of(Blend::add)).counts.unseen, 1);
}

ShadedSplats cloud(int count, float alpha) {
    ShadedSplats splats;
    for (int i = 0; i < count; ++i) {
        const double turn = i * 2.399963, r = 0.9 * std::sqrt((i + 0.5) / count);
        splats.position.push_back(glm::vec3(r * std::cos(turn), r * std::sin(turn), 0.3 * std::sin(i * 1.7)));
        splats.color.push_back(glm::vec3(0.8f, 0.5f, 0.3f));
        splats.alpha.push_back(alpha);
        splats.radius.push_back(0.25f);
        splats.id.push_back(std::uint64_t(i));
    }
    return splats;
}

double light_of(const ShadedSplats& splats) {
    double light = 0.0;
    for (std::size_t i = 0; i < splats.id.size(); ++i)
        light += splats.alpha[i] * std::pow(splats.radius[i], 2.0) * splats.color[i].y;
    return light;
}

TEST(Gaussians, FewerHaveTheSameLight) {
    const ShadedSplats many = cloud(3000, 0.01f);
    RenderLayer layer;
    layer.splats = &many;
    layer.render.blend = Blend::add;
    layer.render.opacity = 0.5f;
    const auto reduced = reduce_splats({&layer, 1}, glm::dmat3(1.0), 200);
    EXPECT_LE(reduced.front().size(), 200);
    EXPECT_GE(reduced.front().size(), 100);
    EXPECT_NEAR(light_of(reduced.front()) / (0.5 * light_of(many)), 1.0, 1e-4);
    EXPECT_EQ(reduce_splats({&layer, 1}, glm::dmat3(1.0), 3000).front().size(), 3000);
    layer.render.lod = {1.0f, 64, 1.0f};  // a camera's
    EXPECT_EQ(reduce_splats({&layer, 1}, glm::dmat3(1.0), 200).front().color, reduced.front().color);
}

/// Root of the mean square of display differences between two frames in linear light and encoded light.
double display_difference(const Image& linear, const Image& encoded) {
    double sum = 0.0;
    for (std::size_t i = 0; i < linear.pixels.size(); ++i)
        sum += std::pow(double(display_srgb(linear.pixels[i])) - double(encoded.pixels[i]), 2.0);
    return std::sqrt(sum / double(linear.pixels.size()));
}

TEST(Gaussians, EncodedAreFittedToTheFrame) {
    const ShadedSplats splats = cloud(600, 0.02f);
    RenderLayer layer;
    layer.splats = &splats;
    CameraParams params;
    params.position = glm::dvec3(0.0, 0.0, 4.0);
    const Camera camera = make_camera(params, 96.0, 96.0, {});
    RenderSettings settings;
    settings.width = settings.height = 96;
    const Image wanted = render({&layer, 1}, camera, nullptr, settings).beauty;
    Gaussians gaussians;
    BakeCounts counts;
    bake_layer(layer, camera, 1.0, gaussians, counts);
    encode_for_display(gaussians);
    const auto seen = [&] {
        ShadedSplats drawn = splats;
        drawn.color = gaussians.color;
        drawn.alpha = gaussians.alpha;
        drawn.radius.clear();
        for (const glm::vec3& scale : gaussians.scale) drawn.radius.push_back(scale.x);
        for (float& radius : drawn.radius) radius *= 4.0f;
        RenderLayer as_gaussians;
        as_gaussians.splats = &drawn;
        as_gaussians.render.falloff.sharpness = 8.0f;
        Image image = render({&as_gaussians, 1}, camera, nullptr, settings).beauty;
        for (std::size_t i = 3; i < image.pixels.size(); i += 4)
            image.pixels[i] = display_srgb(wanted.pixels[i]);  // alpha is no light
        return image;
    };
    EXPECT_GT(display_difference(wanted, seen()), 0.05);
    fit_to_view(gaussians, wanted, camera, settings);
    EXPECT_LT(display_difference(wanted, seen()), 0.01);  // 40 dB
}

}  // namespace
}  // namespace astrosplat::test
