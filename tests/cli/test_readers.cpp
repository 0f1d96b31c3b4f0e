// Other people's programs read what export writes, show it, and write what we read: a validator of glTF,
// PlayCanvas' splat-transform, and PlayCanvas itself in Chromium. They come from npm: `npm install
// gltf-validator playcanvas @playcanvas/splat-transform` in a folder that ASTROSPLAT_NODE_FOLDER names.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <sstream>
#include <utility>

#include "scene_fixture.h"
#include "support/capture.h"

namespace astrosplat::test {
namespace {

/// Prints the validator's errors but those about names that it does not know yet.
constexpr const char* validate = R"(const bytes = require("fs").readFileSync(process.argv[2]);
require("gltf-validator").validateBytes(new Uint8Array(bytes), { maxIssues: 0 }).then((report) => {
    const known = (m) => m.code === "MESH_PRIMITIVE_INVALID_ATTRIBUTE" && /KHR_gaussian_splatting:/.test(m.pointer);
    for (const m of report.issues.messages)
        if (m.severity < 2 && !known(m)) console.log(m.code, m.pointer, m.message);
    console.log("primitives", report.info.totalVertexCount, "vertices");
});
)";

/// A frame of 320 x 240 px of one layer of splats.
std::string scene_of(const std::string& file, const std::string& rest) {
    return "astrosplat = 1\noutput = { resolution = [320, 240], frames = \"1\", path = \"own.png\" }\n"
           "camera = { position = [2.0, 1.5, 9.0], target = [0.2, 0.1, 0.0], fov = 45.0 }\n"
           "[[layer]]\nname = \"splats\"\nsource = { kind = \"splats\", file = \"" +
           file + "\" }\n" + rest;
}

class ReadersNightly : public SceneTest {
  protected:
    ReadersNightly() {
        const char* const given = std::getenv("ASTROSPLAT_NODE_FOLDER");
        if (given) modules = fs::path(given) / "node_modules";
        for (const char* place : {"/usr/bin/node", "/usr/local/bin/node"})
            if (fs::exists(place)) node = place;
    }
    bool is_absent(const std::string& package) const {
        return node.empty() || !fs::exists(modules / package);
    }
    RunResult run_node(Words arguments) const {
        arguments.insert(arguments.begin(), node);
        return run_program(arguments, {folder, {"NODE_PATH=" + modules.string()}, {}});
    }
    RunResult transform(const std::string& from, const std::string& to) const {
        return run_node(
            {(modules / "@playcanvas/splat-transform/bin/cli.mjs").string(), "-w", "-g", "cpu", from, to});
    }
    std::vector<std::vector<double>> rows_of_csv(const std::string& file, Words& names) const {
        std::istringstream text(text_of(folder / file));
        std::vector<std::vector<double>> rows;
        for (std::string line; std::getline(text, line);) {
            std::istringstream cells(line);
            if (names.empty()) {
                for (std::string name; std::getline(cells, name, ',');) names.push_back(name);
                continue;
            }
            rows.emplace_back();
            for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
        }
        return rows;
    }

    std::string node;
    fs::path modules;
};

constexpr const char* skipped = "node with packages of npm is not there (ASTROSPLAT_NODE_FOLDER)";

TEST_F(ReadersNightly, GlbIsValid) {
    if (is_absent("gltf-validator")) GTEST_SKIP() << skipped;
    expect_success(run({"export", "scene.toml", "-o", "model.glb", "--progress", "none"}));
    write_text(folder / "validate.cjs", validate);
    const RunResult result = run_node({"validate.cjs", "model.glb"});
    EXPECT_EQ(result.out, "primitives 400 vertices\n") << result.err;
    write_text(folder / "capture.ply", ply_of(capture(50, 3), 3));
    write_text(folder / "capture.toml", scene_of("capture.ply", ""));
    expect_success(run({"export", "capture.toml", "-o", "capture.glb", "--progress", "none"}));
    EXPECT_EQ(run_node({"validate.cjs", "capture.glb"}).out, "primitives 50 vertices\n");
    write_text(folder / "broken.glb", text_of(folder / "model.glb").replace(12, 1, "\x01"));
    EXPECT_NE(run_node({"validate.cjs", "broken.glb"}).out, result.out);
}

TEST_F(ReadersNightly, PlyIsRead) {
    if (is_absent("@playcanvas/splat-transform")) GTEST_SKIP() << skipped;
    expect_success(
        run({"export", "scene.toml", "--layer", "stars", "-o", "model.ply", "--progress", "none"}));
    const RunResult read = expect_success(transform("model.ply", "read.csv"));
    Words names;
    const auto rows = rows_of_csv("read.csv", names);
    ASSERT_EQ(rows.size(), 300u);
    const std::string bytes = text_of(folder / "model.ply");
    const std::size_t begin = bytes.find("end_header\n") + 11;
    const Words own = {"x",       "y",      "z",      "nx",      "ny",      "nz",
                       "f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                       "scale_2", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
    int compared = 0;
    for (std::size_t column = 0; column < names.size(); ++column) {
        const auto found = std::find(own.begin(), own.end(), names[column]);
        if (found == own.end()) continue;
        ++compared;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            float value;
            std::memcpy(&value, bytes.data() + begin + 4 * (17 * i + std::size_t(found - own.begin())), 4);
            EXPECT_NEAR(rows[i][column], value, 1e-5 * std::max(1.0f, std::fabs(value))) << names[column];
        }
    }
    EXPECT_GE(compared, 14);
}

// A capture as another program writes it as glTF looks as it does as PLY.
TEST_F(ReadersNightly, GlbOfOthersIsReadAsTheirPly) {
    if (is_absent("@playcanvas/splat-transform")) GTEST_SKIP() << skipped;
    write_text(folder / "capture.ply", ply_of(capture(500, 3), 3));
    expect_success(transform("capture.ply", "capture.glb"));
    for (const std::string ending : {"ply", "glb"}) {
        write_text(folder / (ending + ".toml"), R"(astrosplat = 1
[output]
resolution = [120, 90]
frames = "1"
path = ")" + ending + R"(.exr"
[camera]
position = [1.0, 2.0, 7.0]
[[layer]]
name = "capture"
[layer.source]
kind = "splats"
file = "capture.)" + ending + R"("
[layer.transform]
rotate = [0.0, 0.0, )" + (ending == "ply" ? "180.0" : "0.0") +
                                                    R"(]  # it turns y up, as glTF has it
[layer.render]
isolate = true
space = "display"
)");
        expect_success(run({"--batch", ending + ".toml", "--progress", "none"}));
    }
    expect_success(run({"compare", "ply.exr", "glb.exr", "--max-difference", "0.001"}));
}

/// The same view for a page.
constexpr const char* page_view =
    R"({"width":320,"height":240,"fov":45,"position":[2.0,1.5,9.0],"target":[0.2,0.1,0.0]})";

// A capture with its harmonics, and splats whose light was fitted to the view.
TEST_F(ReadersNightly, GlbLooksTheSameInAPageOfPlayCanvas) {
    std::string chromium;
    for (const char* place : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
        if (chromium.empty() && fs::exists(place)) chromium = place;
    if (is_absent("playcanvas") || chromium.empty())
        GTEST_SKIP() << "Chromium, or node with packages of npm, is not there (ASTROSPLAT_NODE_FOLDER)";
    write_text(folder / "capture.ply", ply_of(capture(200, 3), 3));
    write_text(folder / "capture.toml",
               scene_of("capture.ply", "render = { isolate = true, space = \"display\" }\n"));
    write_text(folder / "splats.toml", scene_of("stars.pda", ""));
    for (const auto& [scene, least_db] :
         std::initializer_list<std::pair<std::string, double>>{{"capture", 40.0}, {"splats", 28.0}}) {
        const std::string model = scene + ".glb", picture = scene + ".png";
        expect_success(
            run({"export", scene + ".toml", "-o", model, "--space", "display", "--progress", "none"}));
        expect_success(run({"--batch", scene + ".toml", "--overwrite", "--progress", "none"}));
        const std::string program = ASTROSPLAT_SOURCE_DIR "/tests/cli/playcanvas_page.cjs";
        expect_success(run_node({program, chromium, modules.string(), model, picture, page_view}));
        const RunResult compared = run({"compare", "own.png", picture});
        const std::size_t at = compared.out.find("psnr_db: ");
        ASSERT_NE(at, std::string::npos) << compared.out << compared.err;
        RecordProperty(scene, compared.out.substr(at + 9, 5));
        EXPECT_GE(std::stod(compared.out.substr(at + 9)), least_db) << scene;
    }
}

}  // namespace
}  // namespace astrosplat::test
