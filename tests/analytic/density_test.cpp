// Density, matching and distance: how many splats there are, and the light they keep.
#include "analytic/support.h"
#include "render/footprint.h"
#include "support/all_values.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Density and matching of a plane, from scene text to pixels.

// How many splats a density curve keeps around a plane, as a closed form: the volume within distance r of a
// rectangle is 2 A r + P pi r^2 / 2 + 4/3 pi r^3 (Steiner; A its area, P its perimeter).

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
        const double share = kept_share(test.density), n = double(counts.kept);
        ASSERT_GT(n, 80000.0);
        // Four standard deviations of a binomial; a jittered lattice fills the shells more
        // evenly than chance.
        EXPECT_NEAR(double(counts.drawn) / n, share, 4.0 * std::sqrt(share * (1.0 - share) / n) + 1e-12)
            << test.look;
    }
}

// The noise has mean 0, so culling by all of it keeps half; with 2500 cells in the sheet the mean
// is within 0.02.
TEST(Density, CullingByNoiseKeepsHalf) {
    const LayerStatistics counts = statistics_of("noise = { frequency = 5.0, cull = 1.0 }");
    EXPECT_NEAR(double(counts.drawn) / double(counts.kept), 0.5, 0.02);
    const LayerStatistics some = statistics_of("noise = { frequency = 5.0, cull = 0.5 }");
    EXPECT_NEAR(double(some.drawn) / double(some.kept), 0.75, 0.01);
}

// "Positions kept" of voxels = "auto": about `count`, here within what the plane's rim adds.
TEST(Density, AutomaticVoxelsKeepAboutCount) {
    EXPECT_NEAR(double(statistics_of("").kept), 100000.0, 10000.0);
}

// Vertical matching, from scene text to pixels: a plane whose picture has one alpha everywhere, seen from the
// front, shows that alpha, whatever the splats' size and falloff and however they lie across the plane.

constexpr auto falloffs = names_of(Falloff::Shape{});
// Scene units; corners and centres of voxels of 0.074. Smaller splats of the sharpest falloff could not cover
// 0.9 of the plane with an alpha of at most 1 each.
constexpr double radii[] = {0.15, 0.2, 0.3};
struct Across {
    const char *pdf, *vertical;
};
constexpr Across acrosses[] = {
    {"constant", "none"}, {"gaussian", "none"}, {"constant", "linear"}, {"gaussian", "exponential"}};

struct Setting {
    std::string_view falloff;
    double radius;
    Across across;
    std::string name() const {
        return fmt::format("{} radius {} pdf {} vertical {}", falloff, radius, across.pdf, across.vertical);
    }
};

std::vector<Setting> all_settings() {
    std::vector<Setting> settings;
    for (const std::string_view falloff : falloffs)
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
    const auto quoted = [](std::string_view text) { return fmt::format("\"{}\"", text); };
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

class VerticalMatching : public ::testing::TestWithParam<double> {
  protected:
    /// check(mean of the picture, name) of a sheet of the alpha, for every setting.
    void with_each(const char* blend,
                   const std::function<void(const glm::dvec4&, const std::string&)>& check) {
        const TempFolder folder;
        write_float_tiff(folder / "sheet.tif", 2, 2, [&](int, int) { return glm::vec4(color, GetParam()); });
        const std::vector<Setting> settings = all_settings();
        Pipeline pipeline(scene_of(folder, sheet_scene(blend, settings)));
        for (std::size_t i = 0; i < settings.size(); ++i)
            check(mean(render_frame(pipeline, double(i)).beauty), settings[i].name());
    }
};

TEST_P(VerticalMatching, FrontViewUnderOverShowsTheAlpha) {
    with_each("over", [](const glm::dvec4& seen, const std::string& name) {
        EXPECT_NEAR(seen.a, GetParam(), 0.02) << name;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], seen.a * color[k], 1e-4) << name;
    });
}

TEST_P(VerticalMatching, FrontViewUnderAddShowsAlphaTimesColour) {
    with_each("add", [](const glm::dvec4& seen, const std::string& name) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], GetParam() * color[k], 0.02) << name;
    });
}

INSTANTIATE_TEST_SUITE_P(Alphas, VerticalMatching, ::testing::Values(0.1, 0.3, 0.5, 0.7, 0.9));

// Near and far: splats keep their light at every distance, with and without level of detail, and nothing pops
// when the camera flies through them.

constexpr auto shapes = test::all_values<Falloff::Shape>;

double light(const Image& image, int channel) {
    return mean(image)[channel] * double(image.width * image.height);
}

/// One layer of a splat file under a perspective camera whose focal length is the picture's height
/// (fov 2 atan(1/2)).
std::string file_scene(int width_px, int height_px, const std::string& render, const std::string& camera,
                       const std::string& animation = "") {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [{}, {}]
[camera]
fov = 53.13010235415598
{}
[[layer]]
name = "dots"
[layer.source]
kind = "splats"
file = "splats.pda"
[layer.render]
{}
{}
)",
                       width_px, height_px, camera, render, animation);
}

// From 2000 to 4 scene units away: radii of 0.024 to 12 px, at places that fall anywhere on the pixel grid.
TEST(Distance, EveryFalloffKeepsItsLight) {
    const TempFolder folder;
    folder.file("splats.pda", pda("0.013 0.021 0 0.5 0.25 1 0.5 0.75\n"));
    for (const Falloff::Shape shape : shapes) {
        Pipeline pipeline(scene_of(
            folder,
            file_scene(64, 64, fmt::format("falloff = \"{}\"", name_of(shape)), "position = [0, 0, 4]",
                       "[animation]\n\"camera.position\" = { keys = [[0, [0, 0, 4]], [1, [0, 0, 7.3]], "
                       "[2, [0, 0, 16.1]], [3, [0, 0, 31.7]], [4, [0, 0, 97]], [5, [0, 0, 403]], "
                       "[6, [0, 0, 2000]]], interpolation = \"step\" }")));
        const double distances[] = {4.0, 7.3, 16.1, 31.7, 97.0, 403.0, 2000.0};
        for (int frame = 0; frame < 7; ++frame) {
            const double radius_px = 0.75 * 64.0 / distances[frame];
            const double expected =
                0.5 * 0.25 * falloff_integral({shape, 0.5f, 4.5f}) * radius_px * radius_px;
            EXPECT_NEAR(light(render_frame(pipeline, frame).beauty, 1) / expected, 1.0, 0.005)
                << name_of(shape) << " at " << distances[frame];
        }
    }
}

// 105 separate splats of 28 px; level of detail splits them into 64 children each. A long lens (1024 px): far
// off the axis a ball of children is seen stretched, where a splat stays round, and shows slightly more.
TEST(Distance, LevelOfDetailKeepsTheLightInPerspective) {
    const TempFolder folder;
    std::string splats;
    for (int i = 0; i < 105; ++i)
        splats += fmt::format("{} {} {} 0.9 0.5 0.2 {} 3.5\n", 8.5 * (i % 15 - 7), 8.5 * (i / 15 - 3),
                              i * 37 % 5 - 2, i % 2 ? 0.3 : 0.48);
    folder.file("splats.pda", pda(splats));
    for (const Falloff::Shape shape : shapes)
        for (const char* blend : {"over", "add"}) {
            const auto render = [&](int max_px) {
                const std::string keys =
                    fmt::format("falloff = \"{}\"\nblend = \"{}\"\nlod = {{ max_px = {} }}", name_of(shape),
                                blend, max_px);
                return render_text(
                    folder, file_scene(544, 256, keys, "position = [0, 0, 256]\nfocal_length = 67.764706"));
            };
            const RenderedFrame whole = render(0), split = render(42);
            EXPECT_GT(split.statistics.splats_drawn, 50 * whole.statistics.splats_drawn) << name_of(shape);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(light(split.beauty, k) / light(whole.beauty, k), 1.0, 0.01)
                    << name_of(shape) << " " << blend << " channel " << k;
        }
}

// From a mean overlap of 4 on, a sheet sends the same light from near and far (DESIGN 7, known limit).
TEST(Distance, SheetOfEnoughSplatsLooksTheSameFromAfar) {
    const TempFolder folder;
    write_float_tiff(folder / "sheet.tif", 2, 2, [](int, int) { return glm::vec4(0.9f, 0.5f, 0.2f, 0.8f); });
    for (const Falloff::Shape shape : shapes) {
        Pipeline pipeline(scene_of(folder, fmt::format(R"(astrosplat = 1
[output]
resolution = [96, 96]
[camera]
projection = "orthographic"
position = [0, 20, 0]
[[layer]]
name = "sheet"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "sheet.tif" }} ]
count = 100000
[layer.look]
radius = {{ min = 0.15, max = 0.2 }}
[layer.render]
falloff = "{}"
[animation]
"camera.height" = {{ keys = [[0, 4.0], [1, 20.0], [2, 100.0]], interpolation = "step" }}
)",
                                                       name_of(shape))));
        // 4 x 4 px inside the sheet, which is 240, 48 and 9.6 px wide.
        const RenderedFrame close = render_frame(pipeline, 0), middle = render_frame(pipeline, 1),
                            afar = render_frame(pipeline, 2);
        EXPECT_GT(close.statistics.mean_overlap, 4.0) << name_of(shape);
        const glm::dvec4 seen = mean(close.beauty);
        const glm::dvec4 from_middle = mean(middle.beauty, {40, 40, 16, 16}),
                         from_afar = mean(afar.beauty, {46, 46, 4, 4});
        for (int k = 0; k < 4; ++k) {
            EXPECT_NEAR(from_middle[k] / seen[k], 1.0, 0.02) << name_of(shape) << " channel " << k;
            EXPECT_NEAR(from_afar[k] / seen[k], 1.0, 0.02) << name_of(shape) << " channel " << k;
        }
    }
}

/// Largest change of the picture's mean light between two steps of a flight along -z, over the largest light.
double largest_jump(const TempFolder& folder, const std::string& camera, const std::string& render,
                    double from, double to, int steps) {
    const std::string track = fmt::format(
        "[animation]\n\"camera.position\" = {{ keys = [[0, [0.1, 0.05, {}]], [{}, [0.1, 0.05, {}]]] }}", from,
        steps, to);
    Pipeline pipeline(
        scene_of(folder, file_scene(64, 64, render, "rotation = [0, 0, 0, 1]\n" + camera, track)));
    double jump = 0.0, most = 0.0, last = 0.0;
    for (int frame = 0; frame <= steps; ++frame) {
        const double now = mean(render_frame(pipeline, frame).beauty).r;
        if (frame > 0) jump = std::max(jump, std::fabs(now - last));
        most = std::max(most, now);
        last = now;
    }
    EXPECT_GT(most, 0.05);
    return jump / most;
}

/// Half the step, half the largest change: the light is a continuous function of the camera's place. A splat
/// that popped would change it by the same amount however small the steps.
void expect_continuous(const TempFolder& folder, const std::string& camera, const std::string& render,
                       double from, double to, int steps) {
    const double coarse = largest_jump(folder, camera, render, from, to, steps);
    EXPECT_LT(coarse, 0.1) << camera;
    EXPECT_LT(largest_jump(folder, camera, render, from, to, 2 * steps), 0.65 * coarse) << camera;
}

TEST(NearFade, NothingPopsAsTheCameraPassesThrough) {
    const TempFolder folder;
    folder.file("splats.pda", pda("0 0 0 1 0.5 0.2 0.8 0.5\n0.4 0.1 -0.6 1 1 0.5 0.3 0.4\n"
                                  "-0.1 0.2 0.9 1 1 1 0.5 0.3\n"));
    for (const char* camera : {"", "near_fade = 0.8", "near = 0.2"})
        expect_continuous(folder, camera, "", 2.5, -1.5, 200);
}

// Children fade over their own, small radius: smaller steps show it.
TEST(NearFade, NothingPopsInACloudOfChildren) {
    const TempFolder folder;
    folder.file("splats.pda", pda("0 0 0 1 0.5 0.2 0.8 0.5\n"));
    expect_continuous(folder, "", "lod = { max_px = 200.0 }", 0.1, 0.0, 100);
}

}  // namespace
}  // namespace astrosplat
