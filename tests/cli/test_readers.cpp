// Other people's programs read what export writes, and write what we read: a validator of glTF, and
// PlayCanvas' splat-transform. They come from npm: `npm install gltf-validator @playcanvas/splat-transform`
// in a folder that ASTROSPLAT_NODE_FOLDER names.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

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
    RunResult run_node(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), node);
        return run_program(arguments, {folder, {"NODE_PATH=" + modules.string()}, {}});
    }
    RunResult transform(const std::string& from, const std::string& to) const {
        return run_node(
            {(modules / "@playcanvas/splat-transform/bin/cli.mjs").string(), "-w", "-g", "cpu", from, to});
    }
    std::vector<std::vector<double>> rows_of_csv(const std::string& file,
                                                 std::vector<std::string>& names) const {
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
    ASSERT_EQ(run({"export", "scene.toml", "-o", "model.glb", "--progress", "none"}).code, 0);
    write_text(folder / "validate.cjs", validate);
    const RunResult result = run_node({"validate.cjs", "model.glb"});
    EXPECT_EQ(result.out, "primitives 400 vertices\n") << result.err;
    write_text(folder / "broken.glb", text_of(folder / "model.glb").replace(12, 1, "\x01"));
    EXPECT_NE(run_node({"validate.cjs", "broken.glb"}).out, result.out);
}

TEST_F(ReadersNightly, PlyIsRead) {
    if (is_absent("@playcanvas/splat-transform")) GTEST_SKIP() << skipped;
    ASSERT_EQ(run({"export", "scene.toml", "--layer", "stars", "-o", "model.ply", "--progress", "none"}).code,
              0);
    const RunResult read = transform("model.ply", "read.csv");
    ASSERT_EQ(read.code, 0) << read.err << read.out;
    std::vector<std::string> names;
    const auto rows = rows_of_csv("read.csv", names);
    ASSERT_EQ(rows.size(), 300u);
    const std::string bytes = text_of(folder / "model.ply");
    const std::size_t begin = bytes.find("end_header\n") + 11;
    const std::vector<std::string> own = {"x",       "y",      "z",      "nx",      "ny",      "nz",
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
    const RunResult written = transform("capture.ply", "capture.glb");
    ASSERT_EQ(written.code, 0) << written.err << written.out;
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
        ASSERT_EQ(run({"--batch", ending + ".toml", "--progress", "none"}).code, 0);
    }
    const RunResult compared = run({"compare", "ply.exr", "glb.exr", "--max-difference", "0.001"});
    EXPECT_EQ(compared.code, 0) << compared.out << compared.err;
}

}  // namespace
}  // namespace astrosplat::test
