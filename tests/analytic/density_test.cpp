// How many splats a density curve keeps around a plane, as a closed form: the volume within distance r of a
// rectangle is 2 A r + P pi r^2 / 2 + 4/3 pi r^3 (Steiner; A its area, P its perimeter).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "analytic/support.h"
#include "core/real.h"

namespace astrosplat {
namespace {

using namespace astrosplat::analytic;

constexpr double reach = 0.2;

std::string plane_scene(const std::string& look) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [8, 8]
[[layer]]
name = "sheet"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "sheet.tif" }} ]
count = 100000
max_distance = {}
[layer.look]
{}
)",
                       reach, look);
}

LayerStatistics statistics_of(const std::string& look) {
    const TempFolder folder;
    write_float_tiff(folder / "sheet.tif", 2, 2, [](int, int) { return glm::vec4(1.0f, 1.0f, 1.0f, 0.5f); });
    Pipeline pipeline(scene_of(folder, plane_scene(look)));
    render_frame(pipeline);
    return pipeline.statistics()[0];
}

/// Share of the volume around the plane that a density p(x) keeps, x = distance / reach.
double kept_share(const std::function<double(double)>& p) {
    constexpr int steps = 10000;
    double kept = 0.0, all = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) / steps, r = x * reach;
        const double shell = 2.0 * 100.0 + 40.0 * real::pi * r + 4.0 * real::pi * r * r;
        all += shell;
        kept += shell * p(x);
    }
    return kept / all;
}

struct Case {
    const char* look;
    std::function<double(double)> density;
};

TEST(Density, KeepsTheShareOfItsCurve) {
    const Case cases[] = {
        {"pdf = { shape = \"constant\" }", [](double) { return 1.0; }},
        {"density = 0.37", [](double) { return 0.37; }},
        {"pdf = { shape = \"linear\" }", [](double x) { return 1.0 - x; }},
        {"pdf = { shape = \"quadratic\" }", [](double x) { return (1.0 - x) * (1.0 - x); }},
        {"pdf = { shape = \"exponential\", rate = 5.0 }", [](double x) { return std::exp(-5.0 * x); }},
        {"pdf = { shape = \"gaussian\", sigma = 0.3 }", [](double x) { return std::exp(-x * x / 0.18); }},
        {"pdf = { shape = \"smooth\" }\ndensity = 0.8",
         [](double x) { return 0.8 * (1.0 - x * x * (3.0 - 2.0 * x)); }},
        {"pdf = { shape = \"curve\", points = [[0.0, 0.2], [1.0, 0.2]] }", [](double) { return 0.2; }},
        {"reach = 0.1", [](double x) { return x <= 0.5 ? 1.0 : 0.0; }},
    };
    for (const Case& test : cases) {
        const LayerStatistics counts = statistics_of(test.look);
        const double share = kept_share(test.density), n = static_cast<double>(counts.kept);
        ASSERT_GT(n, 80000.0);
        // Four standard deviations of a binomial; a jittered lattice fills the shells more evenly than
        // chance.
        EXPECT_NEAR(static_cast<double>(counts.drawn) / n, share,
                    4.0 * std::sqrt(share * (1.0 - share) / n) + 1e-12)
            << test.look;
    }
}

// The noise has mean 0, so culling by all of it keeps half; with 2500 cells in the sheet the mean is within
// 0.02.
TEST(Density, CullingByNoiseKeepsHalf) {
    const LayerStatistics counts = statistics_of("noise = { frequency = 5.0, cull = 1.0 }");
    EXPECT_NEAR(static_cast<double>(counts.drawn) / static_cast<double>(counts.kept), 0.5, 0.02);
    const LayerStatistics some = statistics_of("noise = { frequency = 5.0, cull = 0.5 }");
    EXPECT_NEAR(static_cast<double>(some.drawn) / static_cast<double>(some.kept), 0.75, 0.01);
}

// "Positions kept" of voxels = "auto": about `count`, here within what the plane's rim adds.
TEST(Density, AutomaticVoxelsKeepAboutCount) {
    EXPECT_NEAR(static_cast<double>(statistics_of("").kept), 100000.0, 10000.0);
}

}  // namespace
}  // namespace astrosplat
