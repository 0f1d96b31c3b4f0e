// Frames that are written through a configuration of OpenColorIO: whose numbers, what their hash knows, and
// what is said where a name is wrong.
#include "cli/scene_fixture.h"
#include "source/texture.h"
#include "support/color_config.h"

namespace astrosplat::test {
namespace {

class ColorConfigBatch : public SceneTest {
  protected:
    ColorConfigBatch() { write_color_config(folder); }

    RunResult one(const std::string& file, Words more, const std::string& ocio = "") const {
        return batch(joined(more, {"-q", "--frames", "1", "-o", file}), {.environment = {"OCIO=" + ocio}});
    }
    static Words film() {
        return {"--set", "output.ocio.config=\"colors.ocio\"", "--set", "output.exposure=1"};
    }
};

TEST_F(ColorConfigBatch, PicturesHoldTheViewAndLightStaysLight) {
    for (const char* file : {"light.exr", "film.png"}) {
        Words more = film();
        if (std::string(file) == "film.png") more.insert(more.end(), {"--set", "output.depth=\"16\""});
        ASSERT_EQ(one(file, more).code, 0) << file;
    }
    expect_success(one("plain.exr", {"--set", "output.exposure=1"}));
    EXPECT_TRUE(text_of(folder / "light.exr") == text_of(folder / "plain.exr"))
        << "scene light knows no view, nor does its hash";
    const Image light = load_raw_image(folder / "light.exr"), shown = load_raw_image(folder / "film.png");
    int bright = 0;
    for (std::int64_t y = 0; y < light.height; ++y)
        for (std::int64_t x = 0; x < light.width; ++x) {
            const float* p = light.at(x, y);
            const auto expected = test::film(2.0 * p[0], 2.0 * p[1], 2.0 * p[2]);
            bright += p[0] > 0.05f;
            for (int c = 0; c < 3; ++c)  // light is stored in half floats
                ASSERT_NEAR(shown.at(x, y)[c], expected[static_cast<std::size_t>(c)], 2e-3) << x << " " << y;
        }
    EXPECT_GT(bright, 100);
}

TEST_F(ColorConfigBatch, TheSceneNamesItOrTheEnvironment) {
    write_scene("[output.ocio]\nconfig = \"colors.ocio\"\nview = \"Negative\"\n");
    expect_success(one("scene.png", {}));
    write_scene();
    expect_success(
        one("named.png", {"--set", "output.ocio.view=\"Negative\""}, (folder / "colors.ocio").string()));
    EXPECT_TRUE(text_of(folder / "scene.png") == text_of(folder / "named.png"));
    expect_success(one("own.png", {}));
    expect_success(one("unasked.png", {}, (folder / "colors.ocio").string()));
    EXPECT_TRUE(text_of(folder / "own.png") == text_of(folder / "unasked.png"))
        << "a scene that names nothing is the same everywhere";
    EXPECT_FALSE(text_of(folder / "own.png") == text_of(folder / "named.png"));
}

TEST_F(ColorConfigBatch, OtherBytesOfTheConfigurationOrItsTablesAreAnotherFrame) {
    const Words words{"--set", "output.ocio.config=\"colors.ocio\"", "--set", "output.ocio.view=\"Negative\"",
                      "--resume"};
    expect_success(one("a.png", words));
    expect_success(one("a.png", words));
    for (const char* name : {"negative.cube", "colors.ocio"}) {
        const std::string before = text_of(folder / name);
        write_text(folder / name, before + "# another byte\n");
        const RunResult other = one("a.png", words);
        EXPECT_EQ(other.code, 2) << name;
        EXPECT_HAS(other.err, "holds a frame of other settings");
        write_text(folder / name, before);
    }
    expect_success(one("a.png", words));
}

TEST_F(ColorConfigBatch, OneLineAndNothingIsStarted) {
    write_scene("[output.ocio]\nconfig = \"colors.ocio\"\ndisplay = \"Screan\"\n");
    const RunResult display = one("a.png", {});
    EXPECT_EQ(display.code, 2);
    const std::string line =
        "scene.toml:24: output.ocio.display: expected Screen or Projector of colors.ocio, found 'Screan'\n";
    EXPECT_HAS(display.err, line);
    EXPECT_EQ(one("a.exr", {}).code, 0) << "no view is written";
    write_scene();
    const RunResult missing = one("a.png", {"--set", "output.ocio.config=\"missing.ocio\""});
    EXPECT_EQ(missing.code, 2);
    EXPECT_HAS(missing.err, "missing.ocio: cannot be read: No such file");
    const RunResult none = one("a.png", {"--set", "output.ocio.view=\"Film\""});
    EXPECT_EQ(none.code, 2);
    EXPECT_HAS(none.err, "output.ocio.config: expected a file");
    EXPECT_FALSE(fs::exists(folder / "a.png"));
}

}  // namespace
}  // namespace astrosplat::test
