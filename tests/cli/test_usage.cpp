// How the program is called: help, names, refusals, libraries.

#include <regex>

#include "cli/scene_fixture.h"
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// Help, version, and every way to call the program wrongly: one line, exit code 2, nothing written.

class Usage : public SceneTest {};

TEST_F(Usage, HelpAndVersionAreEverywhere) {
    for (const char* command : {"", "new", "generate", "convert", "info", "compare", "parameters"}) {
        Words start;
        if (*command) start.push_back(command);
        for (const char* option : {"-h", "--help", "--version"}) {
            Words arguments = start;
            arguments.push_back(option);
            const RunResult result = run(arguments);
            EXPECT_EQ(result.code, 0) << command << " " << option << result.err;
            EXPECT_EQ(result.err, "");
            EXPECT_HAS(result.out, option[2] == 'v' ? "astrosplat 0." : "--help");
        }
    }
}

TEST_F(Usage, TheVersionSaysWhatItWasBuiltOf) {
    const std::string text = run({"--version"}).out;
    EXPECT_TRUE(std::regex_match(
        text,
        std::regex(
            "astrosplat [0-9.]+\\ncommit ([0-9a-f]{12}(-dirty)?|unknown)\\nbuilt with (GCC|Clang) [^\\n]+, "
            "[A-Za-z]+\\nlibraries OpenEXR 3[^\\n]+, OpenImageIO 2[^\\n]+\\ninstructions [a-z0-9]+\\n")))
        << text;
    // Where a library was not found, its number would be missing.
    EXPECT_FALSE(std::regex_search(text, std::regex("[A-Za-z] ?(,|\\n[^\\n]*instructions)"))) << text;
    const std::string head =
        run_program({"/bin/sh", "-c", "git -C '" ASTROSPLAT_SOURCE_DIR "' rev-parse --short=12 HEAD"}).out;
    if (head.size() == 13) {
        EXPECT_NE(text.find("commit " + head.substr(0, 12)), std::string::npos) << text << head;
    }
}

TEST_F(Usage, HelpNamesEveryOptionOfTheDesign) {
    const std::string help = run({"--help"}).out;
    for (const char* option :
         {"--batch",      "-f,--frames", "-o,--output", "--resolution", "--set",       "--layers",
          "-t,--threads", "--memory",    "--region",    "--resume",     "--overwrite", "--dry-run",
          "--stats",      "--cache",     "--no-cache",  "--progress",   "-v,",         "-q,",
          "new",          "generate",    "convert",     "info",         "compare",     "parameters"}) {
        EXPECT_HAS(help, option);
    }
}

TEST_F(Usage, WithoutADisplayTheWaysOutAreNamed) {
    for (const Words& words : {Words{}, {"scene.toml"}}) {
        const RunResult result = run(words);
        expect_one_line(result, 2, "no window: ");
        for (const char* way : {"--batch", "--screenshot"}) EXPECT_HAS(result.err, way);
    }
}

TEST_F(Usage, TestsNeverOpenAWindow) {
    setenv("DISPLAY", ":4711", 1);
    const RunResult result = run_program({"/bin/sh", "-c", "echo $DISPLAY$WAYLAND_DISPLAY"});
    unsetenv("DISPLAY");
    EXPECT_EQ(result.out, "\n");
}

TEST_F(Usage, MistakesAreOneLineAndCode2) {
    expect_one_line(batch({"--frobnicate"}), 2, "--frobnicate");
    expect_one_line(batch({"other.toml"}), 2, "other.toml");
    expect_one_line(run({"--batch"}), 2, "scene");
    expect_one_line(run({"--batch", "missing.toml"}), 2, "missing.toml");
    expect_one_line(run({"info"}), 2, "FILE");
    expect_one_line(run({"info", "missing.png"}), 2, "missing.png");
    expect_one_line(run({"convert", "stars.pda"}), 2, "OUT");
    expect_one_line(run({"generate", "scene.toml", "--layer", "stars"}), 2, "--output");
    expect_one_line(run({"--batch", "info", "stars.pda"}), 2, "--batch");
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(Usage, BadOptionValuesNameTheOptionAndTheValue) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"--threads", "0"},       {"--threads", "two"},     {"--memory", "-1"},
        {"--memory", "4GB"},      {"--region", "1,2,3"},    {"--region", "0,0,65,48"},
        {"--region", "-1,0,4,4"}, {"--region", "0,0,0,4"},  {"--resolution", "1920"},
        {"--resolution", "0x5"},  {"--resolution", "-50%"}, {"--resolution", "axb"},
        {"--frames", "1-"},       {"--frames", "5-1"},      {"--frames", ""},
        {"--layers", "nothing"},  {"--set", "output.fps"},  {"--progress", "loud"},
    };
    for (const auto& [option, value] : cases) {
        const RunResult result = batch({option + "=" + value});
        expect_one_line(result, 2, value);
        EXPECT_HAS(result.err, option);
    }
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(Usage, DraftsOfDomesAreSmallerButSquare) {
    expect_one_line(batch({"--set", "output.preset=dome", "--resolution", "64x48"}), 2,
                    "--resolution: expected a square for the preset dome, found '64x48'");
    expect_success(batch({"--set", "output.preset=dome", "--resolution", "64x64", "-f", "1"}));
}

TEST_F(Usage, BadScenesNameFileAndLine) {
    write_scene("[outptu]\n");
    const RunResult result = batch();
    EXPECT_EQ(result.code, 2);
    EXPECT_TRUE(std::regex_search(result.err, std::regex("scene\\.toml:[0-9]+: .*outptu"))) << result.err;
    EXPECT_EQ(line_count(result.err), 1) << result.err;
    write_scene();
    expect_one_line(batch({"--set", "layer.stars.look.alpha.powr=2"}), 2, "alpha.power");
}

TEST_F(Usage, MissingInputsAreNamed) {
    fs::remove(folder / "dust.pda");
    const RunResult result = batch();
    expect_one_line(result, 2, "dust.pda");
    EXPECT_FALSE(fs::exists(folder / "frames"));
}

TEST_F(Usage, SeveralFramesNeedAFrameToken) {
    expect_one_line(batch({"-o", "one.exr"}), 2, "one.exr");
    expect_success(batch({"-o", "one.exr", "-f", "2"}));
    EXPECT_TRUE(fs::exists(folder / "one.exr"));
}

// Short names of looks and scenes: beside the scene, then the person's own, then those that come with the
// program.

class Names : public SceneTest {
  protected:
    static std::string look(const std::string& opacity) {
        return "astrosplat = 1\n[render]\nopacity = " + opacity + "\n";
    }
    void write_scene_with(const std::string& preset) {
        write_text(folder / "named.toml",
                   "astrosplat = 1\n[output]\nresolution = [32, 24]\npath = \"n.exr\"\nframes = "
                   "\"1\"\n[camera]\nposition = [0, 0, 9]\n[[layer]]\nname = "
                   "\"a\"\npreset = \"" +
                       preset +
                       "\"\n[layer.source]\nkind = "
                       "\"splats\"\nfile = \"stars.pda\"\n");
    }
    RunOptions own_data() const {
        RunOptions options;
        options.environment = {"XDG_DATA_HOME=" + (folder / "data ö").string()};
        return options;
    }
    /// Hash of the frame's pixels.
    std::string pixels() const {
        expect_success(run({"--batch", "named.toml", "--overwrite", "-q", "--stats", "s.json"}, own_data()));
        return json("s.json").at("frames").at(0).at("sha256");
    }
};

TEST_F(Names, OfLooksAreFoundBesideTheSceneThenThePersonsThenThePrograms) {
    write_scene_with("s106");
    const std::string shipped = pixels();
    write_text(folder / "data ö/astrosplat/looks/s106.toml", look("0.5"));
    const std::string own = pixels();
    EXPECT_NE(own, shipped);
    write_text(folder / "s106.toml", look("0.25"));
    const std::string beside = pixels();
    EXPECT_NE(beside, own);
    EXPECT_NE(beside, shipped);
    write_scene_with("data ö/astrosplat/looks/s106.toml");
    EXPECT_EQ(pixels(), own) << "a file's name means that file";
}

TEST_F(Names, ThatAreNotKnownNameThoseThatAre) {
    write_scene_with("s107");
    write_text(folder / "data ö/astrosplat/looks/mine.toml", look("0.5"));
    const RunResult result = run({"--batch", "named.toml"}, own_data());
    EXPECT_EQ(result.code, 2);
    EXPECT_HAS(result.err, "by name: m51, mine, s106");
    write_scene_with("s106.tom");
    EXPECT_EQ(run({"--batch", "named.toml"}, own_data()).code, 2) << "an ending makes it a file";
}

TEST_F(Names, OfScenes) {
    const RunResult known =
        expect_success(run({"--batch", "spiral", "--dry-run", "-f", "1", "-o", "a.exr"}, own_data()));
    EXPECT_HAS(known.out, "scenes/spiral.toml");
    EXPECT_EQ(run({"--batch", "scene", "--dry-run"}, own_data()).code, 0) << "beside";
    const RunResult unknown = run({"--batch", "spirale", "--dry-run"}, own_data());
    EXPECT_EQ(unknown.code, 2);
}

// The libraries that the program loads when it starts.

class Start : public SceneTest {
  protected:
    void SetUp() override {
        SceneTest::SetUp();
#if !defined(__x86_64__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        GTEST_SKIP() << "only x86-64 without sanitizers has the lazy loader";
#endif
    }

    /// The libraries that the dynamic linker loaded during a run, by its own account.
    std::string libraries_of(const Words& arguments) const {
        const fs::path report = folder / ("libraries of " + arguments[0]);
        fs::remove_all(report);
        fs::create_directories(report);
        const std::string output = "LD_DEBUG_OUTPUT=" + (report / "report").string();
        expect_success(run(arguments, {.environment = {"LD_DEBUG=files", output}}));
        std::string text;
        for (const auto& entry : fs::directory_iterator(report)) text += text_of(entry.path());
        return text;
    }
};

// With all that it needs OpenImageIO is 250 libraries, a fifth of a second and 100 MB.
TEST_F(Start, ThePictureLibraryWaitsForTheFirstPicture) {
    write_text(folder / "picture.ppm", small_picture());
    const std::string library = "libOpenImageIO.so", colors = "libOpenColorIO.so";
    EXPECT_HAS(libraries_of({"info", "picture.ppm"}), library);
    const std::string without = libraries_of({"parameters"});
    EXPECT_HAS(without, "libc.so");
    EXPECT_EQ(without.find(library), std::string::npos);
    EXPECT_EQ(without.find(colors), std::string::npos);
    EXPECT_EQ(libraries_of({"info", "stars.pda"}).find(library), std::string::npos);
}

TEST_F(Start, FramesAreWrittenAndResumedWithoutIt) {
    for (const char* file : {"frame.exr", "frame.png", "frame.tif"}) {
        for (const char* how : {"--overwrite", "--resume"}) {
            const std::string loaded =
                libraries_of({"--batch", "scene.toml", "--frames", "1", "--output", file, how});
            EXPECT_HAS(loaded, "libc.so");
            EXPECT_EQ(loaded.find("libOpenImageIO.so"), std::string::npos) << file << " " << how;
        }
    }
}

}  // namespace
}  // namespace astrosplat::test
