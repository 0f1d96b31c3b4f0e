// Pictures keep their light, their colours and their side.
#include "analytic/support.h"
#include "core/color.h"
#include "scene/load.h"
#include "scene/new_scene.h"
#include "sets/load_source.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// The first picture: what `astrosplat new` writes around an image shows, from the front,
// the image's own light.

using namespace astrosplat::analytic;

constexpr int galaxy_px = 128;

/// A two-armed spiral with a bright core and a bluish disc, linear light, without alpha of its own (1).
glm::vec4 galaxy(int x, int y) {
    const double dx = (x + 0.5) / galaxy_px - 0.5, dy = (y + 0.5) / galaxy_px - 0.5;
    const double r = std::sqrt(dx * dx + dy * dy), angle = std::atan2(dy, dx);
    const double arms = 0.5 + 0.5 * std::cos(2.0 * angle - 12.0 * std::sqrt(r));
    const double disc = 0.5 * std::exp(-r / 0.15) * arms, core = std::exp(-r * r / 0.003);
    return {std::min(1.0, 0.7 * disc + core), std::min(1.0, 0.8 * disc + 0.9 * core),
            std::min(1.0, disc + 0.7 * core), 1.0};
}

glm::dvec3 mean_light() {
    glm::dvec3 sum(0.0);
    for (int y = 0; y < galaxy_px; ++y)
        for (int x = 0; x < galaxy_px; ++x) sum += glm::dvec3(galaxy(x, y));
    return sum / double(galaxy_px * galaxy_px);
}

/// The scene as written, at a size for tests, with further assignments. The texture's alpha of 1 everywhere
/// is passed over for the brightness, as for a picture without alpha.
Scene first_scene(const TempFolder& folder, std::vector<Assignment> changes) {
    write_float_tiff(folder / "my galaxy.tif", galaxy_px, galaxy_px, galaxy);
    const std::string text = new_scene_text(folder / "my galaxy.tif", "plane", folder / "scene.toml");
    changes.push_back({"output.resolution", "[100, 100]"});
    changes.push_back({"layer.my_galaxy.source.count", "200000"});
    changes.push_back({"layer.my_galaxy.source.alpha", "max"});
    return parse_scene(text, folder / "scene.toml", changes);
}

TEST(FirstPicture, FrontViewHasTheLightOfTheImage) {
    const TempFolder folder;
    Pipeline pipeline(first_scene(
        folder,
        {{"camera.projection", "orthographic"}, {"camera.position", "[0, 20, 0]"}, {"camera.height", "10"}}));
    const glm::dvec4 seen = mean(render_frame(pipeline).beauty);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k] / mean_light()[k], 1.0, 0.05) << "channel " << k;
}

// Without a camera: the whole plane, nothing cut off, the core bright but not beyond the image's own white,
// and less light on the whole than the image, since the plane is seen from 35 degrees and fills the
// frame in part.
TEST(FirstPicture, FramesTheWholePlaneBrightEnoughToSee) {
    const TempFolder folder;
    Pipeline pipeline(first_scene(folder, {}));
    const Image image = render_frame(pipeline).beauty;
    const double core = std::max({image.at(49, 49)[0], image.at(50, 50)[0], image.at(49, 50)[0]});
    EXPECT_GT(core, 0.5);
    EXPECT_LE(core, 1.0);
    EXPECT_GT(mean(image).g, 0.15 * mean_light().g);
    EXPECT_LT(mean(image).g, mean_light().g);
    for (std::int64_t i = 0; i < 100; ++i) {  // nothing is cut off
        EXPECT_EQ(image.at(i, 0)[3], 0.0f);
        EXPECT_EQ(image.at(i, 99)[3], 0.0f);
        EXPECT_EQ(image.at(0, i)[3], 0.0f);
        EXPECT_EQ(image.at(99, i)[3], 0.0f);
    }
}

// Pictures with soft edges keep their colour on the whole way: no dark rims from filtering,
// dividing or blending.

const glm::vec3 stored(1.0f, 0.6f, 0.2f);  // sRGB, multiples of 1/255
constexpr int disc_px = 32;

/// A bright disc that fades out over half its radius. Empty texels are black,
/// as painting programs write them.
glm::vec4 soft_disc(int x, int y) {
    const double dx = x - 15.5, dy = y - 15.5;
    const double alpha = std::clamp((14.0 - std::sqrt(dx * dx + dy * dy)) / 7.0, 0.0, 1.0);
    return alpha < 1.0 / 255.0 ? glm::vec4(0.0f) : glm::vec4(stored, alpha);
}

glm::vec3 linear_color() {
    return {real::srgb_to_linear(stored.r), real::srgb_to_linear(stored.g), real::srgb_to_linear(stored.b)};
}

std::string disc_scene(const char* filter, const char* blend, const std::string& output = "") {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [64, 64]
frames = "1"
{}
[camera]
projection = "orthographic"
position = [0, 20, 0]
height = 10.0
[[layer]]
name = "disc"
[layer.source]
meshes = [ {{ mesh = "plane", texture = "disc.png" }} ]
count = 100000
filter = "{}"
[layer.render]
blend = "{}"
)",
                       output, filter, blend);
}

TEST(SoftEdge, EverySplatHasTheColourOfThePicture) {
    const TempFolder folder;
    write_png(folder / "disc.png", disc_px, disc_px, soft_disc);
    for (const char* filter : {"nearest", "bilinear", "area"}) {
        const Scene scene = scene_of(folder, disc_scene(filter, "over"));
        const SplatSet set = load_source(scene.layers[0].source, "disc");
        ASSERT_GT(set.size(), 30000) << filter;
        EXPECT_GT(set.zero_alpha, 10000) << filter;
        float faintest = 1.0f, error = 0.0f;
        for (std::int64_t i = 0; i < set.size(); ++i) {
            faintest = std::min(faintest, set.alpha[i]);
            for (int k = 0; k < 3; ++k)
                error = std::max(error, std::fabs(set.color[i][k] / linear_color()[k] - 1.0f));
        }
        EXPECT_GT(faintest, 0.0f) << filter;
        EXPECT_LT(faintest, 0.02f) << filter;
        EXPECT_LT(error, 2e-6f) << filter;
    }
}

TEST(SoftEdge, RenderedPictureKeepsTheHue) {
    const TempFolder folder;
    write_png(folder / "disc.png", disc_px, disc_px, soft_disc);
    const Image over = render_text(folder, disc_scene("bilinear", "over")).beauty;
    int soft = 0;
    for (std::int64_t y = 0; y < 64; ++y)
        for (std::int64_t x = 0; x < 64; ++x) {
            const float* p = over.at(x, y);
            if (!(p[3] > 1e-4f)) continue;
            soft += p[3] < 0.9f;
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(p[k] / p[3], linear_color()[k], 1e-4f) << x << " " << y;
        }
    EXPECT_GT(soft, 500);
}

TEST(SoftEdge, StraightPngKeepsTheStoredColour) {
    const TempFolder folder;
    write_png(folder / "disc.png", disc_px, disc_px, soft_disc);
    const StoredFile file = read_stored_file(
        write_text(folder, disc_scene("bilinear", "over", "path = \"out.png\"\nalpha = \"straight\"")));
    int soft = 0;
    for (std::int64_t y = 0; y < 64; ++y)
        for (std::int64_t x = 0; x < 64; ++x) {
            const float alpha = file.at("A", x, y);
            if (alpha < 0.02f) continue;
            soft += alpha < 0.9f;
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(file.at(std::string(1, "RGB"[k]), x, y), stored[k], 1.01f / 255.0f)
                    << x << " " << y;
        }
    EXPECT_GT(soft, 500);
}

// A picture with a letter on it reads right: seen from the front, the top and the side, on every built-in
// shape, through both projections, and in the file that is written.

constexpr int letter_px = 64, view_px = 64;
constexpr const char* letter[8] = {"RR....GG",  //
                                   "R.####.G",  //
                                   "..#.....",  //
                                   "..##....",  //
                                   "..#.....",  //
                                   "..#.....",  //
                                   "B.#....Y",  //
                                   "BB....YY"};

/// Colour at (u, v), v = 0 at the bottom.
glm::vec3 letter_color(double u, double v) {
    const auto cell = [](double t) { return std::clamp(int(std::floor(t * 8.0)), 0, 7); };
    switch (letter[cell(1.0 - v)][cell(u)]) {
        case 'R':
            return {1.0f, 0.0f, 0.0f};
        case 'G':
            return {0.0f, 1.0f, 0.0f};
        case 'B':
            return {0.0f, 0.0f, 1.0f};
        case 'Y':
            return {1.0f, 1.0f, 0.0f};
        case '#':
            return {1.0f, 1.0f, 1.0f};
        default:
            return {0.1f, 0.1f, 0.1f};
    }
}

struct Uv {
    double u, v;
};
/// Where on the texture a place of the picture (-1..1 to the right and up) should look; nothing: not judged.
using Mapping = std::optional<Uv> (*)(double right, double up);

std::optional<Uv> whole(double right, double up) { return Uv{0.5 + 0.5 * right, 0.5 + 0.5 * up}; }
std::optional<Uv> inside_disc(double right, double up) {
    if (right * right + up * up > 0.9) return {};
    return whole(right, up);
}
/// Orthographic view of a sphere that fills the picture, whose map's centre faces the camera.
std::optional<Uv> sphere(double right, double up) {
    if (right * right + up * up > 0.85) return {};
    const double towards = std::sqrt(1.0 - right * right - up * up);
    return Uv{0.5 + std::atan2(right, towards) / (2.0 * real::pi), 0.5 + std::asin(up) / real::pi};
}

/// The eight ways to turn and mirror a square; 0 leaves it as it is.
Uv turned(Uv p, int way) {
    if (way & 1) p.u = 1.0 - p.u;
    if (way & 2) p.v = 1.0 - p.v;
    if (way & 4) std::swap(p.u, p.v);
    return p;
}

/// Mean absolute difference of a picture (RGB first) to the texture, turned.
double difference(const Image& image, Mapping mapping, int way, bool encoded) {
    double sum = 0.0, count = 0.0;
    for (std::int64_t y = 0; y < image.height; ++y)
        for (std::int64_t x = 0; x < image.width; ++x) {
            const double right = 2.0 * (double(x) + 0.5) / double(image.width) - 1.0;
            const double up = 1.0 - 2.0 * (double(y) + 0.5) / double(image.height);
            const std::optional<Uv> place = mapping(right, up);
            if (!place) continue;
            const Uv uv = turned(*place, way);
            const glm::vec3 color = letter_color(uv.u, uv.v);
            for (int k = 0; k < 3; ++k) {
                const double wanted = encoded ? real::linear_to_srgb(color[k]) : double(color[k]);
                sum += std::fabs(image.at(x, y)[k] - wanted);
                count += 1.0;
            }
        }
    return sum / count;
}

void expect_reads_right(const Image& image, Mapping mapping, bool encoded = false) {
    const double upright = difference(image, mapping, 0, encoded);
    EXPECT_LT(upright, 0.06);  // what the splats blur at the letter's edges
    for (int way = 1; way < 8; ++way)
        EXPECT_GT(difference(image, mapping, way, encoded), 3.0 * upright) << "way " << way;
}

struct View {
    const char *name, *mesh, *uv;
    const char* direction;  // from the target to the camera, 20 scene units
    Mapping mapping;
    bool in_perspective = true;  // whether that is judged, too
    friend void PrintTo(const View& given, std::ostream* out) { *out << given.name; }
};

std::string view_scene(const View& view, bool perspective, const std::string& output = "") {
    // From 20 scene units, the plane of 10 fills a field of view of 2 atan(5 / 20).
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [{px}, {px}]
{output}
[camera]
projection = "{projection}"
position = {direction}
height = 10.0
fov = 28.072486935852957
[[layer]]
name = "letter"
[layer.source]
meshes = [ {{ mesh = "{mesh}", texture = "letter.tif", relief = 0.02 }} ]
uv = "{uv}"
count = 200000
max_distance = 0.05
)",
                       fmt::arg("px", view_px), fmt::arg("output", output),
                       fmt::arg("projection", perspective ? "perspective" : "orthographic"),
                       fmt::arg("direction", view.direction), fmt::arg("mesh", view.mesh),
                       fmt::arg("uv", view.uv));
}

void write_letter(const TempFolder& folder) {
    write_float_tiff(folder / "letter.tif", letter_px, letter_px, [](int x, int y) {
        return glm::vec4(letter_color((x + 0.5) / letter_px, 1.0 - (y + 0.5) / letter_px), 1.0f);
    });
    const char* face = "f 1 2 3 4\n";
    folder.file("xy.obj", std::string("v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\n") + face);
    folder.file("xz.obj", std::string("v -5 0 5\nv 5 0 5\nv 5 0 -5\nv -5 0 -5\n") + face);
    folder.file("yz.obj", std::string("v 0 -5 5\nv 0 -5 -5\nv 0 5 -5\nv 0 5 5\n") + face);
}

class Orientation : public ::testing::TestWithParam<View> {};

TEST_P(Orientation, ReadsRight) {
    const TempFolder folder;
    write_letter(folder);
    for (const bool perspective : {false, true}) {
        if (perspective && !GetParam().in_perspective) continue;
        SCOPED_TRACE(perspective ? "perspective" : "orthographic");
        expect_reads_right(render_text(folder, view_scene(GetParam(), perspective)).beauty,
                           GetParam().mapping);
    }
}

INSTANTIATE_TEST_SUITE_P(Views, Orientation,
                         ::testing::Values(View{"PlanarXz", "xz.obj", "planar-xz", "[0, 20, 0]", whole},
                                           View{"PlanarXy", "xy.obj", "planar-xy", "[0, 0, 20]", whole},
                                           View{"PlanarYz", "yz.obj", "planar-yz", "[20, 0, 0]", whole},
                                           View{"Plane", "plane", "mesh", "[0, 20, 0]", whole},
                                           View{"Relief", "relief", "mesh", "[0, 20, 0]", whole},
                                           View{"Disk", "disk", "mesh", "[0, 20, 0]", inside_disc},
                                           View{"Sphere", "sphere", "mesh", "[0, 0, 20]", sphere, false}),
                         [](const ::testing::TestParamInfo<View>& view) { return view.param.name; });

TEST(OrientationOfFiles, PngTiffAndExrReadRight) {
    const TempFolder folder;
    write_letter(folder);
    const View plane{"Plane", "plane", "mesh", "[0, 20, 0]", whole};
    for (const char* name : {"out.png", "out.tif", "out.exr"}) {
        SCOPED_TRACE(name);
        const bool encoded = std::string(name) != "out.exr";
        const std::string output = fmt::format("frames = \"1\"\npath = \"{}\"", name);
        const StoredFile frame = read_stored_file(write_text(folder, view_scene(plane, true, output)));
        Image rgb = make_image(view_px, view_px, 3);
        for (std::int64_t y = 0; y < view_px; ++y)
            for (std::int64_t x = 0; x < view_px; ++x)
                for (int k = 0; k < 3; ++k) rgb.at(x, y)[k] = frame.at(std::string(1, "RGB"[k]), x, y);
        expect_reads_right(rgb, whole, encoded);
    }
}

}  // namespace
}  // namespace astrosplat
