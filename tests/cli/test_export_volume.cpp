// export to .vdb: what OpenVDB itself reads, and what is refused.
#include <cmath>
#include <numbers>

#include "scene_fixture.h"
#include "support/read_vdb.h"

namespace astrosplat::test {
namespace {

class ExportVolume : public SceneTest {
  protected:
    RunResult export_to(const std::string& output, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"export", "scene.toml", "-o", output, "--progress", "none"});
        return run(more);
    }
    VdbFile exported(std::vector<std::string> more = {}) const {
        more.push_back("--overwrite");
        const RunResult result = export_to("a model.vdb", more);
        EXPECT_EQ(result.code, 0) << result.err;
        return read_vdb((folder / "a model.vdb").string());
    }
};

std::array<double, 3> sum_of(const VdbGrid& grid) {
    std::array<double, 3> sum{};
    for (const VdbGrid::Voxel& voxel : grid.voxels)
        for (std::size_t k = 0; k < 3; ++k) sum[k] += voxel.value[k];
    for (double& s : sum) s *= grid.step[0] * grid.step[1] * grid.step[2];
    return sum;
}

/// The sum of alpha times area over the dots of a .pda, area the integral of a gaussian dot of sharpness 4.5,
/// and that times red.
std::pair<double, double> depth_and_red(const std::string& pda) {
    const double end = std::exp(-4.5);  // shifted and scaled so that it ends at 0
    const double area = std::numbers::pi * ((1.0 - end) / 4.5 - end) / (1.0 - end);
    std::istringstream text(pda.substr(pda.find("BEGIN DATA\n") + 11));
    std::pair<double, double> sums;
    for (double x, y, z, r, g, b, alpha, radius; text >> x >> y >> z >> r >> g >> b >> alpha >> radius;) {
        sums.first += alpha * radius * radius * area;
        sums.second += r * alpha * radius * radius * area;
    }
    return sums;
}

TEST_F(ExportVolume, IsWhatVolumeRenderersExpect) {
    const VdbFile file = exported({"--voxel-size", "0.1", "--set", "provenance.title=A cube"});
    ASSERT_EQ(file.grids.size(), 3u);
    EXPECT_EQ(file.grids.at("density").type, "Tree_float_5_4_3");
    EXPECT_EQ(file.grids.at("density").grid_class, "fog volume");
    for (const char* name : {"emission", "Cd"})
        EXPECT_EQ(file.grids.at(name).type, "Tree_vec3s_5_4_3") << name;
    for (const auto& [name, grid] : file.grids) {
        EXPECT_GT(grid.voxels.size(), 1000u) << name;
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(grid.origin[k], 0.0) << name;
            EXPECT_NEAR(grid.step[k], 0.1, 1e-15) << name;
        }
    }
    EXPECT_EQ(file.words.at("title"), "A cube");
    EXPECT_EQ(file.words.at("frame"), "1");
    EXPECT_EQ(file.words.at("creator").rfind("astrosplat ", 0), 0u);
    EXPECT_EQ(file.words.count("credit"), 0u);  // there is none
}

TEST_F(ExportVolume, HoldsTheLayersLightAtTheFramesExposure) {
    // Faint, so that a dot hides its alpha times its area within a thousandth.
    const std::vector<std::string> faint = {"--layer", "stars", "--voxel-size",
                                            "0.08",    "--set", "layer.stars.render.opacity=0.01"};
    const auto [depth, red] = depth_and_red(text_of(folder / "stars.pda"));
    const VdbFile file = exported(faint);
    EXPECT_NEAR(sum_of(file.grids.at("density"))[0] / (0.01 * depth), 1.0, 3e-3);
    EXPECT_NEAR(sum_of(file.grids.at("emission"))[0] / (0.01 * red), 1.0, 3e-3);
    std::vector<std::string> exposed = faint;
    exposed.insert(exposed.end(), {"--set", "output.exposure=2"});
    const VdbFile brighter = exported(exposed);
    EXPECT_NEAR(sum_of(brighter.grids.at("emission"))[0] / (0.04 * red), 1.0, 3e-3);
    EXPECT_NEAR(sum_of(brighter.grids.at("density"))[0] / (0.01 * depth), 1.0, 3e-3);
    EXPECT_EQ(brighter.words.at("exposure_stops"), "2");
}

TEST_F(ExportVolume, OfOneDotStandsWhereTheLayerPutsIt) {
    write_text(
        folder / "stars.pda",
        "ATTRIBUTES\n position rgbPP opacityPP radiusPP\nTYPES\n V V R R\nNUMBER_OF_PARTICLES: 1\nBEGIN "
        "DATA\n1 2 3 1 0.5 0.25 0.5 0.5\n");
    const VdbFile file = exported(
        {"--layer", "stars", "--voxel-size", "0.1", "--set", "layer.stars.transform.translate=[10,0,0]",
         "--set", "layer.stars.transform.rotate=[0,0,90]", "--set", "layer.stars.transform.scale=2"});
    const VdbGrid& grid = file.grids.at("density");
    std::array<double, 3> middle{};
    double sum = 0.0;
    for (const VdbGrid::Voxel& voxel : grid.voxels) {
        sum += voxel.value[0];
        for (std::size_t k = 0; k < 3; ++k)
            middle[k] += double(voxel.value[k]) * voxel.index[k] * grid.step[k];
    }
    const std::array<double, 3> expected = {6.0, 2.0, 6.0};
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(middle[k] / sum, expected[k], 1e-3) << k;
    for (const VdbGrid::Voxel& voxel : file.grids.at("Cd").voxels) {
        ASSERT_NEAR(voxel.value[0], 1.0f, 1e-5f);
        ASSERT_NEAR(voxel.value[1], 0.5f, 1e-5f);
    }
}

TEST_F(ExportVolume, OfWhatAddsHasNoDensity) {
    const RunResult result = export_to("add.vdb", {"--layer", "dust", "--voxel-size", "0.2"});
    EXPECT_NE(result.out.find("density is empty"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("0.00 % of the light lost"), std::string::npos) << result.out;
    const VdbFile file = read_vdb((folder / "add.vdb").string());
    EXPECT_TRUE(file.grids.at("density").voxels.empty());
    const double red = depth_and_red(text_of(folder / "dust.pda")).second;
    EXPECT_NEAR(sum_of(file.grids.at("emission"))[0] / red, 1.0, 1e-3);
}

TEST_F(ExportVolume, HasTheSameBytesAgain) {
    exported({"--voxel-size", "0.1"});
    const std::string first = text_of(folder / "a model.vdb");
    exported({"--voxel-size", "0.1"});
    EXPECT_EQ(text_of(folder / "a model.vdb"), first);
}

TEST_F(ExportVolume, OddWishesAreRefusedInOneLine) {
    expect_one_line(export_to("a.vdb", {"--voxel-size", "0"}), 2, "--voxel-size: expected a number above 0");
    expect_one_line(export_to("a.vdb", {"--voxel-size", "nan"}), 2, "--voxel-size");
    expect_one_line(export_to("a.ply", {"--voxel-size", "0.1"}), 2, "a name ending in .vdb");
    expect_one_line(export_to("a.vdb", {"--space", "display"}), 2, "linear for .vdb");
    expect_one_line(export_to("a.vdb", {"--voxel-size", "1e-7"}), 2, "too small");
    expect_one_line(export_to("a.vdb", {"--set", "layer.stars.render.opacity=0", "--layer", "stars"}), 2,
                    "none");
    write_text(folder / "there.vdb", "mine");
    expect_one_line(export_to("there.vdb"), 2, "there.vdb");
    EXPECT_EQ(text_of(folder / "there.vdb"), "mine");
    EXPECT_FALSE(fs::exists(folder / "a.vdb"));
}

}  // namespace
}  // namespace astrosplat::test
