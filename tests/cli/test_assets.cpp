// The demo scenes and presets load as they are committed: nothing they name is missing, every key is known.
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Assets : public SceneTest {};

TEST_F(Assets, DemoScenesListTheirFrames) {
    for (const char* name : {"whirlpool", "nebula"}) {
        const std::string scene = std::string(ASTROSPLAT_SOURCE_DIR) + "/assets/scenes/" + name + ".toml";
        const RunResult result = run({"--batch", scene, "--dry-run", "--output", "shot.####.png"});
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find("shot.0240.png"), std::string::npos) << result.out;
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

}  // namespace
}  // namespace astrosplat::test
