// Pictures in whole scenes: their fidelity, and their stars.
#include "image/resample.h"
#include "measure_fidelity.h"
#include "pipeline.h"
#include "scene/layer_setup.h"
#include "scene/load.h"
#include "source/write_image.h"
#include "support/frames.h"
#include "support/painted_picture.h"
#include "support/small_scene.h"
#include "support/test.h"

namespace astrosplat {
namespace {

// Fidelity of whole scenes: what is rendered, what it is compared with, and what must not matter.

class Fidelity : public testing::Test {
  protected:
    Fidelity() {
        scene.layers.erase(scene.layers.begin());  // the sphere
        scene.layers[0].look.grade.gain = 1.0f;
        scene.layers[0].render.blend = Blend::over;
        scene.layers[0].source.count = 10000;
    }

    FidelityReport measured(const std::optional<fs::path>& reference = {}) const {
        FidelitySettings settings;
        settings.width_px = 160;
        return measure_fidelity(scene, fidelity_reference(scene, reference), settings);
    }

    SmallScene small;
    Scene& scene = small.scene;
};

TEST_F(Fidelity, APlaneOfSoftSplatsIsItsPicture) {
    const FidelityReport report = measured();
    EXPECT_EQ(report.layer, "dust");
    EXPECT_EQ(report.front.width_px, 160);
    EXPECT_EQ(report.front.height_px, 160);
    EXPECT_EQ(report.full.width_px, 64);
    EXPECT_GT(report.front.psnr_db, 25.0);
    EXPECT_NEAR(report.front.flux.frame, 1.0, 0.05);
    std::string mirrored = SmallScene::picture();
    for (std::size_t row = 13; row < mirrored.size(); row += 64 * 3)
        for (std::size_t x = 0; x < 32; ++x)
            std::swap_ranges(&mirrored[row + 3 * x], &mirrored[row + 3 * x] + 3,
                             &mirrored[row + 3 * (63 - x)]);
    EXPECT_GT(report.full.psnr_db, measured(small.folder.file("mirrored.ppm", mirrored)).full.psnr_db + 10.0);
    EXPECT_EQ(report.front_view.width, 160);
    EXPECT_EQ(report.side_view.height, 90);
    EXPECT_EQ(report.edge_view.height, 50);
    EXPECT_GT(report.edge.fwhm_over_length, 0.01);
}

TEST_F(Fidelity, LightOfAnAddedLayerDoublesWithItsGain) {
    scene.layers[0].render.blend = Blend::add;
    const FluxRatios once = measured().full.flux;
    scene.layers[0].look.grade.gain = 2.0f;
    const FluxRatios twice = measured().full.flux;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(twice.channels[c] / once.channels[c], 2.0, 1e-3);
}

TEST_F(Fidelity, DoesNotDependOnCameraSkyThreadsOrPlace) {
    const FidelityReport before = measured();
    scene.camera.position = glm::dvec3(0.0, -3.0, 1.0);
    scene.environment.image = small.folder / "picture.ppm";
    scene.output.width = 17;
    set_thread_count(1);
    const FidelityReport alone = measured();
    set_thread_count(0);
    EXPECT_EQ(alone.front.psnr_db, before.front.psnr_db);
    EXPECT_EQ(alone.full.ssim, before.full.ssim);
    EXPECT_EQ(alone.needles.share, before.needles.share);
    EXPECT_EQ(alone.edge.body_srgb, before.edge.body_srgb);
    scene.layers[0].transform = {{3.0, 1.0, -2.0}, {30.0, 50.0, 70.0}, 1.5};
    const FidelityReport elsewhere = measured();
    EXPECT_NEAR(elsewhere.front.psnr_db, before.front.psnr_db, 0.05);
    EXPECT_NEAR(elsewhere.front.flux.frame, before.front.flux.frame, 1e-3);
}

TEST_F(Fidelity, ThePictureIsSeenThroughThePixelFilter) {
    scene.output.pixel_filter = 4.0;
    const Image picture = fidelity_reference(scene, std::nullopt).picture;
    const Image filtered = resampled(picture, map_to_width(picture, 160, 160), 160, 160, 4.0);
    EXPECT_EQ(measured().front_reference.pixels, filtered.pixels);
}

TEST_F(Fidelity, AnotherPictureTakesThePlaceOfTheLayersOwn) {
    const double own = measured().full.psnr_db;
    const auto against = [&](const std::string& name, const std::string& text) {
        return measured(small.folder.file(name, text));
    };
    EXPECT_NEAR(against("same.ppm", SmallScene::picture()).full.psnr_db, own, 1e-3);
    const FidelityReport black = against("black.ppm", "P6\n64 64\n255\n" + std::string(64 * 64 * 3, '\0'));
    EXPECT_LT(black.full.psnr_db, 12.0);
    EXPECT_EQ(black.reference.filename(), "black.ppm");
    const std::string wide = message_of<InputError>(
        [&] { against("wide.ppm", "P6\n64 32\n255\n" + std::string(64 * 32 * 3, 'x')); });
    EXPECT_HAS(wide, "wide.ppm: expected the proportions of layer 'dust'");
}

TEST_F(Fidelity, ALayerThatIsNotVisibleCanNameThePicture) {
    scene.layers[0].visible = false;
    small.add_layer("seen", "plane", 20000);
    EXPECT_EQ(fidelity_reference(scene, std::nullopt).layer, "seen");
    scene.layers[1].source.kind = SourceKind::splats;
    EXPECT_EQ(fidelity_reference(scene, std::nullopt).layer, "dust");
    scene.layers.erase(scene.layers.begin());
    const std::string none = ERROR_OF(fidelity_reference(scene, std::nullopt));
    EXPECT_HAS(none, "a layer of kind \"mesh\"");
}

TEST_F(Fidelity, AStripIsNotBlownUpToTheWidthOfAPicture) {
    FidelityReference strip;
    strip.frame.width = 3.0;
    strip.frame.height = 2000.0;
    strip.picture = make_image(3, 2000, 3);
    EXPECT_EQ(strip.front_width_px(1280), 7);
    EXPECT_EQ(strip.front_width_px(3), 3);
    strip.picture = make_image(10, 6667, 3);
    EXPECT_EQ(strip.front_width_px(1280), 10);
    strip.frame.height = 2.0;
    EXPECT_EQ(strip.front_width_px(1280), 1280);
}

TEST_F(Fidelity, StopsWhenAsked) {
    const FidelityReference reference = fidelity_reference(scene, std::nullopt);
    const std::atomic<bool> stop{true};
    FidelitySettings settings;
    settings.begin_step = [&](const std::string&) { return Progress{{}, &stop}; };
    EXPECT_THROW(measure_fidelity(scene, reference, settings), Cancelled);
}

// The stars of a picture together with what the picture without them became: from its camera they have the
// table's light and place, whatever lies before them; elsewhere they have depth.

constexpr std::int64_t width_px = 96, height_px = 72;
constexpr int columns = 3, rows = 2, spacing_px = 28;

struct Planted {
    double x, y;  // px of the picture
    glm::dvec3 light;
};

class PictureStars : public testing::Test {
  protected:
    PictureStars() {
        Image picture = make_image(width_px, height_px, 3);
        for (std::int64_t y = 0; y < height_px; ++y)
            for (std::int64_t x = 0; x < width_px; ++x) {
                const float light = 0.08f + 0.06f * painted::fbm(double(x), double(y), 0.05, 3u);
                for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = light * (1.0f - 0.2f * float(c));
            }
        write_linear_image(folder / "picture.exr", picture, "", Existing::replace);
        std::string table = "x,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n";
        for (int i = 0; i < columns * rows; ++i) {
            const Planted star{22.0 + spacing_px * (i % columns) + 0.37 * (i % 3),
                               20.0 + spacing_px * (i / columns) + 0.21 * (i % 4),
                               (0.5 + 0.25 * i) * glm::dvec3(1.0, 0.8, 0.5)};
            planted.push_back(star);
            table += fmt::format("{},{},{},{},{},{},{},1.0,0\n", star.x, star.y, star.x / width_px,
                                 1.0 - star.y / height_px, star.light.x, star.light.y, star.light.z);
        }
        folder.file("stars.csv", table);
    }

    Scene scene(const std::string& source, const std::string& camera, const std::string& stars = "",
                const std::string& layer = "") const {
        return parse_scene(
            "astrosplat = 1\n[output]\nresolution = [96, 72]\n[camera]\n" + camera +
                "\n[[layer]]\nname = \"gas\"\n" + layer +
                "[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"picture.exr\" } ]\n" + source +
                "\n[[layer]]\nname = \"stars\"\n[layer.source]\nkind = \"stars\"\n"
                "catalogue = \"stars.csv\"\nlike = \"gas\"\n" +
                stars,
            folder / "scene.toml");
    }
    Scene in_front(const std::string& kind, const std::string& stars = "",
                   const std::string& layer = "") const {
        return scene(
            "uv = \"camera\"\nuv_camera = { position = [0, 12, 0], up = [0, 0, -1], fov = 35 }\n"
            "structure = { kind = \"" +
                kind + "\", stars = false }",
            "position = [0, 12, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nfov = 35", stars, layer);
    }

    /// The light of the layer of stars in the frame.
    static Image arrived(const Scene& scene, double times = 1.0) {
        Pipeline pipeline(scene);
        RenderSettings settings = settings_of(pipeline, 1.0);
        settings.width = std::llround(times * double(settings.width));
        settings.height = std::llround(times * double(settings.height));
        settings.aov_layers = true;
        return pipeline.frame(1.0, settings).layers.at(1);
    }

    /// Every star within a window of its own: the same light and place as in the picture.
    void expect_in_place(const Image& image, double times, double light_within) const {
        for (const Planted& star : planted) {
            const double x = star.x * times, y = star.y * times;
            const auto reach = std::int64_t(12.0 * times);
            glm::dvec3 sum(0.0);
            glm::dvec2 middle(0.0);
            for (auto j = std::int64_t(y) - reach; j <= std::int64_t(y) + reach; ++j)
                for (auto i = std::int64_t(x) - reach; i <= std::int64_t(x) + reach; ++i) {
                    const float* const p = image.at(i, j);
                    sum += glm::dvec3(p[0], p[1], p[2]);
                    middle += double(p[1]) * (glm::dvec2(i, j) + 0.5);
                }
            middle /= sum.y;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum[c] / (times * times * star.light[c]), 1.0, light_within)
                    << "at " << star.x << ", " << star.y << ", channel " << c;
            EXPECT_NEAR(middle.x / times, star.x, 0.05);
            EXPECT_NEAR(middle.y / times, star.y, 0.05);
        }
    }

    TempFolder folder;
    std::vector<Planted> planted;
};

TEST_F(PictureStars, LookAsInThePictureWhateverLiesBeforeThem) {
    for (const char* const kind : {"sheet", "disk"}) {
        SCOPED_TRACE(kind);
        expect_in_place(arrived(in_front(kind)), 1.0, 0.01);
    }
}

// Splats cover as much more of a larger frame; so does the light of stars.
TEST_F(PictureStars, AreAsBrightBesideTheirNebulaInFramesOfAnySize) {
    expect_in_place(arrived(in_front("sheet", "psf = 2.0"), 2.0), 2.0, 0.01);
}

TEST_F(PictureStars, AreSeenInPlaceWithoutACameraOfThePicture) {
    const std::string from_above =
        "projection = \"orthographic\"\nposition = [0, 9, 0]\ntarget = [0, 0, 0]\n"
        "up = [0, 0, -1]\nheight = 7.5";
    expect_in_place(arrived(scene("structure = { kind = \"sheet\", stars = false }", from_above)), 1.0, 0.01);
    // Columns are not looked through, and these let everything pass.
    expect_in_place(arrived(scene("count = 2000", from_above, "", "[layer.look]\ndensity = 0.0\n")), 1.0,
                    0.01);
}

SplatSet stars_of(const Scene& scene) {
    return load_source(SetCache{}, source_of(scene, scene.layers[1]), "stars").set;
}

TEST_F(PictureStars, HaveTheDepthThatIsAskedFor) {
    const SplatSet slab = stars_of(in_front("sheet", "slab = 4.0"));
    ASSERT_EQ(slab.size(), columns * rows);
    float lowest = 9.0f, highest = -9.0f;
    for (const glm::vec3& p : slab.position) {
        lowest = std::fmin(lowest, p.y);
        highest = std::fmax(highest, p.y);
    }
    EXPECT_GT(highest - lowest, 2.0f);
    EXPECT_GE(lowest, -2.0f);
    EXPECT_LE(highest, 2.0f);
    // Of columns, which hide none: in bodies those that are hidden come to the front.
    const SplatSet sorted = stars_of(scene("count = 2000", "", "slab = 4.0\ndepth = \"magnitude\""));
    for (std::int64_t i = 1; i < sorted.size(); ++i)  // rows grow brighter
        EXPECT_GT(sorted.position[i].y, sorted.position[i - 1].y);
    EXPECT_EQ(stars_of(in_front("sheet", "limit = 4.0")).size(), 3) << "those of a luminance of 1 and more";
}

TEST_F(PictureStars, AreTheSameForAnyThreads) {
    test::expect_same_bits([&] {
        const SplatSet stars = stars_of(in_front("disk"));
        return test::Bits() << stars.position << stars.color;
    });
}

TEST_F(PictureStars, GoWhereTheirPictureGoes) {
    const Scene scene =
        in_front("sheet", "[layer.transform]\nscale = 2.0\n",
                 "[layer.transform]\ntranslate = [1, 2, 3]\nrotate = [0, 90, 0]\nscale = 0.5\n");
    const RenderLayer layer = render_layer(scene, scene.layers[1]);
    EXPECT_EQ(layer.scale, 1.0);
    EXPECT_EQ(layer.translate, glm::dvec3(1, 2, 3));
    const glm::dvec3 p = layer.world_from_layer * glm::dvec3(1, 0, 0);
    EXPECT_NEAR(p.z, -1.0, 1e-12);
}

}  // namespace
}  // namespace astrosplat
