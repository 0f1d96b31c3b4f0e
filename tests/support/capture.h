// Small captures made by numbers drawn from hashes, and the files that hold them, built byte by byte.
#pragma once

#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/shared_maths.h"

namespace astrosplat::test {

/// One Gaussian as 3D Gaussian Splatting trains it.
struct Trained {
    glm::dvec3 position{0.0}, scale{1.0};     // standard deviations
    glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};  // x y z w
    double opacity = 1.0;
    std::array<glm::dvec3, 16> harmonics{};  // display values
};

inline double drawn(std::uint32_t i, std::uint32_t purpose) {
    return double(shared::as_uniform(shared::as_hash(77u, i, 3u, purpose)));
}

/// `count` Gaussians in a box of half width 3 around the origin, long and flat ones among them.
inline std::vector<Trained> capture(std::uint32_t count, int degree, double size = 0.25) {
    std::vector<Trained> all;
    for (std::uint32_t i = 0; i < count; ++i) {
        Trained g;
        for (int k = 0; k < 3; ++k) {
            const auto n = std::uint32_t(k);
            g.position[k] = 6.0 * drawn(i, n) - 3.0;
            g.scale[k] = size * std::exp(-3.0 * drawn(i, 10 + n));
        }
        for (int k = 0; k < 4; ++k) g.rotation[k] = drawn(i, 20 + std::uint32_t(k)) - 0.5;
        g.rotation = glm::normalize(g.rotation);
        g.opacity = 0.02 + 0.97 * drawn(i, 30);
        for (int j = 0; j < (degree + 1) * (degree + 1); ++j)
            for (int k = 0; k < 3; ++k)
                g.harmonics[std::size_t(j)][k] =
                    (drawn(i, std::uint32_t(40 + 3 * j + k)) - 0.5) * (j == 0 ? 3.0 : 0.5);
        all.push_back(g);
    }
    return all;
}

inline void put(std::string& bytes, double value) {
    const auto number = float(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// The PLY file of these, with normals as training writes them.
inline std::string ply_of(const std::vector<Trained>& all, int degree) {
    const int rest = (degree + 1) * (degree + 1) - 1;
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(all.size()) + "\n";
    const auto name = [&](const std::string& text) { bytes += "property float " + text + "\n"; };
    for (const char* text : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"}) name(text);
    for (int i = 0; i < 3 * rest; ++i) name("f_rest_" + std::to_string(i));
    for (const char* text : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
        name(text);
    bytes += "end_header\n";
    for (const Trained& g : all) {
        for (int k = 0; k < 3; ++k) put(bytes, g.position[k]);
        for (int k = 0; k < 3; ++k) put(bytes, 0.0);
        for (int k = 0; k < 3; ++k) put(bytes, g.harmonics[0][k]);
        for (int k = 0; k < 3; ++k)
            for (int j = 1; j <= rest; ++j) put(bytes, g.harmonics[std::size_t(j)][k]);
        put(bytes, std::log(g.opacity / (1.0 - g.opacity)));
        for (int k = 0; k < 3; ++k) put(bytes, std::log(g.scale[k]));
        for (const int k : {3, 0, 1, 2}) put(bytes, 2.5 * g.rotation[k]);  // of any length
    }
    return bytes;
}

inline std::string little_endian(std::size_t n) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += char(n >> 8 * i & 255);
    return bytes;
}

/// The glTF file of these; `node` is what the node that has them says besides its
/// mesh: R"(,"scale":[2,2,2])".
inline std::string glb_of(const std::vector<Trained>& all, int degree, const std::string& node = "",
                          const std::string& space = "srgb_rec709_display") {
    std::string data, views, accessors, attributes;
    int number = 0;
    const auto column = [&](const std::string& name, int components, const auto& value) {
        const std::string comma = number > 0 ? "," : "";
        const std::size_t begin = data.size();
        for (const Trained& g : all)
            for (int k = 0; k < components; ++k) put(data, value(g, k));
        views += comma + R"({"buffer":0,"byteOffset":)" + std::to_string(begin) + R"(,"byteLength":)" +
                 std::to_string(data.size() - begin) + "}";
        accessors += comma + R"({"bufferView":)" + std::to_string(number) +
                     R"(,"componentType":5126,"count":)" + std::to_string(all.size()) + R"(,"type":")" +
                     (components == 1 ? "SCALAR" : "VEC" + std::to_string(components)) + R"("})";
        attributes += comma + "\"" + name + "\":" + std::to_string(number++);
    };
    const std::string prefix = "KHR_gaussian_splatting:";
    column("POSITION", 3, [](const Trained& g, int k) { return g.position[k]; });
    column(prefix + "SCALE", 3, [](const Trained& g, int k) { return g.scale[k]; });
    column(prefix + "ROTATION", 4, [](const Trained& g, int k) { return g.rotation[k]; });
    column(prefix + "OPACITY", 1, [](const Trained& g, int) { return g.opacity; });
    for (int l = 0; l <= degree; ++l)
        for (int n = 0; n < 2 * l + 1; ++n)
            column(prefix + "SH_DEGREE_" + std::to_string(l) + "_COEF_" + std::to_string(n), 3,
                   [&](const Trained& g, int k) { return g.harmonics[std::size_t(l * l + n)][k]; });
    std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
                       node + R"(}],"meshes":[{"primitives":[{"mode":0,"attributes":{)" + attributes +
                       R"(},"extensions":{"KHR_gaussian_splatting":{"kernel":"ellipse","colorSpace":")" +
                       space + R"("}}}]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
                       R"(],"buffers":[{"byteLength":)" + std::to_string(data.size()) + "}]}";
    while (json.size() % 4) json += ' ';
    return "glTF" + little_endian(2) + little_endian(28 + json.size() + data.size()) +
           little_endian(json.size()) + "JSON" + json + little_endian(data.size()) + std::string("BIN\0", 4) +
           data;
}

/// The USD text of these; `stage` stands in the stage's metadata, `prim` before the lists. Words on their
/// own, comments and trailing commas as its writers and people leave them.
inline std::string usda_of(const std::vector<Trained>& all, int degree, const std::string& prim = "",
                           const std::string& stage = "") {
    const auto list = [&](const std::string& name, int components, int each, const auto& value) {
        std::string text = "    " + name + " = [ # by rows\n";
        for (const Trained& g : all)
            for (int j = 0; j < each; ++j) {
                text += components > 1 ? "        (" : "        ";
                for (int k = 0; k < components; ++k) {
                    char number[32];
                    std::snprintf(number, sizeof number, "%.9g", double(float(value(g, j, k))));
                    text += (k > 0 ? ", " : "") + std::string(number);
                }
                text += components > 1 ? "),\n" : ",\n";
            }
        return text + "    ]\n";
    };
    const int each = (degree + 1) * (degree + 1);
    return "#usda 1.0\n(\n" + stage + ")\ndef Xform \"World\"\n{\n" +
           "    def ParticleField3DGaussianSplat \"Splats\" (\n        kind = \"component\"\n    )\n    {\n" +
           prim +
           list("point3f[] positions", 3, 1, [](const Trained& g, int, int k) { return g.position[k]; }) +
           list("float3[] scales", 3, 1, [](const Trained& g, int, int k) { return g.scale[k]; }) +
           list("quatf[] orientations", 4, 1,
                [](const Trained& g, int, int k) { return 2.5 * g.rotation[(k + 3) % 4]; }) +
           list("float[] opacities", 1, 1, [](const Trained& g, int, int) { return g.opacity; }) +
           "    uniform int radiance:sphericalHarmonicsDegree = " + std::to_string(degree) + "\n" +
           list("float3[] radiance:sphericalHarmonicsCoefficients", 3, each,
                [](const Trained& g, int j, int k) { return g.harmonics[std::size_t(j)][k]; }) +
           "    }\n}\n";
}

}  // namespace astrosplat::test
