// Short names of looks and scenes: beside the scene, then the person's own, then those that come with the
// program.
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

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
        const RunResult result =
            run({"--batch", "named.toml", "--overwrite", "-q", "--stats", "s.json"}, own_data());
        EXPECT_EQ(result.code, 0) << result.err;
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
    EXPECT_NE(result.err.find("by name: m51, mine, s106"), std::string::npos) << result.err;
    write_scene_with("s106.tom");
    EXPECT_EQ(run({"--batch", "named.toml"}, own_data()).code, 2) << "an ending makes it a file";
}

TEST_F(Names, OfScenes) {
    const RunResult known = run({"--batch", "spiral", "--dry-run", "-f", "1", "-o", "a.exr"}, own_data());
    EXPECT_EQ(known.code, 0) << known.err;
    EXPECT_NE(known.out.find("scenes/spiral.toml"), std::string::npos) << known.out;
    EXPECT_EQ(run({"--batch", "scene", "--dry-run"}, own_data()).code, 0) << "beside";
    const RunResult unknown = run({"--batch", "spirale", "--dry-run"}, own_data());
    EXPECT_EQ(unknown.code, 2);
}

}  // namespace
}  // namespace astrosplat::test
