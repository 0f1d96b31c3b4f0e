// fidelity: the report in both forms, and every refusal.
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

class FidelityCommand : public SceneTest {
  protected:
    FidelityCommand() {
        write_text(folder / "picture.ppm", small_picture());
        run({"new", "picture.ppm", "-o", "picture.toml"});
    }
    RunResult fidelity(std::vector<std::string> more) const {
        more.insert(more.begin(), {"fidelity", "picture.toml", "--set", "layer.picture.source.count=20000"});
        return run(more);
    }
};

TEST_F(FidelityCommand, WritesNumbersThatReadBack) {
    const RunResult result = fidelity({"-o", "report.json"});
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json report = json("report.json");
    EXPECT_EQ(report.at("scene"), "picture.toml");
    EXPECT_EQ(report.at("layer"), "picture");
    EXPECT_EQ(report.at("front").at("width_px"), 1280);
    EXPECT_EQ(report.at("front").at("height_px"), 640);
    EXPECT_EQ(report.at("full_size").at("width_px"), 32);
    EXPECT_GT(report.at("front").at("psnr_db").get<double>(), 15.0);
    EXPECT_LE(report.at("front").at("ssim").get<double>(), 1.0);
    EXPECT_NEAR(report.at("front").at("flux_ratio").at("green").get<double>(), 1.0, 0.2);
    EXPECT_EQ(report.at("front").at("flux_ratio").at("cells").size(), 32u * 32u);
    EXPECT_GT(report.at("front").at("power_ratio").size(), 5u);
    EXPECT_TRUE(report.at("side").contains("needles_share"));
    EXPECT_TRUE(report.at("edge").contains("fwhm_over_length"));
    // The terminal shows the same numbers, a line each.
    EXPECT_NE(result.out.find(fmt::format("{:.4f}", report.at("front").at("ssim").get<double>())),
              std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("from 60 degrees\n  needles"), std::string::npos) << result.out;
    EXPECT_EQ(last_line(result.out), "report.json");
    EXPECT_NE(result.err.find("of memory"), std::string::npos) << result.err;
}

TEST_F(FidelityCommand, ThePageHoldsAllThatItShows) {
    ASSERT_EQ(fidelity({"-o", "report.HTML", "-q"}).code, 0);
    const std::string page = text_of(folder / "report.HTML");
    EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
    std::size_t pictures = 0;
    for (std::size_t at = 0;
         (at = page.find("src='data:image/png;base64,iVBORw0KGgo", at)) != std::string::npos; ++at)
        ++pictures;
    EXPECT_EQ(pictures, 5u) << "rendered, picture, difference, two from the side";
    for (const char* part : {"PSNR", "CIEDE2000", "<svg class='cells'", "<svg class='power'", "</html>"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    for (const char* elsewhere : {"http:", "https:", "src='/", "url(", "@import"})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << elsewhere;
}

TEST_F(FidelityCommand, RefusesWhatItShould) {
    expect_one_line(fidelity({"-o", "report.pdf"}), 2, "a name ending in .html or .json, found '.pdf'");
    expect_one_line(run({"fidelity", "missing.toml", "-o", "a.json"}), 2, "missing.toml");
    expect_one_line(run({"fidelity", "scene.toml", "-o", "a.json", "--progress", "none"}), 2,
                    "a layer of kind \"mesh\"");
    const std::vector<std::string> quiet = {"--progress", "none", "-o", "a.json"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), quiet.begin(), quiet.end());
        return fidelity(more);
    };
    expect_one_line(with({"--reference", "none.png"}), 2, "none.png");
    expect_one_line(with({"--reference", "stars.pda"}), 2, "stars.pda");
    expect_one_line(with({"--set", "layer.picture.source.cuont=1"}), 2, "cuont");
    write_text(folder / "square.ppm", "P6\n16 16\n255\n" + std::string(16 * 16 * 3, 'x'));
    expect_one_line(with({"--reference", "square.ppm"}), 2, "proportions");
    EXPECT_FALSE(fs::exists(folder / "a.json"));
    write_text(folder / "a.json", "mine");
    expect_one_line(with({}), 2, "--overwrite");
    EXPECT_EQ(text_of(folder / "a.json"), "mine");
    EXPECT_EQ(with({"--overwrite"}).code, 0);
    EXPECT_EQ(json("a.json").at("layer"), "picture");
    EXPECT_EQ(fidelity({"-o", "/proc/astrosplat/a.json"}).code, 4);
}

TEST_F(FidelityCommand, IsStoppedWithoutLeavingAnything) {
    const std::set<std::string> before = names_in(".");
    RunOptions options;
    options.folder = folder;
    const RunningProgram program(
        {ASTROSPLAT_PROGRAM, "fidelity", "picture.toml", "-o", "report.html", "--no-cache", "--progress",
         "plain", "--set", "layer.picture.source.count=30000000"},
        options);
    while (program.running() && program.err_so_far().find("positions") == std::string::npos) usleep(1000);
    program.signal(SIGINT);
    const RunResult result = program.wait();
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(names_in("."), before);
}

}  // namespace
}  // namespace astrosplat::test
