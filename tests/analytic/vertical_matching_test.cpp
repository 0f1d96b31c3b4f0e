// Vertical matching, from scene text to pixels: a plane whose picture has one alpha everywhere, seen from the
// front, shows that alpha, whatever the dots' size and falloff and however they lie across the plane.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analytic/support.h"

namespace astrosplat {
namespace {

using namespace astrosplat::analytic;

constexpr const char* falloffs[] = {"constant", "linear", "trapezoid", "gaussian", "exponential"};
// Scene units; corners and centres of voxels of 0.074. Smaller dots of the sharpest falloff could not cover
// 0.9 of the plane with an alpha of at most 1 each.
constexpr double radii[] = {0.15, 0.2, 0.3};
struct Across {
    const char *pdf, *vertical;
};
constexpr Across acrosses[] = {
    {"constant", "none"}, {"gaussian", "none"}, {"constant", "linear"}, {"gaussian", "exponential"}};

struct Setting {
    const char* falloff;
    double radius;
    Across across;
    std::string name() const {
        return fmt::format("{} radius {} pdf {} vertical {}", falloff, radius, across.pdf, across.vertical);
    }
};

std::vector<Setting> all_settings() {
    std::vector<Setting> settings;
    for (const char* falloff : falloffs)
        for (const double radius : radii)
            for (const Across& across : acrosses) settings.push_back({falloff, radius, across});
    return settings;
}

/// One frame per setting, so that all of them share one generated set.
std::string animation(const std::vector<Setting>& settings) {
    const auto track = [&](const char* key, const auto& value) {
        std::string keys;
        for (std::size_t i = 0; i < settings.size(); ++i)
            keys += fmt::format("{}[{}, {}, \"step\"]", i ? ", " : "", i, value(settings[i]));
        return fmt::format("\"layer.sheet.{}\" = {{ keys = [{}] }}\n", key, keys);
    };
    const auto quoted = [](const char* text) { return fmt::format("\"{}\"", text); };
    return "[animation]\n" + track("render.falloff", [&](const Setting& s) { return quoted(s.falloff); }) +
           track("look.radius.min", [](const Setting& s) { return s.radius; }) +
           track("look.radius.max", [](const Setting& s) { return s.radius; }) +
           track("look.pdf.shape", [&](const Setting& s) { return quoted(s.across.pdf); }) +
           track("look.vertical.shape", [&](const Setting& s) { return quoted(s.across.vertical); });
}

// The camera sees 4 x 4 of the plane's 10 x 10 scene units in 64 x 64 px.
std::string sheet_scene(const char* blend, const std::vector<Setting>& settings) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [64, 64]
[camera]
projection = "orthographic"
position = [0, 20, 0]
height = 4.0
[[layer]]
name = "sheet"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "sheet.tif" }} ]
count = 200000
max_distance = 0.2
[layer.render]
blend = "{}"
)",
                       blend) +
           animation(settings);
}

const glm::dvec3 color(0.9, 0.4, 0.15);

class VerticalMatching : public ::testing::TestWithParam<double> {};

TEST_P(VerticalMatching, FrontViewUnderOverShowsTheAlpha) {
    const double alpha = GetParam();
    const TempFolder folder;
    write_float_tiff(folder / "sheet.tif", 2, 2, [&](int, int) { return glm::vec4(color, alpha); });
    const std::vector<Setting> settings = all_settings();
    Pipeline pipeline(scene_of(folder, sheet_scene("over", settings)));
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const glm::dvec4 seen = mean(render_frame(pipeline, static_cast<double>(i)).beauty);
        EXPECT_NEAR(seen.a, alpha, 0.02) << settings[i].name();
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], seen.a * color[k], 1e-4) << settings[i].name();
    }
}

TEST_P(VerticalMatching, FrontViewUnderAddShowsAlphaTimesColour) {
    const double alpha = GetParam();
    const TempFolder folder;
    write_float_tiff(folder / "sheet.tif", 2, 2, [&](int, int) { return glm::vec4(color, alpha); });
    const std::vector<Setting> settings = all_settings();
    Pipeline pipeline(scene_of(folder, sheet_scene("add", settings)));
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const glm::dvec4 seen = mean(render_frame(pipeline, static_cast<double>(i)).beauty);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], alpha * color[k], 0.02) << settings[i].name();
    }
}

INSTANTIATE_TEST_SUITE_P(Alphas, VerticalMatching, ::testing::Values(0.1, 0.3, 0.5, 0.7, 0.9));

}  // namespace
}  // namespace astrosplat
