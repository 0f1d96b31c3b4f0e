// Pictures made of pictures: maps, reworked ones, masks, and a sky of cut-outs.
#include "core/color.h"
#include "detect/parts.h"
#include "source/texture.h"
#include "source/textured_mesh.h"
#include "source/tiled_sky.h"
#include "support/painted_picture.h"
#include "support/pixmap.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Maps and reworked pictures by closed form: excesses over a known continuum, a dip in even light, blurs.

using Alpha = TextureSettings::Alpha;
using Wrap = TextureSettings::Wrap;

// Light of one colour, its strength rising from left to right.
Image slope(const glm::vec3& color, std::int64_t side = 64) {
    Image light = make_image(side, side, 4, 1.0f);
    for (std::int64_t y = 0; y < side; ++y)
        for (std::int64_t x = 0; x < side; ++x)
            for (int c = 0; c < 3; ++c) light.at(x, y)[c] = color[c] * (0.2f + 0.8f * float(x) / float(side));
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
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const double t = double(x - width / 2) / 3.0;
            for (int c = 0; c < 3; ++c) light.at(x, y)[c] *= float(1.0 - 0.6 * real::exp(-0.5 * t * t));
        }
    const Image lane = derived_picture(light, Derived::dust);
    EXPECT_NEAR(*lane.at(width / 2, 30), 0.6f, 0.1f);
    EXPECT_LT(*lane.at(30, 30), 0.02f);
    double inside = 0.0, outside = 0.0;
    for (std::int64_t x = 0; x < width; ++x)
        (std::abs(x - width / 2) < 12 ? inside : outside) += double(*lane.at(x, 30));
    EXPECT_GT(inside, 4.0 * outside);
}

// ---- what load_texture makes of them

std::string ppm(int side, const std::function<glm::ivec3(int x, int y)>& color) {
    return test::pixmap(side, side, [&](int x, int y, int k) { return color(x, y)[k]; });
}

TextureSettings linear_settings(Alpha alpha) {
    TextureSettings settings;
    settings.colorspace = TextureSettings::Colorspace::linear;
    settings.alpha = alpha;
    return settings;
}

class ReworkedTextureTest : public testing::Test {
  protected:
    const TempFolder folder;
};

TEST_F(ReworkedTextureTest, SmoothIsAGaussianOfTheWidthAndKeepsTheLight) {
    const auto file = folder.file("dot.ppm", ppm(64, [](int x, int y) {
                                      return x == 32 && y == 32 ? glm::ivec3(255) : glm::ivec3(0);
                                  }));
    TextureSettings settings = linear_settings(Alpha::max);
    settings.smooth = 3.0 / 64.0;
    const Image blurred = load_texture({file}, settings, Wrap::clamp).image;
    double sum = 0.0;
    for (std::int64_t i = 0; i < 64 * 64; ++i) sum += double(blurred.pixels[4 * i]);
    EXPECT_NEAR(sum, 1.0, 1e-4);
    EXPECT_NEAR(blurred.at(32, 32)[0], 1.0 / (2.0 * real::pi * 9.0), 2e-4);
    EXPECT_NEAR(blurred.at(35, 32)[0] / blurred.at(32, 32)[0], real::exp(-0.5), 1e-3);
    EXPECT_EQ(blurred.at(35, 32)[3], blurred.at(35, 32)[0]) << "alpha follows the light it is made of";
}

TEST_F(ReworkedTextureTest, DetailIsWhatSmoothTakesAway) {
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

TEST_F(ReworkedTextureTest, AMapIsAGreyPictureUnderTheRulesOfAlpha) {
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

TEST_F(ReworkedTextureTest, MasksMultiplyAlphaAndKeepColor) {
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

TEST_F(ReworkedTextureTest, MasksLeaveTheShapeOfAReliefAlone) {
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

// Masks by closed form: areas of ellipses, ranges of luminance, wedges of hue, and how they combine.

constexpr int side = 200;  // px

Image grey(std::int64_t width, std::int64_t height, float value = 0.5f) {
    return make_image(width, height, 4, value);
}

// One row whose pixel i is displayed as `color(i)`, 0..1 a channel.
template <class Color>
Image row_of(int width, const Color& color) {
    Image row = make_image(width, 1, 4, 1.0f);
    for (int x = 0; x < width; ++x) {
        const glm::dvec3 c = color(x);
        for (int k = 0; k < 3; ++k) row.at(x, 0)[k] = float(real::srgb_to_linear(c[k]));
    }
    return row;
}

glm::dvec3 hue_color(double degrees) {
    const auto channel = [&](double peak) {
        const double off = std::fabs(std::remainder(degrees - peak, 360.0));
        return std::clamp(2.0 - off / 60.0, 0.0, 1.0);
    };
    return {channel(0.0), channel(120.0), channel(240.0)};
}

double sum(const Image& weights) {
    double total = 0.0;
    for (const float w : weights.pixels) total += double(w);
    return total;
}

MaskParams ellipse_mask(const glm::dvec4& ellipse, double feather = 0.0, double turn = 0.0) {
    MaskParams mask;
    mask.ellipse = ellipse;
    mask.feather = feather;
    mask.turn = turn;
    return mask;
}

TEST(Mask, NoMaskAndAMaskWithoutTermsShowEverything) {
    EXPECT_EQ(sum(mask_weights(grey(3, 2), {})), 6.0);
    EXPECT_EQ(sum(mask_weights(grey(3, 2), std::vector<MaskParams>(2))), 6.0);
}

TEST(Mask, CircleAndEllipseHaveTheirArea) {
    const double a = 0.25 * side, b = 0.1 * side;
    const auto area = [](const MaskParams& mask) {
        return sum(mask_weights(grey(side, side), std::vector{mask}));
    };
    EXPECT_NEAR(area(ellipse_mask({0.5, 0.5, 0.25, 0.25})), real::pi * a * a, 0.005 * real::pi * a * a);
    EXPECT_NEAR(area(ellipse_mask({0.45, 0.52, 0.25, 0.1}, 0.0, 33.0)), real::pi * a * b,
                0.005 * real::pi * a * b);
    // A linear ramp of width f about radius a holds pi (a^2 + f^2 / 12).
    const double f = 0.3 * side;
    const double soft = real::pi * (a * a + f * f / 12.0);
    EXPECT_NEAR(area(ellipse_mask({0.5, 0.5, 0.25, 0.25}, 0.3)), soft, 0.001 * soft);
}

TEST(Mask, EllipsesLieInPictureWidthsFromTheBottomLeftAndTurnCounterClockwise) {
    const Image light = grey(100, 50);
    const auto weights = [&](const glm::dvec4& ellipse, double turn) {
        return mask_weights(light, std::vector{ellipse_mask(ellipse, 0.0, turn)});
    };
    const Image circle = weights({0.25, 0.8, 0.08, 0.08}, 0.0);  // centre at (25, 10) px from the top
    EXPECT_EQ(*circle.at(25, 3), 1.0f);
    EXPECT_EQ(*circle.at(25, 16), 1.0f);
    EXPECT_EQ(*circle.at(25, 19), 0.0f);
    EXPECT_EQ(*circle.at(18, 10), 1.0f);
    EXPECT_EQ(*circle.at(16, 10), 0.0f);
    const Image turned = weights({0.5, 0.5, 0.2, 0.02}, 45.0);  // up to the right
    EXPECT_EQ(*turned.at(60, 14), 1.0f);
    EXPECT_EQ(*turned.at(60, 35), 0.0f);
}

TEST(Mask, LuminanceIsARampAboutItsEndsAndOpenAtZeroAndOne) {
    constexpr int width = 101;
    const Image row = row_of(width, [](int x) { return glm::dvec3(x / 100.0); });
    MaskParams mask;
    mask.luminance = {0.25, 0.75};
    mask.feather = 0.1;
    const Image weights = mask_weights(row, std::vector{mask});
    for (int x = 0; x < width; ++x) {
        const double up = std::clamp(0.5 + (x / 100.0 - 0.25) / 0.1, 0.0, 1.0);
        const double down = std::clamp(0.5 + (0.75 - x / 100.0) / 0.1, 0.0, 1.0);
        EXPECT_NEAR(*weights.at(x, 0), up * down, 1e-4) << x;
    }
    mask.luminance = {0.0, 0.5};
    EXPECT_EQ(*mask_weights(row, std::vector{mask}).at(0, 0), 1.0f);
    mask.luminance = {0.5, 1.0};
    EXPECT_EQ(*mask_weights(grey(1, 1, 7.0f), std::vector{mask}).at(0, 0), 1.0f);
}

TEST(Mask, HuesAreAWedgeThatMayPassRed) {
    const Image row = row_of(360, [](int x) { return hue_color(x); });
    MaskParams mask;
    mask.hue = {330.0, 30.0};
    const Image wedge = mask_weights(row, std::vector{mask});
    for (int x = 0; x < 360; ++x) {
        if (x % 30 == 0) continue;  // on the border
        EXPECT_EQ(*wedge.at(x, 0), x < 30 || x > 330 ? 1.0f : 0.0f) << x;
    }
    mask.hue = {100.0, 140.0};
    mask.feather = 10.0 / 360.0;
    const Image soft = mask_weights(row, std::vector{mask});
    for (int x = 0; x < 360; ++x)
        EXPECT_NEAR(*soft.at(x, 0), std::clamp(0.5 + (20.0 - std::abs(x - 120)) / 10.0, 0.0, 1.0), 2e-3) << x;
    EXPECT_EQ(sum(mask_weights(grey(4, 4), std::vector{mask})), 0.0) << "grey has no hue";
    mask.hue = {0.0, 360.0};
    EXPECT_EQ(sum(mask_weights(row, std::vector{mask})), 360.0);
}

TEST(Mask, SaturationIsThatOfTheDisplayedColor) {
    const Image row = row_of(101, [](int x) { return glm::dvec3(0.8, 0.8 * (1.0 - x / 100.0), 0.8); });
    MaskParams mask;
    mask.saturation = {0.4, 1.0};
    const Image weights = mask_weights(row, std::vector{mask});
    EXPECT_EQ(*weights.at(39, 0), 0.0f);
    EXPECT_EQ(*weights.at(41, 0), 1.0f);
    EXPECT_EQ(*weights.at(100, 0), 1.0f);
}

TEST(Mask, ListsMultiplyAlternativesTakeTheLargestInvertTurnsOver) {
    const Image light = grey(100, 100);
    const MaskParams left = ellipse_mask({0.35, 0.5, 0.2, 0.2}), right = ellipse_mask({0.65, 0.5, 0.2, 0.2});
    const double one = sum(mask_weights(light, std::vector{left}));
    const double both = sum(mask_weights(light, std::vector{left, right}));
    // Two circles of radius r at a distance d share 2 r^2 acos(d / 2r) - d/2 sqrt(4 r^2 - d^2).
    const double r = 20.0, d = 30.0;
    EXPECT_NEAR(both, 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d), 5.0);
    MaskParams either;
    either.any = {left, right};
    EXPECT_EQ(sum(mask_weights(light, std::vector{either})), 2 * one - both);
    either.invert = true;
    EXPECT_EQ(sum(mask_weights(light, std::vector{either})), 1e4 - (2 * one - both));
    either.invert = false;
    either.any[0].invert = true;
    EXPECT_EQ(sum(mask_weights(light, std::vector{either})), 1e4 - one + both);
}

TEST(Mask, AnImageCoversTheTextureWhateverItsSize) {
    const TempFolder folder;
    MaskParams mask;
    mask.image = folder.file("half.pgm", "P2 2 2 255\n255 0\n255 0\n");
    const Image weights = mask_weights(grey(80, 30), std::vector{mask});
    EXPECT_EQ(*weights.at(0, 10), 1.0f);
    EXPECT_EQ(*weights.at(79, 10), 0.0f);
    EXPECT_NEAR(sum(weights), 0.5 * 80 * 30, 1e-3);
    mask.image = folder / "none.pgm";
    EXPECT_HAS(ERROR_OF(mask_weights(grey(2, 2), std::vector{mask})), "none.pgm");
}

TEST(Mask, AMapWeighsByItsValueOrByTheRangeOfLuminance) {
    Image light = grey(64, 64, 0.2f);  // grey, and one pixel that is redder by half of its red
    light.at(20, 30)[0] = 0.4f;
    MaskParams mask;
    mask.derive = Derived::h_alpha;
    EXPECT_NEAR(sum(mask_weights(light, std::vector{mask})), 0.2 / 0.402, 1e-6);
    mask.luminance = {0.3, 1.0};
    EXPECT_EQ(sum(mask_weights(light, std::vector{mask})), 1.0);
    mask.luminance = {0.6, 1.0};
    EXPECT_EQ(sum(mask_weights(light, std::vector{mask})), 0.0);
}

// A sky of cut-outs: as much light and as many objects as the picture has, none of them cut, and neighbours
// that show different parts of it.

constexpr std::int64_t picture_px = 240;
constexpr int galaxies = 30;
constexpr double sigma_px = 1.6, peak = 0.5, sky = 0.02;

// Galaxies apart from each other on a sky with a little grain.
Image deep_field() {
    Image image = make_image(picture_px, picture_px, 3);
    for (std::int64_t y = 0; y < picture_px; ++y)
        for (std::int64_t x = 0; x < picture_px; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = float(sky + 0.002 * double(painted::fbm(double(x), double(y), 0.31, 9u)));
    for (int n = 0; n < galaxies; ++n) {
        const double x = 14.0 + 40.0 * (n % 6) + 12.0 * painted::random(std::uint32_t(n), 71),
                     y = 18.0 + 46.0 * (n / 6) + 12.0 * painted::random(std::uint32_t(n), 72);
        painted::add_point(image, x, y, sigma_px, peak, 0.8 * peak, 0.6 * peak);
    }
    return image;
}

SkyTiling small_tiling(std::uint32_t seed = 1) { return {60.0, seed, 256}; }

double solid_angle(double x, double y, double n) {
    const double s = 2.0 * x / n - 1.0, t = 2.0 * y / n - 1.0, square = 1.0 + s * s + t * t;
    return 4.0 / (n * n * square * std::sqrt(square));
}

TEST(TiledSky, HasThePicturesLightAndItsObjectsWholeAndAsMany) {
    const Image picture = deep_field();
    double light = 0.0, of_picture = 0.0, all = 0.0;
    int found = 0, cut = 0;
    // A galaxy's light over the sky: its texels are the picture's.
    const double texel = real::radians(60.0) / double(picture_px);
    const double own = 2.0 * real::pi * sigma_px * sigma_px * peak * texel * texel;
    constexpr std::uint32_t seeds = 4;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed)
        for (const Image& face : tiled_sky(picture, small_tiling(seed))) {
            const auto n = double(face.width);
            for (std::int64_t y = 0; y < face.height; ++y)
                for (std::int64_t x = 0; x < face.width; ++x) {
                    const double share = solid_angle(double(x) + 0.5, double(y) + 0.5, n);
                    all += share;
                    light += share * double(face.at(x, y)[0]);
                    if (x < 6 || y < 6 || x >= face.width - 6 || y >= face.height - 6) continue;
                    const float here = face.at(x, y)[0];
                    bool highest = here > 0.15f;
                    for (std::int64_t j = -2; j <= 2 && highest; ++j)
                        for (std::int64_t i = -2; i <= 2; ++i)
                            highest = highest && (face.at(x + i, y + j)[0] < here || (i == 0 && j == 0));
                    if (!highest) continue;
                    double sum = 0.0;
                    for (std::int64_t j = -6; j <= 6; ++j)
                        for (std::int64_t i = -6; i <= 6; ++i)
                            sum += (double(face.at(x + i, y + j)[0]) - sky) *
                                   solid_angle(double(x + i) + 0.5, double(y + j) + 0.5, n);
                    ++found;
                    cut += sum < 0.7 * own ? 1 : 0;
                }
        }
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3) of_picture += double(picture.pixels[i]);
    EXPECT_NEAR(all / seeds, 4.0 * real::pi, 1e-3);
    EXPECT_NEAR(light / all / (of_picture / double(picture_px * picture_px)), 1.0, 0.01);
    // Those in the rims of the faces are not looked at.
    const double inside = std::pow(244.0 / 256.0, 2.0);
    const double expected =
        seeds * inside * galaxies * 4.0 * real::pi / (texel * texel * double(picture_px * picture_px));
    EXPECT_NEAR(found / expected, 1.0, 0.12);
    EXPECT_LE(cut, found / 50);
}

TEST(TiledSky, APlainPictureMakesAPlainSky) {
    Image plain = make_image(64, 48, 4);
    for (std::size_t i = 0; i < plain.pixels.size(); ++i) plain.pixels[i] = 0.25f;
    for (const Image& face : tiled_sky(plain, {30.0, 1, 64}))
        for (const float value : face.pixels) ASSERT_NEAR(value, 0.25f, 1e-5f);
    EXPECT_EQ(ERROR_OF(tiled_sky(make_image(64, 31, 3), {})),
              "environment.tile: expected a picture of at least 32 px a side, found 31");
}

TEST(SkyPatches, CoverTheSkyWithPartsThatNeighboursDoNotShare) {
    constexpr double reach_px = 60.0, px_per_radian = 300.0;
    const SkyPatches patches(glm::dvec2(400.0, 300.0), reach_px, 20.0, px_per_radian, 7);
    for (int n = 0; n < 2000; ++n) {
        const double z = 2.0 * painted::random(std::uint32_t(n), 81) - 1.0,
                     a = 2.0 * real::pi * painted::random(std::uint32_t(n), 82), r = std::sqrt(1.0 - z * z);
        const glm::dvec3 d(r * std::cos(a), r * std::sin(a), z);
        const SkyPatch& patch = patches.all()[patches.nearest(d)];
        ASSERT_LT(glm::distance(patch.middle, d), 0.97 * patches.reach());
        const glm::dvec2 place = patch.place(d, px_per_radian);
        ASSERT_LT(glm::distance(place, patch.picture), reach_px);
        ASSERT_TRUE(place.x >= 0.0 && place.y >= 0.0 && place.x <= 400.0 && place.y <= 300.0);
        ASSERT_LT(glm::distance(patch.direction(place, px_per_radian), d), 1e-9);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < patches.all().size(); ++i) {
        double nearest = 1e9;
        for (std::size_t j = 0; j < patches.all().size(); ++j)
            if (i != j &&
                glm::distance(patches.all()[i].middle, patches.all()[j].middle) < 1.3 * patches.spacing())
                nearest =
                    std::fmin(nearest, glm::distance(patches.all()[i].picture, patches.all()[j].picture));
        sum += std::fmin(nearest, 400.0);
    }
    EXPECT_GT(sum / double(patches.all().size()), 50.0) << "at random they are 40 px apart";
}

TEST(PictureObjects, AreFoundAndTakenOut) {
    const PictureObjects found = find_objects(deep_field(), 20.0);
    EXPECT_GE(found.objects.size(), std::size_t{galaxies});
    EXPECT_LE(found.objects.size(), std::size_t{galaxies + 6}) << "grain, now and then";
    const Image picture = deep_field();
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        ASSERT_FLOAT_EQ(found.light.pixels[i] + found.sky.pixels[i], picture.pixels[i]);
        ASSERT_LT(found.sky.pixels[i], 0.06f) << "no galaxy is left";
    }
    EXPECT_TRUE(find_objects(deep_field(), 1.0).objects.empty()) << "all reach farther";
}

TEST(TiledSky, IsAnotherForAnotherSeed) {
    const Image picture = deep_field();
    EXPECT_NE(tiled_sky(picture, {60.0, 1, 64})[3].pixels, tiled_sky(picture, {60.0, 2, 64})[3].pixels);
}

}  // namespace
}  // namespace astrosplat
