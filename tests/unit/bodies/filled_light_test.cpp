#include "bodies/filled_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bodies/placement.h"
#include "core/shared_maths.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

constexpr std::int64_t shell_width = 640, shell_height = 400;
constexpr double shell_x = 300.0, shell_y = 200.0;

double from_shell(double x, double y) { return std::hypot(x - shell_x, y - shell_y); }

// A round shell on a dark sky with a core in its middle and a filament across.
Image shell_with(float core, float filament) {
    Image light = make_image(shell_width, shell_height, 1, 0.001f);
    for (std::int64_t y = 0; y < shell_height; ++y) {
        for (std::int64_t x = 0; x < shell_width; ++x) {
            const double r = from_shell(static_cast<double>(x), static_cast<double>(y));
            float& value = *light.at(x, y);
            if (r < 150.0) value += 0.1f;
            if (r < 28.0) value += core;
            if (r < 150.0 && std::fabs(static_cast<double>(y) - 250.0) < 8.0) value += filament;
        }
    }
    return light;
}

float at(const Image& field, double x, double y) {
    const double share = static_cast<double>(field.width) / static_cast<double>(shell_width);
    return bilinear(field, 0, static_cast<float>(x * share), static_cast<float>(y * share));
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

// The depths of fine dots about a place.
struct Depths {
    double mean = 0.0, deviation = 0.0, farthest = 0.0;
    std::array<double, 8> eighths{};  // of -103 to 103 texels
};
Depths depths_about(double x, double y, bool fine, double clumps = 0.0, float around = 30.0f) {
    StructureParams params;
    params.kind = StructureKind::walls;
    params.depth = 0.4;
    params.clumps = clumps;
    Placement placement = make_placement(shell_with(0.3f, 0.0f), params, 64.0, true, 5u);
    placement.knots = {};
    const std::vector<Band> bands = make_bands(shell_width);
    const BandDots dots = band_dots(fine ? bands[1] : bands.back(), !fine, placement)[0];
    double sum = 0.0, squares = 0.0, count = 0.0;
    Depths depths;
    for (std::uint32_t number = 0; number < 40; ++number) {
        PlacedBlock block;
        block.count = DepthBlock::size;
        for (int i = 0; i < block.count; ++i) {
            const auto id = number * DepthBlock::size + static_cast<std::uint32_t>(i);
            const auto random = [&](std::uint32_t purpose) { return shared::as_hash(3u, id, 0u, purpose); };
            block.x[i] = static_cast<float>(x) + around * (shared::as_uniform(random(1u)) - 0.5f);
            block.y[i] = static_cast<float>(y) + around * (shared::as_uniform(random(2u)) - 0.5f);
            block.random[i] = random(3u);
        }
        place(placement, dots, block);
        for (int i = 0; i < block.count; ++i) {
            const auto z = static_cast<double>(block.z[i]);
            sum += z;
            squares += z * z;
            depths.farthest = std::max(depths.farthest, std::fabs(z));
            ++depths.eighths[static_cast<std::size_t>(std::clamp(4.0 * (z / 103.0 + 1.0), 0.0, 7.99))];
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
    for (const bool fine : {true, false}) {
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

}  // namespace
}  // namespace astrosplat
