// Scenes that come with the program, and those that `new` makes of pictures.

#include <nlohmann/json.hpp>

#include "scene_fixture.h"
#include "support/painted_picture.h"
#include "support/test_data.h"

namespace astrosplat::test {
namespace {

// The demo scenes and presets load as they are committed: nothing they name is missing, every key is known.

class Assets : public SceneTest {};

TEST_F(Assets, DemoScenesListTheirFrames) {
    for (const auto& [name, last] : {std::pair{"whirlpool", "0240"},
                                     {"inclined", "0240"},
                                     {"spiral", "0240"},
                                     {"nebula", "0240"},
                                     {"dome", "0240"},
                                     {"powers-of-ten", "0300"},
                                     {"layers", "0120"},
                                     {"m51", "0096"},
                                     {"s106", "0096"}}) {
        const std::string scene = fmt::format("{}/assets/scenes/{}.toml", ASTROSPLAT_SOURCE_DIR, name);
        const RunResult result = expect_success(
            run({"--batch", scene, "--dry-run", "-o", "shot.####.png", "--resolution", "48x27"}));
        EXPECT_HAS(result.out, fmt::format("shot.{}.png", last));
    }
}

TEST_F(Assets, PresetsAreLooks) {
    write_text(folder / "picture.ppm", small_picture());
    for (const char* name : {"s106", "m51"}) {
        write_text(
            folder / "preset.toml",
            fmt::format(
                "astrosplat = 1\n[output]\nframes = \"1\"\npath = \"{}.png\"\nresolution = [48, 32]\n"
                "[[layer]]\nname = \"gas\"\npreset = \"{}/assets/looks/{}.toml\"\n"
                "[layer.source]\nmeshes = [ {{ mesh = \"plane\", texture = \"picture.ppm\" }} ]\n"
                "count = 2000\n{}",
                name, ASTROSPLAT_SOURCE_DIR, name,
                std::string(name) == "m51" ? "[layer.look]\nthickness = { map = \"picture.ppm\" }\n" : ""));
        expect_success(run({"--batch", "preset.toml"}));
        EXPECT_TRUE(fs::exists(folder / (std::string(name) + ".png")));
    }
}

class AssetsNightly : public SceneTest {};

// Of four frames in a row the middle two differ as much as their neighbours, wherever the flight is: from
// outside, among the first stars, in the galaxy and at the nebula. What pops makes one step larger. With a
// fraction of the splats, whose frames differ within 5 %.
TEST_F(AssetsNightly, ThePowersOfTenPassWithoutAPop) {
    const std::string scene = fmt::format("{}/assets/scenes/powers-of-ten.toml", ASTROSPLAT_SOURCE_DIR);
    const std::vector<int> firsts = {20, 60, 86, 120, 150, 195, 250, 290};
    std::string frames;
    for (const int first : firsts)
        frames += fmt::format("{}{}-{}", frames.empty() ? "" : ",", first, first + 3);
    expect_success(run({"--batch", scene, "-f", frames, "--resolution", "160x90", "-o", "frame.####.exr",
                        "-q", "--set", "layer.spiral.source.splats=60000", "--set",
                        "layer.nebula.source.splats=30000", "--set", "layer.stars.source.count=50000"}));
    const auto difference = [&](int from) {
        const auto file = [](int frame) { return fmt::format("frame.{:04}.exr", frame); };
        const RunResult compared = run({"compare", file(from), file(from + 1), "--json"});
        return nlohmann::json::parse(compared.out)["mean_difference"].get<double>();
    };
    for (const int first : firsts) {
        const double around = 0.5 * (difference(first) + difference(first + 2));
        EXPECT_GT(around, 1e-4) << first;
        EXPECT_NEAR(difference(first + 1) / around, 1.0, 0.1) << first;
    }
}

/// Fidelity of a picture on a plane under a shipped look.
class ShippedLook : public SceneTest {
  protected:
    void expect_true(const std::string& look, const fs::path& picture, const std::string& keys) {
        write_text(
            folder / "look.toml",
            fmt::format("astrosplat = 1\n[[layer]]\nname = \"gas\"\npreset = \"{0}/assets/looks/{1}\"\n"
                        "[layer.source]\nmeshes = [ {{ mesh = \"plane\", texture = \"{2}\" }} ]\n"
                        "count = 400000\nmax_distance = 0.3\n{3}",
                        ASTROSPLAT_SOURCE_DIR, look, picture.string(), keys));
        expect_success(run({"fidelity", "look.toml", "-o", "look.json"}));
        const auto front = nlohmann::json::parse(text_of(folder / "look.json"))["front"];
        EXPECT_NEAR(front["flux_ratio"]["frame"].get<double>(), 1.0, 0.08);
        EXPECT_GT(front["psnr_db"].get<double>(), 20.0);
    }
};

TEST_F(ShippedLook, S106ShowsARealNebulaAsItIs) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(nebula, "images/red_spider_heic0109a.jpg");
    expect_true("s106.toml", nebula, "");
}

TEST_F(ShippedLook, M51ShowsARealGalaxyAsItIs) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(galaxy, "images/m101_heic0602a.jpg");
    expect_true(
        "m51.toml", galaxy,
        fmt::format("[layer.look]\nthickness = {{ map = \"{}/assets/textures/whirlpool_thickness.png\" }}\n",
                    ASTROSPLAT_SOURCE_DIR));
}

// Scenes that `new` makes of pictures, untouched, against the targets of fidelity: pictures painted by
// formula at reduced size, and at night real ones where they are present. Columns matched to their picture:
// its light.

double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::string as_pixmap(const Image& light) {
    return pixmap(int(light.width), int(light.height), [&](int x, int y, int k) {
        return std::lround(255.0 * srgb(std::min(1.0, double(light.at(x, y)[k]))));
    });
}

// With stars enough for the 400 points that are looked at from the side to be points.
std::string field_of(Image light) {
    painted::add_stars(light, 500, 1.0);
    return as_pixmap(light);
}

struct Target {
    double psnr_db, ssim;
};
constexpr Target of_most{39.0, 0.98}, of_remnants{36.0, 0.97};

class TableTest : public SceneTest {
  protected:
    static void expect_flux(const nlohmann::json& flux) {
        EXPECT_NEAR(flux.at("frame").get<double>(), 1.0, 0.005);
        EXPECT_NEAR(flux.at("cells_percentile_5").get<double>(), 1.0, 0.02);
        EXPECT_NEAR(flux.at("cells_percentile_95").get<double>(), 1.0, 0.02);
    }

    void expect_targets(const std::string& picture, const Target& target) {
        expect_success(run({"new", picture, "-o", "picture.toml", "--overwrite"}));
        expect_success(run({"fidelity", "picture.toml", "-o", "report.json", "--overwrite"}));
        const nlohmann::json report = json("report.json");
        const nlohmann::json &front = report.at("front"), &full = report.at("full_size");
        EXPECT_GE(front.at("psnr_db").get<double>(), target.psnr_db);
        EXPECT_GE(front.at("ssim").get<double>(), target.ssim);
        EXPECT_GE(full.at("psnr_db").get<double>(), 36.0);
        EXPECT_GE(full.at("ssim").get<double>(), 0.96);
        expect_flux(front.at("flux_ratio"));
        EXPECT_LE(report.at("side").at("needles_share").get<double>(), 0.05);
    }
    void expect_targets_of(const Image& painted, const std::string& kind, const Target& target) {
        write_text(folder / "painted.ppm", field_of(painted));
        expect_targets("painted.ppm", target);
        EXPECT_HAS(text_of(folder / "picture.toml"), "kind = \"" + kind + "\"");
    }
};

TEST_F(TableTest, APaintedGalaxyIsADiskThatReachesThem) {
    expect_targets_of(painted::galaxy(960, 600), "disk", of_most);
    const nlohmann::json edge = json("report.json").at("edge");
    EXPECT_GE(edge.at("fwhm_over_length").get<double>(), 0.06);
    EXPECT_LE(edge.at("fwhm_over_length").get<double>(), 0.10);
    EXPECT_GE(edge.at("center_over_half_radius").get<double>(), 2.0) << "the least of seven seeds";
}

// Which of the brightest stars lie before the disk's half radius from the side is chance: center over half
// radius is 2.0 to 5.2 with seven seeds. The median of three is what is asked for.
TEST_F(TableTest, APaintedGalaxysMiddleStandsOutNightly) {
    write_text(folder / "galaxy.ppm", field_of(painted::galaxy(960, 600)));
    expect_success(run({"new", "galaxy.ppm", "-o", "picture.toml"}));
    std::vector<double> widths, centers;
    for (const char* seed : {"0", "1", "2"}) {
        const std::string set = std::string("layer.galaxy.source.seed=") + seed;
        expect_success(run({"fidelity", "picture.toml", "--set", set, "-o", "report.json", "--overwrite"}));
        const nlohmann::json edge = json("report.json").at("edge");
        widths.push_back(edge.at("fwhm_over_length"));
        centers.push_back(edge.at("center_over_half_radius"));
    }
    std::ranges::sort(widths);
    std::ranges::sort(centers);
    EXPECT_GE(widths[1], 0.06);
    EXPECT_LE(widths[1], 0.10);
    EXPECT_GE(centers[1], 2.5);
}

// The middle of a larger picture: its light goes on to the edges.
Image middle_of(const Image& image, std::int64_t width, std::int64_t height) {
    Image out = make_image(width, height, image.channels);
    for (std::int64_t y = 0; y < height; ++y)
        std::copy_n(image.at((image.width - width) / 2, (image.height - height) / 2 + y),
                    width * image.channels, out.at(0, y));
    return out;
}

TEST_F(TableTest, ANebulaBeyondThePictureIsASheetThatReachesThem) {
    expect_targets_of(middle_of(painted::nebula(1280, 800), 480, 300), "sheet", of_most);
}

TEST_F(TableTest, APaintedRemnantIsTwoWallsThatReachThem) {
    expect_targets_of(painted::remnant(960, 600), "walls", of_remnants);
}

// Of the night, as its walls take the longest of all and are those of the remnant.
TEST_F(TableTest, APaintedNebulaIsAShellThatReachesThemNightly) {
    expect_targets_of(painted::nebula(960, 600), "walls", of_most);
}

TEST_F(TableTest, AMatchedPlaneOfColumnsHasItsPicturesLightUnderEveryBlend) {
    write_text(folder / "plane.ppm", as_pixmap(painted::nebula(640, 400)));
    expect_success(run({"new", "plane.ppm", "--as", "plane", "-o", "plane.toml"}));
    for (const std::string blend : {"over", "add", "screen"}) {
        SCOPED_TRACE(blend);
        expect_success(
            run({"fidelity", "plane.toml", "-o", "report.json", "--overwrite", "--set",
                 "layer.plane.source.count=560000", "--set", "layer.plane.look.vertical.match=picture",
                 "--set", "layer.plane.render.blend=" + blend}));
        for (const char* size : {"front", "full_size"})
            expect_flux(json("report.json").at(size).at("flux_ratio"));
    }
}

// The grey FITS centre of the Milky Way is not here: 34.6 dB, and 35.4 at its full size. Which of 400 points
// are needles is partly chance: Bubble (heic1608a) has .040 and Pillars (heic1501a) .035 with their own
// seeds; with seeds 1 to 3 Pillars have .050 to .0675. Their flat pictures have .030 and .050 by themselves.
TEST_F(TableTest, RealPicturesReachThemNightly) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(images, "images");
    for (const char* name :
         {"m101_heic0602a.jpg", "heic1305a.jpg", "heic0706a.jpg", "red_spider_heic0109a.jpg", "heic1310a.jpg",
          "heic1501a.jpg", "heic1608a.jpg", "m42.png"}) {
        SCOPED_TRACE(name);
        expect_targets((images / name).string(), of_most);
    }
    SCOPED_TRACE("heic0515a.jpg");
    expect_targets((images / "heic0515a.jpg").string(), of_remnants);
}

}  // namespace
}  // namespace astrosplat::test
