// Input files of every kind at the command line: capitals, pipes, files without a picture, truth in `info`.
#include <sys/stat.h>

#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class Inputs : public SceneTest {
  protected:
    nlohmann::json info(const std::string& file) const {
        const RunResult result = run({"info", file, "--json"});
        EXPECT_EQ(result.code, 0) << result.err;
        return result.code == 0 ? nlohmann::json::parse(result.out) : nlohmann::json{};
    }
};

TEST_F(Inputs, CapitalsInEndings) {
    write_text(folder / "x.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    fs::copy_file(folder / "scene.toml", folder / "y.TOML");
    fs::copy_file(folder / "stars.pda", folder / "z.PDA");
    EXPECT_EQ(info("x.OBJ").at("kind"), "mesh");
    EXPECT_EQ(info("y.TOML").at("kind"), "scene");
    EXPECT_EQ(info("z.PDA").at("kind"), "splats");
}

TEST_F(Inputs, InfoNamesOnlyWhatTheFileHolds) {
    write_text(folder / "points.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n0 0 0\n");
    EXPECT_EQ(info("points.ply").at("attributes"), nlohmann::json({"position"}));
    EXPECT_FALSE(info("points.ply").contains("alpha"));
    EXPECT_EQ(info("stars.pda").at("attributes"), nlohmann::json({"position", "color", "alpha", "radius"}));
    EXPECT_TRUE(info("stars.pda").contains("radius"));
}

TEST_F(Inputs, PipesAndDevicesAreRefusedAtOnce) {
    const std::string refused = "it is not a regular file";
    for (const char* name : {"pipe.png", "pipe.obj", "pipe.toml", "pipe.pda", "pipe.fits"}) {
        ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
        expect_one_line(run({"info", name}), 2, refused);
    }
    expect_one_line(run({"info", "/dev/zero"}), 2, refused);
    expect_one_line(run({"--batch", "pipe.toml"}), 2, refused);
    expect_one_line(run({"--batch", "/dev/zero"}), 2, refused);
    expect_one_line(run({"new", "pipe.png", "-o", "x.toml"}), 2, refused);
    expect_one_line(run({"compare", "pipe.png", "pipe.png"}), 2, refused);
    expect_one_line(run({"convert", "pipe.pda", "x.ply"}), 2, refused);
}

TEST_F(Inputs, AFileThatIsNoPictureMakesNoScene) {
    std::string fits;
    for (std::string card : {"SIMPLE  =                    T", "BITPIX  =                    8",
                             "NAXIS   =                    0", "END"}) {
        card.resize(80, ' ');
        fits += card;
    }
    fits.resize(2880, ' ');
    write_text(folder / "empty.fits", fits);
    write_text(folder / "x.null", "");
    expect_one_line(run({"new", "empty.fits", "-o", "x.toml"}), 2,
                    "expected an HDU with a picture, found none");
    expect_one_line(run({"new", "x.null", "-o", "x.toml"}), 2, "cannot be read as a picture");
    expect_one_line(run({"info", "x.null"}), 2, "cannot be read as a picture");
    expect_one_line(run({"compare", "x.null", "x.null"}), 2, "cannot be read as a picture");
    EXPECT_FALSE(fs::exists(folder / "x.toml"));
}

}  // namespace
}  // namespace astrosplat::test
