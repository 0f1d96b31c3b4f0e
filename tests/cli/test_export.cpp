// export: the two files as a reader of its own finds them, and what is refused.
#include <cmath>
#include <cstring>
#include <sstream>

#include "scene_fixture.h"
#include "support/capture.h"

namespace astrosplat::test {
namespace {

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
    std::vector<std::string> arguments(const std::string& output) const {
        return {"export", "scene.toml", "--layer", "stars", "-o", output, "--progress", "none"};
    }
};

// sharpness 4.5: found by an independent search for the nearest gaussian of the dot's integral
constexpr double peak = 1.009324, sigma = 0.323295;

TEST_F(Export, PlyIsWhatReadersOfGaussiansExpect) {
    const RunResult result = run(arguments("out model.ply"));
    ASSERT_EQ(result.code, 0) << result.err;
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
    EXPECT_NE(bytes.find("format binary_little_endian 1.0\nelement vertex 300\n"), std::string::npos);
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
    ASSERT_EQ(run(arguments("model.glb")).code, 0);
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
    ASSERT_EQ(
        run({"export", "scene.toml", "-o", "display.glb", "--space", "display", "--progress", "none"}).code,
        0);
    EXPECT_NE(text_of(folder / "display.glb").find("\"srgb_rec709_display\""), std::string::npos);
}

TEST_F(Export, CapturesKeepTheirHarmonicsUntilTheyAreMerged) {
    const std::string bytes = ply_of(capture(40, 2), 2);
    write_text(folder / "capture.ply", bytes);
    write_text(folder / "capture.toml",
               "astrosplat = 1\ncamera.position = [2, 1, 9]\n[[layer]]\nname = \"capture\"\n"
               "source = { kind = \"splats\", file = \"capture.ply\" }\n"
               "render = { isolate = true, space = \"display\" }\n");
    const auto exported = [&](const std::string& count) {
        EXPECT_EQ(run({"export", "capture.toml", "-o", "out.ply", "--count", count, "--overwrite",
                       "--progress", "none"})
                      .code,
                  0);
        return text_of(folder / "out.ply");
    };
    const std::string whole = exported("40"), merged = exported("10");
    EXPECT_EQ(merged.find("f_rest_0"), std::string::npos);
    EXPECT_NE(whole.find("property float f_rest_23\nproperty float opacity\n"), std::string::npos);
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
        run({"export", "scene.toml", "-o", "few.glb", "--count", "50", "--progress", "none"});
    ASSERT_EQ(result.code, 0) << result.err;
    const int splats = std::stoi(result.out.substr(std::string("few.glb: ").size()));
    EXPECT_LE(splats, 50);
    EXPECT_GE(splats, 25);
}

TEST_F(Export, RefusesWhatItCannotDo) {
    expect_one_line(run(arguments("model.obj")), 2, ".ply, .glb, .usda or .vdb");
    const auto with = [&](const std::string& option, const std::string& value) {
        std::vector<std::string> words = arguments("model.ply");
        words.insert(words.end(), {option, value});
        return run(words);
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

}  // namespace
}  // namespace astrosplat::test
