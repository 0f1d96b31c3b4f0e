// fidelity: the report in both forms, and every refusal.
#include "scene_fixture.h"

namespace astrosplat::test {
namespace {

// The bytes of the first picture of a page.
std::string first_picture(const std::string& page) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::string start = "data:image/png;base64,";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (std::size_t at = page.find(start) + start.size(); letters.find(page[at]) != std::string::npos;
         ++at) {
        bits = bits << 6 | std::uint32_t(letters.find(page[at]));
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += char(bits >> count & 255u);
    }
    return bytes;
}

class FidelityCommand : public SceneTest {
  protected:
    FidelityCommand() {
        write_text(folder / "picture.ppm", small_picture());
        run({"new", "picture.ppm", "-o", "picture.toml"});
    }
    RunResult fidelity(Words more) const {
        return run(joined({"fidelity", "picture.toml", "--set", "layer.picture.source.count=20000"}, more));
    }
};

TEST_F(FidelityCommand, WritesNumbersThatReadBack) {
    const RunResult result = expect_success(fidelity({"-o", "report.json"}));
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
    EXPECT_TRUE(report.at("side").contains("flat_picture_needles_share"));
    EXPECT_TRUE(report.at("edge").contains("fwhm_over_length"));
    EXPECT_TRUE(report.at("tilted").contains("mottle"));
    // The terminal shows the same numbers, a line each.
    EXPECT_HAS(result.out, fmt::format("{:.4f}", report.at("front").at("ssim").get<double>()));
    EXPECT_HAS(result.out, "from 60 degrees\n  needles");
    EXPECT_EQ(last_line(result.out), "report.json");
    EXPECT_HAS(result.err, "of memory");
}

TEST_F(FidelityCommand, JudgesDisksAloneAsDisks) {
    const auto judged = [&](const char* kind) {
        return fidelity({"-o", std::string(kind) + ".json", "--set",
                         std::string("layer.picture.source.structure.kind=") + kind})
            .out;
    };
    const std::string disk = judged("disk"), sheet = judged("sheet");
    EXPECT_HAS(disk, "0.06 to 0.10");
    EXPECT_HAS(disk, "at least 2.5");
    EXPECT_HAS(disk, "roundness");
    EXPECT_EQ(sheet.find("roundness"), std::string::npos) << sheet;
    EXPECT_EQ(sheet.find("0.06 to 0.10"), std::string::npos) << sheet;
    EXPECT_EQ(sheet.find("at least 2.5"), std::string::npos) << sheet;
    EXPECT_HAS(sheet, "centre over half radius");
}

TEST_F(FidelityCommand, ThePageHoldsAllThatItShows) {
    expect_success(fidelity({"-o", "report.HTML", "-q"}));
    const std::string page = text_of(folder / "report.HTML");
    EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
    std::size_t pictures = 0;
    for (std::size_t at = 0;
         (at = page.find("src='data:image/png;base64,iVBORw0KGgo", at)) != std::string::npos; ++at)
        ++pictures;
    EXPECT_EQ(pictures, 5u) << "rendered, picture, difference, two from the side";
    write_text(folder / "first.png", first_picture(page));
    const RunResult described = expect_success(run({"info", "first.png"}));
    EXPECT_HAS(described.out, "1280");
    for (const char* part : {"PSNR", "CIEDE2000", "<svg class='cells'", "<svg class='power'", "</html>"})
        EXPECT_HAS(page, part);
    for (const char* elsewhere : {"http:", "https:", "src='/", "url(", "@import"})
        EXPECT_EQ(page.find(elsewhere), std::string::npos) << elsewhere;
}

TEST_F(FidelityCommand, SaysThatThePictureIsOneLayersAlone) {
    const std::string part = "2 layers are seen, and compared with the picture of 'picture' alone";
    EXPECT_EQ(fidelity({"-o", "one.json"}).err.find(part), std::string::npos);
    write_text(folder / "picture.toml", text_of(folder / "picture.toml") + R"(
[[layer]]
name = "stars"
[layer.source]
kind = "splats"
file = "stars.pda"
)");
    const RunResult two = fidelity({"-o", "two.json"});
    EXPECT_HAS(two.err, part);
    EXPECT_NE(json("one.json").at("full_size"), json("two.json").at("full_size"));
    const RunResult named = fidelity({"-o", "named.json", "--reference", "picture.ppm"});
    EXPECT_EQ(named.err.find(part), std::string::npos) << named.err;
    EXPECT_EQ(json("named.json").at("reference"), "picture.ppm");
}

TEST_F(FidelityCommand, RefusesWhatItShould) {
    expect_one_line(fidelity({"-o", "report.pdf"}), 2, "a name ending in .html or .json, found '.pdf'");
    expect_one_line(run({"fidelity", "missing.toml", "-o", "a.json"}), 2, "missing.toml");
    expect_one_line(run({"fidelity", "scene.toml", "-o", "a.json", "--progress", "none"}), 2,
                    "a layer of kind \"mesh\"");
    const Words quiet = {"--progress", "none", "-o", "a.json"};
    const auto with = [&](Words more) {
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
    expect_success(with({"--overwrite"}));
    EXPECT_EQ(json("a.json").at("layer"), "picture");
    EXPECT_EQ(fidelity({"-o", "/proc/astrosplat/a.json"}).code, 4);
}

TEST_F(FidelityCommand, IsStoppedWithoutLeavingAnything) {
    const std::set<std::string> before = names_in(".");
    const RunningProgram program(
        {ASTROSPLAT_PROGRAM, "fidelity", "picture.toml", "-o", "report.html", "--no-cache", "--progress",
         "plain", "--set", "layer.picture.source.structure.kind=columns", "--set",
         "layer.picture.source.count=30000000"},
        {.folder = folder});
    program.wait_until_said("positions");
    program.signal(SIGINT);
    const RunResult result = program.wait();
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(names_in("."), before);
}

}  // namespace
}  // namespace astrosplat::test
