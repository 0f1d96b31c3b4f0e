// The demo scenes and presets load as they are committed: nothing they name is missing, every key is known.
#include <nlohmann/json.hpp>

#include "scene_fixture.h"
#include "support/test_data.h"

namespace astrosplat::test {
namespace {

class Assets : public SceneTest {};

TEST_F(Assets, DemoScenesListTheirFrames) {
    for (const auto& [name, last] : {std::pair{"whirlpool", "0240"},
                                     {"spiral", "0240"},
                                     {"nebula", "0240"},
                                     {"dome", "0240"},
                                     {"powers-of-ten", "0300"},
                                     {"layers", "0120"},
                                     {"m51", "0096"},
                                     {"s106", "0096"}}) {
        const std::string scene = fmt::format("{}/assets/scenes/{}.toml", ASTROSPLAT_SOURCE_DIR, name);
        const RunResult result = run({"--batch", scene, "--dry-run", "--output", "shot.####.png"});
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find(fmt::format("shot.{}.png", last)), std::string::npos) << result.out;
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
        const RunResult result = run({"--batch", "preset.toml"});
        EXPECT_EQ(result.code, 0) << result.err;
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
    const RunResult result =
        run({"--batch", scene, "-f", frames, "--resolution", "160x90", "-o", "frame.####.exr", "-q", "--set",
             "layer.spiral.source.splats=60000", "--set", "layer.nebula.source.splats=30000", "--set",
             "layer.stars.source.count=50000"});
    ASSERT_EQ(result.code, 0) << result.err;
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
        const RunResult result = run({"fidelity", "look.toml", "-o", "look.json"});
        ASSERT_EQ(result.code, 0) << result.err;
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

}  // namespace
}  // namespace astrosplat::test
