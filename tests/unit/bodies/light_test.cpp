// The light of a picture's splats, and pictures continued beyond their edges.
#include "bodies/fields.h"
#include "bodies/front_fit.h"
#include "bodies/margin.h"
#include "bodies/placement.h"
#include "image/channels.h"
#include "support/painted_picture.h"
#include "support/test.h"
#include "unit/bodies/bodies_support.h"

namespace astrosplat {
namespace {

// The light of a picture's splats: filled holes, and the flat light in closed form.

constexpr std::int64_t shell_width = 640, shell_height = 400;
constexpr double shell_x = 300.0, shell_y = 200.0;

double from_shell(double x, double y) { return std::hypot(x - shell_x, y - shell_y); }

// A round shell on a dark sky with a core in its middle and a filament across.
Image shell_with(float core, float filament) {
    Image light = make_image(shell_width, shell_height, 1, 0.001f);
    for (std::int64_t y = 0; y < shell_height; ++y)
        for (std::int64_t x = 0; x < shell_width; ++x) {
            const double r = from_shell(double(x), double(y));
            float& value = *light.at(x, y);
            if (r < 150.0) value += 0.1f;
            if (r < 28.0) value += core;
            if (r < 150.0 && std::fabs(double(y) - 250.0) < 8.0) value += filament;
        }
    return light;
}

float at(const Image& field, double x, double y) {
    const double share = double(field.width) / double(shell_width);
    return bilinear(field, 0, float(x * share), float(y * share));
}

TEST(FilledLight, ACoreIsAsDeepAsItIsWide) {
    const FilledLight filled = find_filled_light(shell_with(0.3f, 0.0f));
    EXPECT_GT(at(filled.core_share, shell_x, shell_y), 0.9f);
    EXPECT_NEAR(at(filled.core_reach, shell_x, shell_y), 28.0f, 8.0f);
    EXPECT_LT(at(filled.core_share, shell_x + 80.0, shell_y), 0.02f);
    EXPECT_LT(at(filled.core_reach, shell_x + 80.0, shell_y), 2.0f);
}

TEST(FilledLight, ShellsAndFilamentsAreNoCores) {
    for (const float filament : {0.0f, 0.5f}) {
        const FilledLight filled = find_filled_light(shell_with(0.0f, filament));
        EXPECT_LT(*std::max_element(filled.core_share.pixels.begin(), filled.core_share.pixels.end()), 0.05f);
    }
}

TEST(FilledLight, TheSkyIsWhatLiesAroundTheShell) {
    const FilledLight filled = find_filled_light(shell_with(1.0f, 0.5f));
    for (const double inside : {0.0, 60.0, 120.0})
        EXPECT_LT(at(filled.sky_share, shell_x - inside, shell_y), 0.01f) << inside;
    EXPECT_GT(at(filled.sky_share, 600.0, 40.0), 0.99f);
    EXPECT_GT(at(filled.sky_share, shell_x + 190.0, shell_y), 0.99f);
}

// The depths of fine splats about a place.
struct Depths {
    double mean = 0.0, deviation = 0.0, farthest = 0.0;
    std::array<double, 8> eighths{};  // of -103 to 103 texels
};
Depths depths_about(double x, double y, bool fine, double clumps = 0.0, float around = 30.0f) {
    StructureParams params = of_kind(StructureKind::walls);
    params.depth = 0.4;
    params.clumps = clumps;
    Placement placement = make_placement(shell_with(0.3f, 0.0f), params, 64.0, true, 5u);
    placement.knots = {};
    const std::vector<Band> bands = make_bands(shell_width);
    const BandSplats splats = band_splats(fine ? bands[1] : bands.back(), !fine, placement)[0];
    double sum = 0.0, squares = 0.0, count = 0.0;
    Depths depths;
    for (std::uint32_t number = 0; number < 40; ++number) {
        PlacedBlock block = splats_about(glm::vec2(x, y), glm::vec2(around), number);
        place(placement, splats, block);
        for (int i = 0; i < block.count; ++i) {
            const auto z = double(block.z[i]);
            sum += z;
            squares += z * z;
            depths.farthest = std::max(depths.farthest, std::fabs(z));
            ++depths.eighths[std::size_t(std::clamp(4.0 * (z / 103.0 + 1.0), 0.0, 7.99))];
            ++count;
        }
    }
    depths.mean = sum / count;
    depths.deviation = std::sqrt(squares / count);
    return depths;
}

// A wall lies at 128 texels in the middle: light of the core, which is 28 wide, is not there, neither as
// detail nor as glow; that of the shell beside it is.
TEST(FilledLight, ACoreIsABallInsideOfItsShell) {
    for (const bool fine : {true, false}) {
        const double core = depths_about(shell_x, shell_y, fine).deviation;
        const double shell = depths_about(shell_x + 75.0, shell_y, fine).deviation;
        EXPECT_LT(core, 45.0) << fine;
        EXPECT_GT(shell, fine ? 65.0 : 40.0) << fine;
    }
}

// Four fifths of a wall's greatest distance, to both sides, and thinner towards the picture's edges, which
// would be those of a slab: the root of 1 - u^4 - v^4.
TEST(FilledLight, TheSkyIsACushionAndNoSheet) {
    for (const bool fine : {true, false})
        for (const double y : {200.0, 100.0, 60.0}) {
            const Depths sky = depths_about(560.0, y, fine);
            const double u = 0.75, v = y / 200.0 - 1.0;
            const double reach = 102.4 * std::sqrt(1.0 - std::pow(u, 4.0) - std::pow(v, 4.0));
            EXPECT_NEAR(sky.deviation, reach / std::sqrt(3.0), 0.2 * reach) << fine << ' ' << y;
            EXPECT_LT(sky.farthest, 1.15 * reach) << fine << ' ' << y;
            EXPECT_GT(sky.farthest, 0.92 * reach) << fine << ' ' << y;
            EXPECT_LT(std::fabs(sky.mean), 0.25 * reach) << fine << ' ' << y;
        }
}

// On the walls they would be seen again, before and behind, in the core's own colours.
TEST(FilledLight, DetailsOfACoreAreItsOwnUpToItsEdge) {
    for (const double x : {0.0, 20.0, 27.0})
        EXPECT_LT(depths_about(shell_x + x, shell_y, true, 0.0, 3.0f).deviation, 30.0) << x;
}

// Spread evenly in every column, what is small and bright there would be a needle.
TEST(FilledLight, SmallThingsOfTheSkyFloatWithTheirClouds) {
    for (const double x : {540.0, 570.0, 600.0}) {
        const auto eighths = depths_about(x, 60.0, true, 1.0, 3.0f).eighths;
        double all = 0.0, fullest = 0.0;
        for (std::size_t i = 0; i < 8; ++i) {
            all += eighths[i];
            fullest = std::max(fullest, eighths[i] + (i > 0 ? eighths[i - 1] : 0.0));
        }
        EXPECT_GT(fullest, 0.45 * all) << x;
    }
}

// The flat light of a picture's splats against closed forms and against the renderer's.

constexpr std::int64_t width = 96, height = 64;
constexpr double filter_px = 0.5;

void add_splat(PictureSplats& set, const glm::vec3& position, const glm::vec3& color, float alpha,
               float radius) {
    set.splats.position.push_back(position);
    set.splats.color.push_back(color);
    set.splats.alpha.push_back(alpha);
    set.splats.radius.push_back(radius);
}

// Splats of three sizes all over the picture, in rows, and one of dust.
PictureSplats some_splats() {
    PictureSplats set;
    std::uint32_t n = 0;
    for (const float sigma : {0.5f, 1.7f, 6.0f}) {
        const auto begin = set.splats.size();
        for (int i = 0; i < 300; ++i, ++n) {
            const auto x = float((painted::random(n, 1) - 0.5) * double(width));
            add_splat(set, {x, 31.9f - 0.21f * float(i), 0.0f}, {1.0f, 0.5f, float(painted::random(n, 2))},
                      0.1f, radius_sigmas * sigma);
        }
        set.ranges.push_back({begin, set.splats.size(), sigma});
    }
    add_splat(set, glm::vec3(0.0f), glm::vec3(-1.0f), 0.5f, 4.0f);
    return set;
}

PictureSplats one_splat(float x, float y, float sigma) {
    PictureSplats set;
    add_splat(set, {x, y, 0.0f}, {0.0f, 2.0f, 0.0f}, 0.25f, radius_sigmas * sigma);
    set.ranges.push_back({0, 1, sigma});
    return set;
}

// Flux, centre and variance along the axes of one splat, on every grid.
TEST(FlatLight, OneSplatIsItsFootprint) {
    for (const double sigma : {0.45, 0.5, 0.6, 0.75, 0.9, 1.3, 3.0, 7.0}) {
        PictureSplats set = one_splat(3.3f, -5.6f, float(sigma));
        const Image light = FlatLight(set, width, height, filter_px).sum();
        double sum = 0.0, x_sum = 0.0, y_sum = 0.0, squares = 0.0;
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const auto value = double(light.at(x, y)[1]);
                const double dx = double(x) + 0.5 - (48.0 + 3.3), dy = double(y) + 0.5 - (32.0 + 5.6);
                sum += value;
                x_sum += value * dx;
                y_sum += value * dy;
                squares += value * (dx * dx + dy * dy);
            }
        const double flux = 0.5 * 0.9494 * 2.0 * real::pi * sigma * sigma;
        const double variance = footprint_variance * sigma * sigma + filter_px * filter_px;
        EXPECT_NEAR(sum, flux, 0.002 * flux) << sigma;
        EXPECT_NEAR(x_sum / sum, 0.0, 0.02 * sigma) << sigma;
        EXPECT_NEAR(y_sum / sum, 0.0, 0.02 * sigma) << sigma;
        EXPECT_NEAR(squares / sum / 2.0, variance, 0.05 * variance) << sigma;
    }
}

// Of green, which is channel 1.
Fraction fraction_of(float ratio) {
    return {make_image(width, height, 1, 0.3f * ratio), make_image(width, height, 1, 0.3f)};
}

TEST(FlatLight, AnEvenRatioCorrectsAllThatShines) {
    const PictureSplats before = some_splats();
    const auto corrected = [&](float ratio, bool overshoot) {
        PictureSplats set = before;
        FlatLight(set, width, height, filter_px).correct(fraction_of(ratio), 1, overshoot);
        return set.splats.color;
    };
    const auto plain = corrected(1.5f, false), over = corrected(1.5f, true), most = corrected(2.5f, true);
    for (std::size_t i = 0; i + 1 < plain.size(); ++i) {
        ASSERT_NEAR(plain[i].y, 0.75f, 1e-5f);
        ASSERT_NEAR(over[i].y, 1.125f, 1e-5f);
        ASSERT_NEAR(most[i].y, 1.5f, 1e-5f);
        ASSERT_NEAR(plain[i].x, 1.0f, 1e-6f);
        ASSERT_NEAR(plain[i].z, before.splats.color[i].z, 1e-6f);
    }
    EXPECT_EQ(plain.back(), glm::vec3(-1.0f));  // dust
}

// Detail that only fine splats can show is left to them.
TEST(FlatLight, FineSplatsAreSharpened) {
    Fraction fraction = fraction_of(1.0f);
    *fraction.wanted.at(48, 32) = 0.45f;
    const auto factor = [&](float sigma, bool overshoot) {
        PictureSplats set = one_splat(0.5f, -0.5f, sigma);
        FlatLight(set, width, height, filter_px).correct(fraction, 1, overshoot);
        return set.splats.color[0].y / 2.0f;
    };
    const float fine = factor(0.5f, false), coarse = factor(4.0f, false);
    EXPECT_GT(fine, 1.2f);
    EXPECT_LT(coarse, 1.1f);
    EXPECT_GT(factor(0.5f, true), 1.1f * fine * fine);
    EXPECT_NEAR(factor(4.0f, true), coarse * coarse, 1e-5f);
}

// A view of their own would take as long as that of many.
TEST(FlatLight, FewSplatsSeeWhatTheNextNarrowerOnesDo) {
    Fraction fraction = fraction_of(1.0f);
    *fraction.wanted.at(48, 32) = 0.45f;
    // Of a splat of the first size and one of the second, at the same place.
    const auto factors = [&](float second_sigma, int of_second_size) {
        PictureSplats set = one_splat(0.5f, -0.5f, 0.5f);
        for (int i = 0; i < of_second_size; ++i)
            add_splat(set, {0.5f, -0.5f, 0.0f}, {0.0f, 2.0f, 0.0f}, 0.25f, radius_sigmas * second_sigma);
        set.ranges.push_back({1, set.splats.size(), second_sigma});
        FlatLight(set, width, height, filter_px).correct(fraction, 1, true);
        return std::pair(set.splats.color[0].y, set.splats.color.back().y);
    };
    const auto [narrow, few] = factors(0.8f, 61);
    EXPECT_EQ(few, narrow);
    const auto [narrow_again, many] = factors(0.8f, 62);
    EXPECT_EQ(narrow_again, narrow);
    EXPECT_LT(many, 0.98f * narrow);
    const auto [as_narrow, coarse] = factors(4.0f, 1);  // is not sharpened
    EXPECT_EQ(as_narrow, narrow);
    EXPECT_LT(coarse, 0.9f * narrow);
}

TEST(FlatLight, MultipliesByAGridsValues) {
    PictureSplats set = one_splat(0.0f, 0.0f, 1.0f);  // in the middle of the picture: between cells
    Image cells = make_image(3, 2, 3, 1.0f);
    cells.at(1, 0)[1] = 2.0f;
    cells.at(1, 1)[1] = 4.0f;
    FlatLight(set, width, height, filter_px).multiply(cells, 32.0);
    EXPECT_NEAR(set.splats.color[0].y, 6.0f, 1e-5f);
}

// Pictures continued beyond their edges.

constexpr std::int64_t picture_width = 200, picture_height = 120, margin_px = 20;

TexturedMesh lit_plane(const Image& rgb) {
    TexturedMesh result = on_plane(rgb, 0.2f);
    result.textures[0].alpha_from_light = true;
    return result;
}

Image even_light() { return make_image(picture_width, picture_height, 3, 0.2f); }

StructureParams with_margin(double margin, StructureKind kind = StructureKind::sheet) {
    StructureParams params;
    params.kind = kind;
    params.margin = margin;
    return params;
}

std::vector<TexturedMesh> continued(const Image& rgb, StructureKind kind = StructureKind::sheet) {
    std::vector<TexturedMesh> meshes{lit_plane(rgb)};
    const std::vector<glm::dvec2> times = add_margins(meshes, with_margin(0.1, kind), "a");
    EXPECT_EQ(times.size(), 1u);
    EXPECT_DOUBLE_EQ(times[0].x, 1.2);
    EXPECT_DOUBLE_EQ(times[0].y, 160.0 / 120.0);
    return meshes;
}

TEST(Margin, ThePictureStaysAsItIs) {
    const Image galaxy = painted::galaxy(picture_width, picture_height);
    const Texture texture = continued(galaxy)[0].textures[0];
    ASSERT_EQ(texture.image.width, 240);
    ASSERT_EQ(texture.image.height, 160);
    EXPECT_FALSE(texture.alpha_from_light);
    for (std::int64_t y = 0; y < picture_height; ++y)
        for (std::int64_t x = 0; x < picture_width; ++x) {
            const float* const p = texture.image.at(x + margin_px, y + margin_px);
            ASSERT_TRUE(std::equal(p, p + 3, galaxy.at(x, y))) << x << ' ' << y;
            ASSERT_EQ(p[3], 1.0f);
        }
}

/// Of green, so far above the picture.
double mean_above(const Texture& texture, std::int64_t px_away) {
    double sum = 0.0;
    for (std::int64_t x = 0; x < picture_width; ++x)
        sum += double(texture.image.at(x + margin_px, margin_px - px_away)[1]);
    return sum / double(picture_width);
}

TEST(Margin, FadesToNothingFromTheEdgeOutward) {
    const Texture texture = continued(even_light())[0].textures[0];
    const auto mean_at = [&](std::int64_t px_away) { return mean_above(texture, px_away); };
    EXPECT_NEAR(mean_at(1), 0.2, 0.02);  // no step at the edge
    for (std::int64_t px = 1; px < margin_px; ++px) EXPECT_LE(mean_at(px + 1), mean_at(px)) << px;
    EXPECT_LT(mean_at(margin_px / 2), 0.12);
    EXPECT_LT(mean_at(margin_px), 1e-3);
    for (std::int64_t i = 0; i < texture.image.width * texture.image.height; ++i) {
        const float* const p = texture.image.pixels.data() + 4 * i;
        ASSERT_NEAR(p[3], p[1] / 0.2f, 1e-5f) << i;  // light and cover fade alike
    }
}

// Of a straight outline every place as far away would be as bright.
TEST(Margin, HasARaggedOutline) {
    const Texture texture = continued(even_light())[0].textures[0];
    float least = 1.0f, most = 0.0f;
    for (std::int64_t x = picture_width / 4; x < 3 * picture_width / 4; ++x) {
        const float light = texture.image.at(x + margin_px, margin_px / 4)[1];
        least = std::min(least, light);
        most = std::max(most, light);
    }
    EXPECT_GT(most, 3.0f * least);
}

// Beyond the frame a galaxy is itself, turned in its disk's plane: as bright there as on the other side.
TEST(Margin, AGalaxyGoesOnAsItIsOnItsOtherSide) {
    for (const double inclination : {0.0, 60.0}) {
        const double ratio = std::cos(inclination * 3.14159265358979 / 180.0);
        const auto disk = [&](double x, double y) {  // its middle is far to the left
            const double u = (x - 60.0) / 70.0, v = (y - 60.0) / (70.0 * ratio);
            return float(std::exp(-std::sqrt(u * u + v * v)));
        };
        Image light = make_image(picture_width, picture_height, 3);
        for (std::int64_t y = 0; y < picture_height; ++y)
            for (std::int64_t x = 0; x < picture_width; ++x)
                std::fill_n(light.at(x, y), 3, disk(double(x) + 0.5, double(y) + 0.5));
        std::vector<TexturedMesh> meshes{lit_plane(light)};
        StructureParams params = with_margin(0.1, StructureKind::disk);
        params.galaxy = {inclination, 0.0, glm::dvec2(0.3, 0.5), 90.0, {}};
        add_margins(meshes, params, "a");
        const Image& image = meshes[0].textures[0].image;
        double here = 0.0, wanted = 0.0;
        for (std::int64_t y = 40; y < 120; ++y) {
            here += double(image.at(10, y)[1]);
            wanted += double(disk(10.5 - margin_px, double(y) + 0.5 - margin_px));
        }
        EXPECT_NEAR(here / wanted, 1.0, 0.1) << inclination;
    }
}

// Half a turn would bring the green companion of the red galaxy beyond the lower edge.
TEST(Margin, AGalaxyGoesOnWithoutItsCompanion) {
    Image light = make_image(picture_width, picture_height, 3);
    const auto add_disk = [&](double cx, double cy, double size, int channel) {
        for_each_pixel(light, [&](std::int64_t x, std::int64_t y) {
            const double r = std::hypot(double(x) + 0.5 - cx, double(y) + 0.5 - cy);
            light.at(x, y)[channel] += float(0.8 * std::exp(-r / size));
        });
    };
    add_disk(100.0, 80.0, 24.0, 0);
    add_disk(100.0, 35.0, 9.0, 1);
    std::vector<TexturedMesh> meshes{lit_plane(light)};
    StructureParams params = with_margin(0.1, StructureKind::disk);
    params.galaxies = {{0.0, 0.0, glm::dvec2(0.5, 1.0 / 3.0), 90.0, {}},
                       {0.0, 0.0, glm::dvec2(0.5, 17.0 / 24.0), 90.0, {}}};
    add_margins(meshes, params, "a");
    const Image& image = meshes[0].textures[0].image;
    const auto sum_of = [&](std::int64_t row, int channel) {
        double sum = 0.0;
        for (std::int64_t y = row; y < row + margin_px; ++y)
            for (std::int64_t x = 100; x < 140; ++x) sum += double(image.at(x, y)[channel]);
        return sum;
    };
    EXPECT_LT(sum_of(picture_height + margin_px, 1), 1.0) << "below";
    EXPECT_GT(sum_of(0, 0), 1.0) << "above, a quarter of a turn away";
}

// Of a cloud, which does not grow dim outward, a dim rim would else end straight, and so would corners.
TEST(Margin, CloudsGoOnAllAroundAndHaveRoundCorners) {
    Image light = make_image(picture_width, picture_height, 3, 0.01f);
    for (int c = 0; c < 3; ++c) light.at(100, 0)[c] = light.at(101, 0)[c] = 9.0f;
    const Texture texture = continued(light)[0].textures[0];
    const auto lit = [&](std::int64_t x_begin, std::int64_t x_end) {
        double sum = 0.0;
        for (std::int64_t x = x_begin; x < x_end; ++x)
            for (std::int64_t y = 0; y < margin_px; ++y) sum += texture.image.at(x, y)[1] / 0.01;
        return sum / double((x_end - x_begin) * margin_px);
    };
    EXPECT_GT(lit(40, 100), 0.25);
    EXPECT_GT(lit(0, margin_px), 0.02);
    EXPECT_LT(lit(0, margin_px), 0.6 * lit(40, 100));
}

// A mirrored margin is brighter again towards the middle.
TEST(Margin, DoesNotGrowBrighterBeyondADimEdge) {
    Image light = make_image(picture_width, picture_height, 3, 0.0f);
    for (std::int64_t y = 0; y < picture_height; ++y)
        for (std::int64_t x = 0; x < picture_width; ++x)
            for (int c = 0; c < 3; ++c)
                light.at(x, y)[c] =
                    0.02f + 0.02f * float(std::min({x, y, picture_width - 1 - x, picture_height - 1 - y}));
    const Texture texture = continued(light)[0].textures[0];
    EXPECT_LT(mean_above(texture, 8), 2.0 * mean_above(texture, 1))
        << "what is mirrored there has eight times the light of the rim";
}

TEST(Margin, AStarByTheEdgeIsNotSeenTwice) {
    Image light = even_light();
    constexpr std::int64_t star_x = 100, star_y = 3;
    for (int c = 0; c < 3; ++c) light.at(star_x, star_y)[c] = 50.0f;
    const Texture texture = continued(light)[0].textures[0];
    const float there = texture.image.at(star_x + margin_px, margin_px - 1 - star_y)[1];
    const float beside = texture.image.at(star_x + margin_px + 8, margin_px - 1 - star_y)[1];
    EXPECT_GT(there, 0.5f * beside);
    EXPECT_LT(there, 4.0f * beside) << "250 times as bright in the picture";
}

TEST(Margin, ASmoothHeadByTheEdgeIsNotSeenTwice) {
    constexpr std::int64_t head_x = 100, head_y = 4;
    Image light = make_image(picture_width, picture_height, 3);
    for_each_pixel(light, [&](std::int64_t x, std::int64_t y) {
        const auto dx = double(x - head_x), dy = double(y - head_y);
        for (int c = 0; c < 3; ++c)
            light.at(x, y)[c] = float(0.02 + 0.5 * std::exp(-0.2 * (dx * dx + dy * dy)));
    });
    // What is mirrored of the head, over what there is at the rim.
    const auto second_head = [&](double clumps) {
        std::vector<TexturedMesh> meshes{lit_plane(light)};
        StructureParams params = with_margin(0.1);
        params.clumps = clumps;
        add_margins(meshes, params, "a");
        const Image& image = meshes[0].textures[0].image;
        const auto at = [&](std::int64_t away) { return image.at(head_x + margin_px, margin_px - away)[1]; };
        return at(1 + head_y) / at(0);
    };
    EXPECT_LT(second_head(0.0), 1.0f);
    EXPECT_GT(second_head(1.0), 1.3f) << "details are continued";
}

TEST(Margin, ACameraSeesThePictureWhereItWas) {
    std::vector<TexturedMesh> meshes{lit_plane(even_light())};
    UvCamera params;
    params.position = glm::dvec3(0.0, 8.0, 0.0);
    params.up = {0.0, 0.0, -1.0};
    params.fov = 40.0;
    const Camera before = picture_camera(params, 200.0 / 120.0);
    meshes[0].camera = before;
    apply_camera_uv(meshes[0].mesh, before);
    const glm::dvec2 times = add_margins(meshes, with_margin(0.1), "a")[0];
    for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), {4.9, 0, -2.9}, {-2, 1, 1}}) {
        const glm::dvec2 was = place_in_picture(before, point)->uv;
        const glm::dvec2 is = place_in_picture(*meshes[0].camera, point)->uv;
        for (int k = 0; k < 2; ++k) EXPECT_NEAR((is[k] - 0.5) * times[k] + 0.5, was[k], 1e-12);
    }
    EXPECT_NEAR(picture_height_at(*meshes[0].camera, 8.0), times.y * picture_height_at(before, 8.0), 1e-12);
}

TEST(Margin, OtherMeshesStay) {
    std::vector<TexturedMesh> meshes{lit_plane(even_light())};
    meshes[0].mesh = builtin_mesh("sphere", 1.0);
    EXPECT_EQ(add_margins(meshes, with_margin(0.1), "a")[0], glm::dvec2(1.0));
    EXPECT_EQ(meshes[0].textures[0].image.width, picture_width);
    meshes[0].mesh = builtin_mesh("plane", 1.0);
    EXPECT_EQ(add_margins(meshes, with_margin(0.0), "a")[0], glm::dvec2(1.0));
    EXPECT_EQ(meshes[0].textures[0].image.width, picture_width);
}

}  // namespace
}  // namespace astrosplat
