// export: files of splats and volumes as other readers find them.
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <numbers>
#include <sstream>

#include "scene_fixture.h"
#include "support/capture.h"
#include "support/read_vdb.h"

namespace astrosplat::test {
namespace {

// export: the two files as a reader of its own finds them, and what is refused.

float float_at(const std::string& bytes, std::size_t offset) {
    float value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

struct Row {
    double x, y, z, r, g, b, alpha, radius;
};

class Export : public SceneTest {
  protected:
    std::vector<Row> rows_of_pda(const std::string& file) const {
        std::istringstream text(text_of(folder / file));
        std::string line;
        while (std::getline(text, line) && line != "BEGIN DATA") continue;
        std::vector<Row> rows;
        for (Row r{}; text >> r.x >> r.y >> r.z >> r.r >> r.g >> r.b >> r.alpha >> r.radius;)
            rows.push_back(r);
        return rows;
    }
    Words arguments(const std::string& output) const {
        return {"export", "scene.toml", "--layer", "stars", "-o", output, "--progress", "none"};
    }
};

// sharpness 4.5: found by an independent search for the nearest gaussian of the splat's integral
constexpr double peak = 1.009324, sigma = 0.323295;

TEST_F(Export, PlyIsWhatReadersOfGaussiansExpect) {
    const RunResult result = expect_success(run(arguments("out model.ply")));
    EXPECT_EQ(result.out.find("out model.ply: 300 splats; 0.00 % of the light lost, 0 above 1"), 0u)
        << result.out;
    const std::string bytes = text_of(folder / "out model.ply");
    const std::size_t begin = bytes.find("end_header\n") + 11;
    std::string names;
    std::istringstream header(bytes.substr(0, begin));
    for (std::string line; std::getline(header, line);)
        if (line.rfind("property float ", 0) == 0) names += line.substr(15) + " ";
    EXPECT_EQ(names,
              "x y z nx ny nz f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3 ");
    EXPECT_HAS(bytes, "format binary_little_endian 1.0\nelement vertex 300\n");
    ASSERT_EQ(bytes.size() - begin, 300u * 17 * 4);
    const std::vector<Row> rows = rows_of_pda("stars.pda");
    ASSERT_EQ(rows.size(), 300u);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto value = [&](std::size_t column) {
            return double(float_at(bytes, begin + (i * 17 + column) * 4));
        };
        EXPECT_NEAR(value(0), rows[i].x, 1e-5);
        EXPECT_NEAR(value(2), rows[i].z, 1e-5);
        EXPECT_NEAR(std::exp(value(10)) / rows[i].radius,
                    sigma * std::sqrt(std::max(1.0, peak * rows[i].alpha)), 2e-4);
        EXPECT_EQ(value(10), value(12));
        EXPECT_EQ(value(13), 1.0);
        EXPECT_EQ(value(14), 0.0);
        EXPECT_GE(1.0 / (1.0 + std::exp(-value(9))),
                  std::min(1.0, peak * rows[i].alpha) - 1e-4);  // the fit raises
        for (const std::size_t k : {6, 7, 8}) {
            const double color = value(k) * 0.28209479177387814 + 0.5;
            EXPECT_GE(color, -1e-6);
            EXPECT_LE(color, 1.0 + 1e-6);
        }
    }
}

TEST_F(Export, GlbHoldsTheSplatsInLinearLight) {
    expect_success(run(arguments("model.glb")));
    const std::string bytes = text_of(folder / "model.glb");
    ASSERT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word_at(bytes, 4), 2u);
    EXPECT_EQ(word_at(bytes, 8), bytes.size());
    const std::size_t length = word_at(bytes, 12);
    EXPECT_EQ(length % 4, 0u);
    const nlohmann::json gltf = nlohmann::json::parse(bytes.substr(20, length));
    EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
    const std::size_t begin = 28 + length;
    EXPECT_EQ(word_at(bytes, 20 + length), bytes.size() - begin);
    EXPECT_EQ(gltf.at("extensionsUsed").at(0), "KHR_gaussian_splatting");
    const nlohmann::json& primitive = gltf.at("meshes").at(0).at("primitives").at(0);
    EXPECT_EQ(primitive.at("mode"), 0);
    const nlohmann::json& extension = primitive.at("extensions").at("KHR_gaussian_splatting");
    EXPECT_EQ(extension.at("kernel"), "ellipse");
    EXPECT_EQ(extension.at("colorSpace"), "lin_rec709_display");
    const std::size_t stride = gltf.at("bufferViews").at(0).at("byteStride");
    const auto value = [&](const std::string& name, std::size_t row, std::size_t k) {
        const nlohmann::json& accessor =
            gltf.at("accessors").at(primitive.at("attributes").at(name).get<int>());
        EXPECT_EQ(accessor.at("count"), 300);
        return double(
            float_at(bytes, begin + row * stride + accessor.at("byteOffset").get<std::size_t>() + k * 4));
    };
    const std::vector<Row> rows = rows_of_pda("stars.pda");
    double lowest = 1e9;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double alpha = peak * rows[i].alpha;
        EXPECT_NEAR(value("POSITION", i, 1), rows[i].y, 1e-5);
        lowest = std::min(lowest, value("POSITION", i, 0));
        EXPECT_NEAR(value("KHR_gaussian_splatting:OPACITY", i, 0), std::min(1.0, alpha), 2e-4);
        EXPECT_NEAR(value("KHR_gaussian_splatting:SCALE", i, 2),
                    rows[i].radius * sigma * std::sqrt(std::max(1.0, alpha)), 1e-4);
        EXPECT_EQ(value("KHR_gaussian_splatting:ROTATION", i, 3), 1.0);
        EXPECT_NEAR(value("KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", i, 0) * 0.28209479177387814 + 0.5,
                    rows[i].r, 1e-4);
        EXPECT_NEAR(value("COLOR_0", i, 2), rows[i].b, 1e-4);
    }
    const int position = primitive.at("attributes").at("POSITION");
    EXPECT_NEAR(gltf.at("accessors").at(position).at("min").at(0), lowest, 1e-6);
    expect_success(
        run({"export", "scene.toml", "-o", "display.glb", "--space", "display", "--progress", "none"}));
    EXPECT_HAS(text_of(folder / "display.glb"), "\"srgb_rec709_display\"");
}

TEST_F(Export, CapturesKeepTheirHarmonicsUntilTheyAreMerged) {
    const std::string bytes = ply_of(capture(40, 2), 2);
    write_text(folder / "capture.ply", bytes);
    write_text(folder / "capture.toml",
               "astrosplat = 1\ncamera.position = [2, 1, 9]\n[[layer]]\nname = \"capture\"\n"
               "source = { kind = \"splats\", file = \"capture.ply\" }\n"
               "render = { isolate = true, space = \"display\" }\n");
    const auto exported = [&](const std::string& count) {
        expect_success(run({"export", "capture.toml", "-o", "out.ply", "--count", count, "--overwrite",
                            "--progress", "none"}));
        return text_of(folder / "out.ply");
    };
    const std::string whole = exported("40"), merged = exported("10");
    EXPECT_EQ(merged.find("f_rest_0"), std::string::npos);
    EXPECT_HAS(whole, "property float f_rest_23\nproperty float opacity\n");
    const auto begin = [](const std::string& file) { return file.find("end_header\n") + 11; };
    constexpr std::size_t columns = 17 + 24;
    ASSERT_EQ(whole.size() - begin(whole), 40 * columns * 4);
    for (std::size_t i = 0; i < 40; ++i)
        for (std::size_t k = 6; k < 6 + 3 + 24; ++k) {
            const std::size_t at = (i * columns + k) * 4;
            EXPECT_NEAR(float_at(whole, begin(whole) + at), float_at(bytes, begin(bytes) + at), 1e-4);
        }
}

TEST_F(Export, CountIsABudgetOfAllLayers) {
    const RunResult result =
        expect_success(run({"export", "scene.toml", "-o", "few.glb", "--count", "50", "--progress", "none"}));
    const int splats = std::stoi(result.out.substr(std::string("few.glb: ").size()));
    EXPECT_LE(splats, 50);
    EXPECT_GE(splats, 25);
}

TEST_F(Export, RefusesWhatItCannotDo) {
    expect_one_line(run(arguments("model.obj")), 2, ".ply, .glb, .usda, .spz or .vdb");
    const auto with = [&](const std::string& option, const std::string& value) {
        Words words = arguments("model.ply");
        return run(joined(words, {option, value}));
    };
    expect_one_line(with("--count", "0"), 2, "--count");
    expect_one_line(with("--frame", "x"), 2, "--frame");
    expect_one_line(with("--space", "linear"), 2, "--space");
    expect_one_line(run({"export", "scene.toml", "--layer", "starz", "-o", "a.ply"}), 2, "did you mean");
    expect_one_line(run({"export", "none.toml", "-o", "a.ply"}), 2, "none.toml");
    EXPECT_FALSE(fs::exists(folder / "model.ply"));
    write_text(folder / "model.ply", "mine");
    expect_one_line(run(arguments("model.ply")), 2, "--overwrite");
    EXPECT_EQ(text_of(folder / "model.ply"), "mine");
    EXPECT_EQ(run(arguments("/proc/astrosplat/model.ply")).code, 4);
}

// export to .vdb: what OpenVDB itself reads, and what is refused.

class ExportVolume : public SceneTest {
  protected:
    RunResult export_to(const std::string& output, Words more = {}) const {
        return run(joined({"export", "scene.toml", "-o", output, "--progress", "none"}, more));
    }
    VdbFile exported(Words more = {}) const {
        more.push_back("--overwrite");
        expect_success(export_to("a model.vdb", more));
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

/// The sum of alpha times area over the splats of a .pda, area the integral of a gaussian splat of
/// sharpness 4.5, and that times red.
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
    // Faint, so that a splat hides its alpha times its area within a thousandth.
    const Words faint = {"--layer", "stars", "--voxel-size",
                         "0.08",    "--set", "layer.stars.render.opacity=0.01"};
    const auto [depth, red] = depth_and_red(text_of(folder / "stars.pda"));
    const VdbFile file = exported(faint);
    EXPECT_NEAR(sum_of(file.grids.at("density"))[0] / (0.01 * depth), 1.0, 3e-3);
    EXPECT_NEAR(sum_of(file.grids.at("emission"))[0] / (0.01 * red), 1.0, 3e-3);
    Words exposed = faint;
    exposed.insert(exposed.end(), {"--set", "output.exposure=2"});
    const VdbFile brighter = exported(exposed);
    EXPECT_NEAR(sum_of(brighter.grids.at("emission"))[0] / (0.04 * red), 1.0, 3e-3);
    EXPECT_NEAR(sum_of(brighter.grids.at("density"))[0] / (0.01 * depth), 1.0, 3e-3);
    EXPECT_EQ(brighter.words.at("exposure_stops"), "2");
}

TEST_F(ExportVolume, OfOneSplatStandsWhereTheLayerPutsIt) {
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
    EXPECT_HAS(result.out, "density is empty");
    EXPECT_HAS(result.out, "0.00 % of the light lost");
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

// Other people's programs read what export writes, show it, and write what we read: a validator of glTF,
// PlayCanvas' splat-transform, and PlayCanvas itself in Chromium. They come from npm: `npm install
// gltf-validator playcanvas @playcanvas/splat-transform` in a folder that ASTROSPLAT_NODE_FOLDER names.

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

// SPZ: splat-transform's of the same million splats is no more than 5 % smaller, it reads ours, and all the
// files that it packs show what its PLY shows.
TEST_F(ReadersNightly, SpzIsAsSmallAsTheirsAndTheirPackedFilesLookAlike) {
    if (is_absent("@playcanvas/splat-transform")) GTEST_SKIP() << skipped;
    write_text(folder / "large.ply", ply_of(capture(1000000, 0, 0.05), 0));
    write_text(folder / "large.toml",
               scene_of("large.ply", "render = { isolate = true, space = \"display\" }\n"));
    for (const std::string file : {"large.ply", "own.spz"})
        expect_success(run({"export", "large.toml", "-o", file, "--overwrite", "--progress", "none"}));
    expect_success(transform("large.ply", "theirs.spz"));
    const auto own = double(fs::file_size(folder / "own.spz")),
               theirs = double(fs::file_size(folder / "theirs.spz"));
    EXPECT_NEAR(own / theirs, 1.0, 0.05);

    write_text(folder / "capture.ply", ply_of(capture(500, 2), 2));
    write_text(folder / "capture.toml",
               scene_of("capture.ply", "render = { isolate = true, space = \"display\" }\n"));
    expect_success(run({"export", "capture.toml", "-o", "ours.spz", "--progress", "none"}));
    expect_success(transform("ours.spz", "ours.ply"));
    const auto shown = [&](const std::string& file) {
        const std::string picture = file + ".exr";
        expect_success(run({"--batch", "capture.toml", "--set", "layer.splats.source.file=" + file, "-o",
                            picture, "--progress", "none"}));
        return picture;
    };
    expect_success(run({"compare", shown("ours.spz"), shown("ours.ply"), "--max-difference", "0.002"}));
    for (const Words& arguments : std::initializer_list<Words>{
             {"v3.spz", "--spz-version", "3"}, {"v4.spz"}, {"a.compressed.ply"}, {"a.sog"}}) {
        SCOPED_TRACE(arguments[0]);
        expect_success(run_node(joined({(modules / "@playcanvas/splat-transform/bin/cli.mjs").string(), "-w",
                                        "-g", "cpu", "capture.ply", arguments[0]},
                                       Words(arguments.begin() + 1, arguments.end()))));
        expect_success(transform(arguments[0], "back.ply"));
        expect_success(run({"compare", shown(arguments[0]), shown("back.ply"), "--max-difference", "0.002"}));
        fs::remove(folder / "back.ply.exr");
    }
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
