// Estimates before a run: of bodies from their pictures as they will be, of columns with the
// positions that are dropped at the end.
#include <cmath>
#include <map>
#include <sstream>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// A round cloud of 400x250 px that is speckled and fades to black: `reach` px from the middle there is
// nothing.
std::string cloud_picture(double reach) {
    constexpr int width = 400, height = 250;
    std::string text = fmt::format("P6\n{} {}\n255\n", width, height);
    std::uint32_t state = 7;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            state = state * 1664525u + 1013904223u;
            const double r = std::hypot(x - 0.5 * width, y - 0.5 * height) / reach;
            const double light = std::max(0.0, 1.0 - r) * (150.0 + static_cast<double>(state >> 26));
            for (const double share : {1.0, 0.8, 0.6}) text += static_cast<char>(std::lround(share * light));
        }
    }
    return text;
}

class Estimate : public SceneTest {
  protected:
    void write_source(const std::string& keys, double reach = 300.0) {
        write_text(folder / "cloud.ppm", cloud_picture(reach));
        write_text(folder / "scene.toml", R"(astrosplat = 1
[output]
resolution = [32, 20]
frames = "1"
path = "frames/shot.####.exr"
[[layer]]
name = "cloud"
[layer.source]
meshes = [ { mesh = "plane", texture = "cloud.ppm" } ]
)" + keys);
    }

    // Figures of a dry run: splats, and MiB.
    struct Told {
        double splats, mib;
    };
    Told told(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"--dry-run", "-q"});
        const RunResult result = batch(more);
        EXPECT_EQ(result.code, 0) << result.err;
        return {number_after(result.out, "about ", {{'k', 1e3}, {'M', 1e6}}),
                number_after(result.out, "memory about ", {{'M', 1.0}, {'G', 1024.0}})};
    }

    static double number_after(const std::string& text, const std::string& before,
                               const std::map<char, double>& units) {
        std::istringstream rest(text.substr(std::min(text.size(), text.find(before) + before.size())));
        double number = 0.0;
        char unit = 0;
        rest >> number >> unit;
        EXPECT_GT(number, 0.0) << text;
        return units.contains(unit) ? units.at(unit) * number : number;
    }

    std::int64_t made(std::vector<std::string> more = {}) const {
        more.insert(more.begin(),
                    {"generate", "scene.toml", "--layer", "cloud", "-o", "set.splats", "--overwrite", "-q"});
        EXPECT_EQ(run(more).code, 0);
        return nlohmann::json::parse(run({"info", "set.splats", "--json"}).out).at("splats");
    }
};

const std::string bodies = "structure = { kind = \"sheet\" }\n";

TEST_F(Estimate, BodiesOfAReducedPictureAreThoseThatWillBeMade) {
    write_source(bodies);
    const std::vector<std::string> little = {"--memory", "0.19"};
    const double whole = told().splats, reduced = told(little).splats;
    EXPECT_LT(reduced, 0.6 * whole);
    EXPECT_NEAR(reduced, static_cast<double>(made(little)), 0.1 * reduced);
    EXPECT_NEAR(whole, static_cast<double>(made()), 0.1 * whole);
}

TEST_F(Estimate, TheMemoryOfBodiesIsThatOfMakingThem) {
    write_source(bodies);
    const Told whole = told();
    EXPECT_GT(whole.mib, 140.0 + 400.0 * 250.0 * 120.0 / 1048576.0);
    write_source(bodies + "splats = 20000\n");
    const Told few = told();
    EXPECT_LE(few.splats, 20000.0);
    EXPECT_LT(few.mib, whole.mib - 10.0);
}

TEST_F(Estimate, ColumnsAskedForBySplatsHoldTransparentOnesWhileTheyAreMade) {
    const std::string keys = "splats = 1000000\n";
    write_source(keys);
    const Told lit = told();
    write_source(keys, 60.0);  // an eighth of the picture
    const Told dark = told();
    EXPECT_NEAR(dark.splats, lit.splats, 0.02 * lit.splats);
    EXPECT_GT(dark.mib, 2.0 * lit.mib);
}

TEST_F(Estimate, ARunWithLittleMemoryReducesThePictureOfBodiesAndSaysSoOnce) {
    write_source(bodies);
    const RunResult result = batch({"--memory", "0.19", "-q"});
    expect_one_line(result, 0, "a picture of 400x250 px is reduced to");
    EXPECT_EQ(names_in("frames"), std::set<std::string>{"shot.0001.exr"});
    EXPECT_LT(made({"--memory", "0.19"}), made() / 2);
}

// Of so few splats the sample is all: its frames are those that will be written.
TEST_F(Estimate, ADryRunTellsTimeAndTheSizeOfFiles) {
    write_scene();
    const RunResult result = batch({"--dry-run", "-q", "-f", "1-3", "--resolution", "320x240"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.out.find("sets are made"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("\ntime about "), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(" s a frame, "), std::string::npos) << result.out;
    EXPECT_EQ(names_in("frames"), std::set<std::string>{});
    const double told =
        number_after(result.out, "files about ", {{'K', 1024.0}, {'k', 1024.0}, {'M', 1048576.0}});
    ASSERT_EQ(batch({"-q", "-f", "1-3", "--resolution", "320x240"}).code, 0);
    double taken = 0.0;
    for (const std::string& name : names_in("frames"))
        taken += static_cast<double>(fs::file_size(folder / "frames" / name)) / 3.0;
    EXPECT_NEAR(told, taken, 0.1 * taken);
}

TEST_F(Estimate, SetsThatAreMissingAreMadeSmall) {
    write_source(bodies);
    const RunResult before = batch({"--dry-run", "-q"});
    EXPECT_NE(before.out.find("sets are made in about "), std::string::npos) << before.out;
    EXPECT_EQ(names_in("sets"), std::set<std::string>{});
    EXPECT_EQ(batch({"--sets-only", "-q"}).code, 0);
    const RunResult after = batch({"--dry-run", "-q"});
    EXPECT_EQ(after.out.find("sets are made"), std::string::npos) << after.out;
    EXPECT_NE(after.out.find("time about "), std::string::npos) << after.out;
}

TEST_F(Estimate, WithNothingToRenderThereIsNothingToTell) {
    write_scene();
    ASSERT_EQ(batch({"-q", "-f", "1"}).code, 0);
    const RunResult result = batch({"--dry-run", "-q", "-f", "1", "--resume"});
    EXPECT_NE(result.out.find("0 to render"), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("time about"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace astrosplat::test
