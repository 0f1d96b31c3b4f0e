// Maps and reworked pictures by closed form: excesses over a known continuum, a dip in even light, blurs.
#include "source/derived_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/real.h"
#include "source/sample.h"
#include "source/textured_mesh.h"
#include "support/temp_folder.h"

namespace astrosplat {
namespace {

using Alpha = TextureSettings::Alpha;
using Wrap = TextureSettings::Wrap;

// Light of one colour, its strength rising from left to right.
Image slope(const glm::vec3& color, std::int64_t side = 64) {
    Image light = make_image(side, side, 4, 1.0f);
    for (std::int64_t y = 0; y < side; ++y)
        for (std::int64_t x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c)
                light.at(x, y)[c] =
                    color[c] * (0.2f + 0.8f * static_cast<float>(x) / static_cast<float>(side));
    return light;
}

TEST(DerivedPicture, HAlphaIsTheShareOfRedBeyondTheContinuum) {
    Image light = slope({0.3f, 0.5f, 0.1f});
    const float red = light.at(40, 10)[0];
    light.at(40, 10)[0] += 0.25f;
    const Image map = derived_picture(light, Derived::h_alpha);
    EXPECT_NEAR(*map.at(40, 10), 0.25f / (red + 0.252f), 1e-5f);
    EXPECT_NEAR(*map.at(39, 10), 0.0f, 1e-5f);
    light.at(40, 10)[0] = 0.0f;  // less than the continuum is no line
    EXPECT_EQ(*derived_picture(light, Derived::h_alpha).at(40, 10), 0.0f);
}

TEST(DerivedPicture, YoungStarsAreTheShareOfBlueBeyondTheContinuum) {
    Image light = slope({0.3f, 0.2f, 0.1f});
    const float blue = light.at(40, 10)[2];
    light.at(40, 10)[2] += 0.25f;
    const Image map = derived_picture(light, Derived::young_stars);
    EXPECT_NEAR(*map.at(40, 10), 0.25f / (blue + 0.252f), 1e-5f);
    EXPECT_NEAR(*map.at(10, 40), 0.0f, 1e-5f);
}

TEST(DerivedPicture, FaintNoiseIsNoExcess) {
    Image light = slope({0.3f, 0.3f, 0.3f});
    for (int c = 0; c < 3; ++c) light.at(5, 5)[c] = 0.0f;
    light.at(5, 5)[0] = 1e-5f;
    EXPECT_LT(*derived_picture(light, Derived::h_alpha).at(5, 5), 0.01f);
}

TEST(DerivedPicture, EvenLightHasNoDustAndADarkLaneIsAbsorbed) {
    const std::int64_t width = 1024, height = 64;
    Image light = make_image(width, height, 4, 0.5f);
    const Image even = derived_picture(light, Derived::dust);
    // The deviation is the root of a difference of squares, which are blurred in 32 bits.
    for (const float v : even.pixels) ASSERT_NEAR(v, 0.0f, 1e-3f);
    // A lane that takes 60 % in its middle, 3 px wide: narrow against the coarse bands, which fill it.
    for (std::int64_t y = 0; y < height; ++y) {
        for (std::int64_t x = 0; x < width; ++x) {
            const double t = static_cast<double>(x - width / 2) / 3.0;
            for (int c = 0; c < 3; ++c)
                light.at(x, y)[c] *= static_cast<float>(1.0 - 0.6 * real::exp(-0.5 * t * t));
        }
    }
    const Image lane = derived_picture(light, Derived::dust);
    EXPECT_NEAR(*lane.at(width / 2, 30), 0.6f, 0.1f);
    EXPECT_LT(*lane.at(30, 30), 0.02f);
    double inside = 0.0, outside = 0.0;
    for (std::int64_t x = 0; x < width; ++x)
        (std::abs(x - width / 2) < 12 ? inside : outside) += static_cast<double>(*lane.at(x, 30));
    EXPECT_GT(inside, 4.0 * outside);
}

// ---- what load_texture makes of them

std::string ppm(int side, const std::function<glm::ivec3(int x, int y)>& color) {
    std::string text = "P6\n" + std::to_string(side) + " " + std::to_string(side) + "\n255\n";
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c) text += static_cast<char>(color(x, y)[c]);
    return text;
}

TextureSettings linear_settings(Alpha alpha) {
    TextureSettings settings;
    settings.colorspace = TextureSettings::Colorspace::linear;
    settings.alpha = alpha;
    return settings;
}

TEST(ReworkedTexture, SmoothIsAGaussianOfTheWidthAndKeepsTheLight) {
    const TempFolder folder;
    const auto file = folder.file("dot.ppm", ppm(64, [](int x, int y) {
                                      return x == 32 && y == 32 ? glm::ivec3(255) : glm::ivec3(0);
                                  }));
    TextureSettings settings = linear_settings(Alpha::max);
    settings.smooth = 3.0 / 64.0;
    const Image blurred = load_texture({file}, settings, Wrap::clamp).image;
    double sum = 0.0;
    for (std::int64_t i = 0; i < 64 * 64; ++i) sum += static_cast<double>(blurred.pixels[4 * i]);
    EXPECT_NEAR(sum, 1.0, 1e-4);
    EXPECT_NEAR(blurred.at(32, 32)[0], 1.0 / (2.0 * real::pi * 9.0), 2e-4);
    EXPECT_NEAR(blurred.at(35, 32)[0] / blurred.at(32, 32)[0], real::exp(-0.5), 1e-3);
    EXPECT_EQ(blurred.at(35, 32)[3], blurred.at(35, 32)[0]) << "alpha follows the light it is made of";
}

TEST(ReworkedTexture, DetailIsWhatSmoothTakesAway) {
    const TempFolder folder;
    const auto file = folder.file(
        "dots.ppm", ppm(64, [](int x, int y) { return glm::ivec3(x % 9 == 0 && y % 7 == 0 ? 200 : 40); }));
    TextureSettings settings = linear_settings(Alpha::one);
    const Image whole = load_texture({file}, settings, Wrap::clamp).image;
    settings.smooth = 0.05;
    const Image smooth = load_texture({file}, settings, Wrap::clamp).image;
    settings.smooth = 0.0;
    settings.detail = 0.05;
    const Image detail = load_texture({file}, settings, Wrap::clamp).image;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        const bool is_alpha = i % 4 == 3;
        ASSERT_EQ(detail.pixels[i], is_alpha ? 1.0f : std::max(0.0f, whole.pixels[i] - smooth.pixels[i]));
    }
}

TEST(ReworkedTexture, AMapIsAGreyPictureUnderTheRulesOfAlpha) {
    const TempFolder folder;
    const auto file = folder.file(
        "red.ppm", ppm(32, [](int x, int) { return x == 3 ? glm::ivec3(200, 50, 50) : glm::ivec3(50); }));
    TextureSettings settings = linear_settings(Alpha::max);
    settings.derive = Derived::h_alpha;
    const float share = 150.0f / (200.0f + 0.002f * 255.0f);
    const Texture made = load_texture({file}, settings, Wrap::clamp);
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(made.image.at(3, 3)[c], share, 1e-5f);
    settings.alpha = Alpha::one;
    const Texture opaque = load_texture({file}, settings, Wrap::clamp);
    EXPECT_NEAR(opaque.image.at(3, 3)[1], share, 1e-5f);
    EXPECT_EQ(opaque.image.at(3, 3)[3], 1.0f);
    EXPECT_EQ(opaque.image.at(9, 9)[3], 1.0f);
}

TEST(ReworkedTexture, MasksMultiplyAlphaAndKeepColor) {
    const TempFolder folder;
    const auto file = folder.file("p.ppm", ppm(32, [](int x, int) { return glm::ivec3(8 * x, 100, 30); }));
    TextureSettings settings = linear_settings(Alpha::max);
    const Texture plain = load_texture({file}, settings, Wrap::clamp);
    settings.mask.resize(1);
    settings.mask[0].ellipse = {0.5, 0.5, 0.25, 0.25};
    settings.mask[0].feather = 0.2;
    Texture masked = load_texture({file}, settings, Wrap::clamp);
    EXPECT_EQ(masked.image.pixels, plain.image.pixels) << "not before apply_mask";
    const Image weights = masked.mask;
    apply_mask(masked);
    EXPECT_TRUE(masked.mask.pixels.empty());
    for (std::int64_t i = 0; i < 32 * 32; ++i)
        ASSERT_EQ(masked.image.pixels[4 * i + 3], plain.image.pixels[4 * i + 3] * weights.pixels[i]);
    const glm::vec2 uv(0.7f, 0.6f);
    EXPECT_NEAR(sample(masked, uv).color.x, sample(plain, uv).color.x, 1e-2f);
}

TEST(ReworkedTexture, MasksLeaveTheShapeOfAReliefAlone) {
    const TempFolder folder;
    SourceParams source;
    source.meshes = {
        {"relief",
         {folder.file("p.ppm", ppm(32, [](int x, int y) { return glm::ivec3(8 * x, 8 * y, 9); }))},
         0.15}};
    const std::vector<TexturedMesh> whole = load_meshes(source);
    source.texture.mask.resize(1);
    source.texture.mask[0].luminance = {0.5, 1.0};
    const std::vector<TexturedMesh> masked = load_meshes(source);
    EXPECT_EQ(masked[0].mesh.positions, whole[0].mesh.positions);
    EXPECT_EQ(sample(masked[0].textures[0], {0.1f, 0.9f}).alpha, 0.0f);
    EXPECT_GT(sample(whole[0].textures[0], {0.1f, 0.9f}).alpha, 0.0f);
}

}  // namespace
}  // namespace astrosplat
