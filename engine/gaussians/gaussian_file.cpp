// PLY and glTF: one row of floats a Gaussian, which glTF calls interleaved. USD: each array is as many rows
// of text as there are Gaussians, or as their harmonics; they follow each other as rows of one long table.
#include "gaussians/gaussian_file.h"

#include <fmt/format.h>

#include <cstring>
#include <glm/common.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "core/bounds.h"
#include "core/color.h"
#include "core/error.h"
#include "core/real.h"
#include "splat_files/file_bytes.h"
#include "splat_files/number_text.h"
#include "splat_files/ply_bytes.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::int64_t rows_written_at_once = 1 << 14;
constexpr double least_scale = 1e-30;            // scene units, of a Gaussian that is flat
constexpr int ply_floats = 17, glb_floats = 18;  // without harmonics beyond degree 0

/// Harmonics beyond degree 0, each of three numbers.
int rest_of(const Gaussians& g) { return int(g.harmonics_each()) - 1; }

glm::vec3 first_harmonic(const Gaussians& g, std::size_t i) {
    return g.degree > 0 ? g.harmonics[i].c[0] : mean_coefficient(g.color[i]);
}

char* put(char* out, std::initializer_list<float> values) {
    std::memcpy(out, values.begin(), values.size() * sizeof(float));
    return out + values.size() * sizeof(float);
}

char* put_ply_row(char* out, const Gaussians& g, std::size_t i) {
    constexpr double most = 1.0 - 1e-6;  // whose logit is 13.8: 1 has none
    const double alpha = std::clamp(double(g.alpha[i]), 1e-9, most);
    const auto logit = float(real::log(alpha / (1.0 - alpha)));
    glm::vec3 scale;
    for (int k = 0; k < 3; ++k) scale[k] = float(real::log(std::max(double(g.scale[i][k]), least_scale)));
    const glm::vec3 p = g.position[i], sh = first_harmonic(g, i);
    const glm::vec4 q = g.rotation[i];
    out = put(out, {p.x, p.y, p.z, 0.0f, 0.0f, 0.0f, sh.x, sh.y, sh.z});
    for (int k = 0; k < 3; ++k)  // all of red first
        for (int j = 1; j <= rest_of(g); ++j) out = put(out, {g.harmonics[i].c[j][k]});
    return put(out, {logit, scale.x, scale.y, scale.z, q.w, q.x, q.y, q.z});
}

char* put_glb_row(char* out, const Gaussians& g, bool encoded, std::size_t i) {
    const glm::vec3 p = g.position[i], sh = first_harmonic(g, i), s = g.scale[i];
    const glm::vec4 q = g.rotation[i];
    glm::vec3 c = glm::min(g.color[i], glm::vec3(1.0f));
    if (encoded)
        for (int k = 0; k < 3; ++k) c[k] = float(real::srgb_to_linear(c[k]));
    const float a = g.alpha[i];
    out = put(out, {p.x, p.y, p.z, q.x, q.y, q.z, q.w, s.x, s.y, s.z, a, sh.x, sh.y, sh.z});
    for (int j = 1; j <= rest_of(g); ++j) {
        const glm::vec3& rest = g.harmonics[i].c[j];
        out = put(out, {rest.x, rest.y, rest.z});
    }
    return put(out, {c.x, c.y, c.z, a});
}

std::string number_bytes(std::uint32_t value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// POSITION must say its bounds.
std::string bounds_text(const Gaussians& g) {
    Bounds box;
    for (const glm::vec3& p : g.position) box.add(glm::dvec3(p));
    const glm::vec3 lo(box.lo), hi(box.hi);
    return fmt::format(R"("min":[{},{},{}],"max":[{},{},{}])", lo.x, lo.y, lo.z, hi.x, hi.y, hi.z);
}

struct GlbAttribute {
    std::string name;
    int floats;
};
std::vector<GlbAttribute> glb_attributes(int degree) {
    const std::string prefix = "KHR_gaussian_splatting:";
    std::vector<GlbAttribute> attributes{
        {"POSITION", 3}, {prefix + "ROTATION", 4}, {prefix + "SCALE", 3}, {prefix + "OPACITY", 1}};
    for (int l = 0; l <= degree; ++l)
        for (int n = 0; n < 2 * l + 1; ++n)
            attributes.push_back({fmt::format("{}SH_DEGREE_{}_COEF_{}", prefix, l, n), 3});
    attributes.push_back({"COLOR_0", 4});
    return attributes;
}

// 63 are the most that glTF allows.
int glb_floats_of(const Gaussians& g) { return glb_floats + 3 * rest_of(g); }

// As JSON and USD write it alike: only quotes, backslashes and control characters are escaped.
std::string quoted_text(const std::string& words) {
    return nlohmann::json(words).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string glb_asset(const Gaussians& g) {
    std::string text = R"({"version":"2.0","generator":"astrosplat")";
    if (!g.credit.empty()) text += R"(,"copyright":)" + quoted_text(g.credit);
    if (!g.origin.empty()) text += R"(,"extras":{"origin":)" + quoted_text(g.origin) + "}";
    return text + "}";
}

std::string glb_json(const Gaussians& g, bool encoded, std::int64_t bytes) {
    std::string names, accessors;
    int number = 0, offset = 0;
    for (const GlbAttribute& attribute : glb_attributes(g.degree)) {
        const std::string comma = number ? "," : "";
        const std::string type = attribute.floats == 1 ? "SCALAR" : fmt::format("VEC{}", attribute.floats);
        names += fmt::format(R"({}"{}":{})", comma, attribute.name, number);
        accessors += fmt::format(
            R"({}{{"bufferView":0,"byteOffset":{},"componentType":5126,"count":{},"type":"{}"{}}})", comma,
            offset, g.size(), type, number ? "" : "," + bounds_text(g));
        offset += attribute.floats * 4;
        ++number;
    }
    std::string json = fmt::format(
        R"({{"asset":{},"extensionsUsed":["KHR_gaussian_splatting"],)"
        R"("scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"mode":0,)"
        R"("attributes":{{{}}},"extensions":{{"KHR_gaussian_splatting":{{"kernel":"ellipse",)"
        R"("colorSpace":"{}","projection":"perspective","sortingMethod":"cameraDistance"}}}}}}]}}],)"
        R"("accessors":[{}],"bufferViews":[{{"buffer":0,"byteLength":{},"byteStride":{},"target":34962}}],)"
        R"("buffers":[{{"byteLength":{}}}]}})",
        glb_asset(g), names, encoded ? "srgb_rec709_display" : "lin_rec709_display", accessors, bytes,
        glb_floats_of(g) * 4, bytes);
    json.append((4 - json.size() % 4) % 4, ' ');
    return json;
}

}  // namespace

void write_gaussian_ply(const WriteTarget& target, const Gaussians& gaussians, const Progress& progress) {
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    header += ply_comments(gaussians.credit, gaussians.origin);
    header += fmt::format("element vertex {}\n", gaussians.size());
    const auto name = [&](const std::string& text) { header += fmt::format("property float {}\n", text); };
    for (const char* text : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"}) name(text);
    for (int i = 0; i < 3 * rest_of(gaussians); ++i) name(fmt::format("f_rest_{}", i));
    for (const char* text : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
        name(text);
    const std::size_t row_bytes = (ply_floats + 3 * rest_of(gaussians)) * sizeof(float);
    write_rows(target, header + "end_header\n", gaussians.size(), rows_written_at_once, row_bytes, progress,
               [&](char* out, std::int64_t i) { return put_ply_row(out, gaussians, i); });
}

void write_gaussian_glb(const WriteTarget& target, const Gaussians& gaussians, bool encoded,
                        const Progress& progress) {
    const int floats = glb_floats_of(gaussians);
    const std::int64_t bytes = gaussians.size() * floats * 4;
    const std::string json = glb_json(gaussians, encoded, bytes);
    const std::int64_t all = 28 + std::int64_t(json.size()) + bytes;
    if (all > std::numeric_limits<std::uint32_t>::max())
        bad_input(target.file,
                  fmt::format("at most 4 GiB, some {} million splats (see --count)", 1073 / floats),
                  fmt::format("{} splats", gaussians.size()));
    const std::string header = "glTF" + number_bytes(2) + number_bytes(std::uint32_t(all)) +
                               number_bytes(std::uint32_t(json.size())) + "JSON" + json +
                               number_bytes(std::uint32_t(bytes)) + std::string("BIN\0", 4);
    write_rows(target, header, gaussians.size(), rows_written_at_once, floats * sizeof(float), progress,
               [&](char* out, std::int64_t i) { return put_glb_row(out, gaussians, encoded, i); });
}

namespace {

enum Array { positions, orientations, scales, opacities, radiance, arrays };
constexpr std::string_view beginnings[arrays] = {
    "    point3f[] positions = [",
    "    quatf[] orientations = [",
    "    float3[] scales = [",
    "    float[] opacities = [",
    "    float3[] radiance:sphericalHarmonicsCoefficients = [",
};
constexpr std::size_t longest_row = 4 * (float_text_room + 2) + 256;  // with what begins or ends an array

char* put_text(char* out, std::string_view text) {
    std::memcpy(out, text.data(), text.size());
    return out + text.size();
}

char* put_numbers(char* out, std::initializer_list<float> numbers) {
    *out++ = '(';
    for (const float& number : numbers) {
        if (&number != numbers.begin()) out = put_text(out, ", ");
        out = put_float(out, number);
    }
    *out++ = ')';
    return out;
}

char* put_value(char* out, const Gaussians& g, int array, std::size_t i) {
    if (array == radiance && !g.harmonics.empty()) {
        const glm::vec3 c = g.harmonics[i / g.harmonics_each()].c[i % g.harmonics_each()];
        return put_numbers(out, {c.x, c.y, c.z});
    }
    const glm::vec3 p = g.position[i], s = g.scale[i], c = mean_coefficient(g.color[i]);
    const glm::vec4 q = g.rotation[i];
    if (array == positions) return put_numbers(out, {p.x, p.y, p.z});
    if (array == orientations) return put_numbers(out, {q.w, q.x, q.y, q.z});
    if (array == scales) return put_numbers(out, {s.x, s.y, s.z});
    if (array == opacities) return put_float(out, g.alpha[i]);
    return put_numbers(out, {c.x, c.y, c.z});
}

std::string array_end(const Gaussians& g, int array) {
    if (array != radiance) return "]\n";
    return fmt::format("] (\n        elementSize = {}\n        interpolation = \"vertex\"\n    )\n",
                       g.harmonics_each());
}

char* put_row(char* out, const Gaussians& g, std::int64_t row) {
    const auto array = int(std::min<std::int64_t>(row / g.size(), radiance));
    const std::int64_t i = row - array * g.size(),
                       count = g.size() * (array == radiance ? rest_of(g) + 1 : 1);
    out = put_text(out, i == 0 ? beginnings[array] : ", ");
    if (i > 0 && i % 8 == 0) out = put_text(out, "\n        ");
    out = put_value(out, g, array, std::size_t(i));
    return i + 1 < count ? out : put_text(out, array_end(g, array));
}

std::string usd_words(const Gaussians& g) {
    std::string text;
    if (!g.credit.empty()) text += "        string credit = " + quoted_text(g.credit) + "\n";
    if (!g.origin.empty()) text += "        string origin = " + quoted_text(g.origin) + "\n";
    return text.empty() ? text : "    customLayerData = {\n" + text + "    }\n";
}

/// Three standard deviations around all centres.
std::string extent_text(const Gaussians& g) {
    Bounds box;
    for (std::size_t i = 0; i < g.position.size(); ++i) {
        const float reach = 3.0f * std::max({g.scale[i].x, g.scale[i].y, g.scale[i].z});
        box.add(glm::dvec3(g.position[i] - reach));
        box.add(glm::dvec3(g.position[i] + reach));
    }
    const glm::vec3 lo(box.lo), hi(box.hi);
    return fmt::format("[({}, {}, {}), ({}, {}, {})]", lo.x, lo.y, lo.z, hi.x, hi.y, hi.z);
}

}  // namespace

void write_gaussian_usda(const WriteTarget& target, const Gaussians& gaussians, const Progress& progress) {
    assert(gaussians.size() > 0);
    const std::string header =
        "#usda 1.0\n(\n" + usd_words(gaussians) +
        "    defaultPrim = \"Splats\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
        "def ParticleField3DGaussianSplat \"Splats\"\n{\n    float3[] extent = " +
        extent_text(gaussians) +
        "\n    uniform token projectionModeHint = \"perspective\"\n"
        "    uniform token sortingModeHint = \"cameraDistance\"\n" +
        fmt::format("    uniform int radiance:sphericalHarmonicsDegree = {}\n", gaussians.degree);
    write_rows(
        target, header, (radiance + 1 + rest_of(gaussians)) * gaussians.size(), rows_written_at_once,
        longest_row, progress, [&](char* out, std::int64_t row) { return put_row(out, gaussians, row); },
        [] { return std::string("}\n"); });
}

}  // namespace astrosplat
