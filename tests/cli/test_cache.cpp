// The cache of generated sets as users meet it: the second run starts from it with the same pixels, a look
// never touches it, processes share it, and it never fails a run.
#include <chrono>
#include <thread>

#include "core/memory.h"
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Cache : public SceneTest {
  protected:
    Cache() {
        write_text(folder / "picture.ppm", small_picture());
        write_text(folder / "scene.toml", R"(astrosplat = 1
[output]
resolution = [64, 48]
frames = "1"
path = "frames/shot.####.exr"
[[layer]]
name = "gas"
[layer.source]
meshes = [ { mesh = "plane", texture = "picture.ppm" } ]
voxel_size = 0.2
)");
    }
    /// The message of a run with these options about its layer, and the sha256 of its frame.
    struct Figures {
        bool cached, geometry_cached;
        std::int64_t kept, test_positions;
        std::string sha256;
    };
    Figures figures(Words more, const RunOptions& options = {}) const {
        const Words sha256 = hashes(more, options);
        const nlohmann::json layer = json("stats.json").at("layers").at(0);
        return {layer.at("cached"), layer.at("geometry_cached"), layer.at("kept"), layer.at("test_positions"),
                sha256.at(0)};
    }
    Words names_in(const std::string& relative, const std::string& ending) const {
        Words names;
        for (const std::string& name : SceneTest::names_in(relative))
            if (fs::path(name).extension() == ending) names.push_back(name);
        return names;
    }
    using SceneTest::names_in;
    Words sets_in(const std::string& relative) const { return names_in(relative, ".splats"); }
    Words texels_in(const std::string& relative) const { return names_in(relative, ".texels"); }
    /// Starts a run that generates for a while, and returns once it does.
    std::unique_ptr<RunningProgram> generating_run() const {
        std::unique_ptr<RunningProgram> program(new RunningProgram(started(
            {"--batch", "scene.toml", "--cache", "sets", "--set", "layer.gas.source.voxel_size=0.02"})));
        while (program->running() && names_in("sets").empty())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return program;
    }
};

TEST_F(Cache, TheSecondRunTakesTheSetAndGivesTheSamePixels) {
    const Figures first = figures({}), second = figures({}), without = figures({"--no-cache"});
    EXPECT_FALSE(first.cached);
    EXPECT_TRUE(second.cached);
    EXPECT_FALSE(without.cached);
    EXPECT_EQ(second.sha256, first.sha256);
    EXPECT_EQ(without.sha256, first.sha256);
    EXPECT_EQ(second.kept, first.kept);
    EXPECT_EQ(second.test_positions, first.test_positions);
    EXPECT_EQ(sets_in("sets").size(), 1u);
    EXPECT_EQ(texels_in("sets").size(), 1u);
    EXPECT_EQ(names_in("sets").size(), 2u);
}

TEST_F(Cache, CellsOfThePictureAreMatchedInCachedSetsToo) {
    const auto matched = [&](const char* match, Words more = {}) {
        more.insert(more.end(),
                    {"--set", fmt::format("layer.gas.look.vertical.match=\"{}\"", match), "--set",
                     "layer.gas.look.density=0.3", "--set",
                     "layer.gas.source.meshes=[{ mesh = \"plane\", texture = \"picture.ppm\" }, { mesh = "
                     "\"sphere\", texture = \"picture.ppm\" }]"});
        return figures(more).sha256;
    };
    const std::string first = matched("picture");
    EXPECT_EQ(matched("picture"), first);
    EXPECT_EQ(matched("picture", {"--no-cache"}), first);
    EXPECT_NE(matched("coverage"), first);
}

TEST_F(Cache, ScenesThatDifferInTheirLevelsShareTheirGeometry) {
    figures({});
    std::string picture = small_picture();
    picture.back() ^= 1;
    write_text(folder / "other.ppm", picture);
    const Words changes = {"colorspace=\"linear\"", "alpha=\"luminance\"", "unpremultiply=false",
                           "filter=\"area\"", "meshes=[ { mesh = \"plane\", texture = \"other.ppm\" } ]"};
    for (const std::string& change : changes) {
        const Words set = {"--set", "layer.gas.source." + change};
        const Figures shared = figures(set);
        EXPECT_FALSE(shared.cached) << change;
        EXPECT_TRUE(shared.geometry_cached) << change;
        Words without = set;
        without.emplace_back("--no-cache");
        const Figures alone = figures(without);
        EXPECT_EQ(shared.sha256, alone.sha256) << change;
        EXPECT_FALSE(alone.geometry_cached) << change;
        EXPECT_TRUE(figures(set).cached) << change;
    }
    EXPECT_EQ(sets_in("sets").size(), 1u);
    EXPECT_EQ(texels_in("sets").size(), 1 + changes.size());
}

TEST_F(Cache, OnlyTheSourceMakesANewSet) {
    figures({});
    for (const char* change : {"layer.gas.look.alpha.power=3", "layer.gas.look.radius.max=0.4",
                               "layer.gas.render.blend=\"add\"", "layer.gas.transform.scale=2.0"})
        EXPECT_TRUE(figures({"--set", change}).cached) << change;
    EXPECT_FALSE(figures({"--set", "layer.gas.source.jitter=0.5"}).cached);
    std::string picture = small_picture();
    picture.back() ^= 1;
    write_text(folder / "picture.ppm", picture);
    const Figures repainted = figures({});
    EXPECT_FALSE(repainted.cached);
    EXPECT_TRUE(repainted.geometry_cached);
    EXPECT_EQ(sets_in("sets").size(), 2u);
    EXPECT_EQ(texels_in("sets").size(), 3u);
}

TEST_F(Cache, NoCacheNeitherReadsNorWrites) {
    EXPECT_FALSE(figures({"--no-cache"}).cached);
    EXPECT_FALSE(figures({"--no-cache", "--cache", "other"}).cached);
    EXPECT_FALSE(fs::exists(folder / "sets") || fs::exists(folder / "other"));
    figures({});
    EXPECT_FALSE(figures({"--no-cache"}).cached);
}

TEST_F(Cache, ADryRunMakesNoFolderButKnowsTheSet) {
    expect_success(batch({"--dry-run"}));
    EXPECT_FALSE(fs::exists(folder / "sets"));
    const Figures first = figures({});
    const std::string plan = batch({"--dry-run", "--overwrite"}).out;
    const std::string splats = human_count(double(first.kept));
    EXPECT_NE(plan.find("layer gas: about " + splats + " splats"), std::string::npos) << plan << splats;
}

TEST_F(Cache, OptionThenVariableThenHome) {
    RunOptions variable, xdg, home;
    const std::string here = folder.string();
    variable.environment = {"ASTROSPLAT_CACHE=" + here + "/v", "XDG_CACHE_HOME=" + here + "/x"};
    xdg.environment = {"ASTROSPLAT_CACHE=", "XDG_CACHE_HOME=" + here + "/x", "HOME=" + here + "/h"};
    home.environment = {"ASTROSPLAT_CACHE=", "XDG_CACHE_HOME=", "HOME=" + here + "/h"};
    figures({"--cache", "option"}, variable);
    EXPECT_EQ(sets_in("option").size(), 1u);
    EXPECT_FALSE(fs::exists(folder / "v"));
    figures({}, variable);
    EXPECT_EQ(sets_in("v").size(), 1u);
    EXPECT_FALSE(fs::exists(folder / "x"));
    figures({}, xdg);
    EXPECT_EQ(sets_in("x/astrosplat").size(), 1u);
    figures({}, home);
    EXPECT_EQ(sets_in("h/.cache/astrosplat").size(), 1u);
}

TEST_F(Cache, GenerateUsesItToo) {
    expect_success(run({"generate", "scene.toml", "--layer", "gas", "-o", "a.splats"}));
    EXPECT_TRUE(figures({}).cached);
    expect_success(run({"generate", "scene.toml", "--layer", "gas", "-o", "b.splats"}));
    EXPECT_EQ(text_of(folder / "a.splats"), text_of(folder / "b.splats"));
}

TEST_F(Cache, AFolderThatCannotBeWrittenIsAWarning) {
    write_text(folder / "file", "");
    const RunResult result = expect_success(batch({"--cache", "file/sets", "-q"}));
    EXPECT_HAS(result.err, "file/sets");
    EXPECT_TRUE(fs::exists(folder / "frames/shot.0001.exr"));
}

TEST_F(Cache, DamagedSetsAreGeneratedAgain) {
    const std::string sha256 = figures({}).sha256;
    for (const std::string& name : {sets_in("sets").at(0), texels_in("sets").at(0)}) {
        const fs::path set = folder / "sets" / name;
        std::string bytes = text_of(set);
        bytes[bytes.size() / 2] ^= 1;
        write_text(set, bytes);
        const Figures again = figures({});
        EXPECT_FALSE(again.cached);
        EXPECT_EQ(again.sha256, sha256);
        EXPECT_TRUE(figures({}).cached);
    }
}

TEST_F(Cache, OfManyProcessesOneGenerates) {
    std::vector<std::unique_ptr<RunningProgram>> programs;
    for (int i = 0; i < 4; ++i) {
        const std::string name = fmt::format("s{}", i);
        programs.emplace_back(new RunningProgram(
            started({"--batch", "scene.toml", "--cache", "sets", "-o", name + ".exr", "--stats",
                     name + ".json", "--set", "layer.gas.source.voxel_size=0.05"})));
    }
    int generated = 0;
    std::set<std::string> sha256;
    for (std::size_t i = 0; i < programs.size(); ++i) {
        expect_success(programs[i]->wait());
        const nlohmann::json stats = json(fmt::format("s{}.json", i));
        generated += !stats.at("layers").at(0).at("cached").get<bool>();
        sha256.insert(stats.at("frames").at(0).at("sha256").get<std::string>());
    }
    EXPECT_EQ(generated, 1);
    EXPECT_EQ(sha256.size(), 1u);
    EXPECT_EQ(names_in("sets").size(), 2u);
}

TEST_F(Cache, AnInterruptLeavesNothingThere) {
    const auto program = generating_run();
    program->signal(SIGINT);
    EXPECT_EQ(program->wait().code, 130);
    EXPECT_TRUE(names_in("sets").empty());
}

TEST_F(Cache, WhatAKilledRunLeftIsClearedByTheNext) {
    const auto program = generating_run();
    program->signal(SIGKILL);
    EXPECT_EQ(program->wait().code, -SIGKILL);
    EXPECT_FALSE(names_in("sets").empty());  // its locks, free again
    EXPECT_FALSE(figures({}).cached);
    EXPECT_EQ(names_in("sets"), (std::set<std::string>{sets_in("sets").at(0), texels_in("sets").at(0)}));
}

}  // namespace
}  // namespace astrosplat::test
