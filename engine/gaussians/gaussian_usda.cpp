// Each array is as many rows of text as there are Gaussians, or as their harmonics; they follow each other as
// rows of one long table.
#include "gaussians/gaussian_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <glm/common.hpp>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "splat_files/number_text.h"
#include "splat_files/ordered_writer.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

constexpr std::int64_t rows_written_at_once = 1 << 14;

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

std::int64_t harmonics_each(const Gaussians& g) { return (g.degree + 1) * (g.degree + 1); }

char* put_value(char* out, const Gaussians& g, int array, std::size_t i) {
    if (array == radiance && !g.harmonics.empty()) {
        const auto each = static_cast<std::size_t>(harmonics_each(g));
        const glm::vec3 c = g.harmonics[i / each].c[i % each];
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
                       harmonics_each(g));
}

char* put_row(char* out, const Gaussians& g, std::int64_t row) {
    const auto array = static_cast<int>(std::min<std::int64_t>(row / g.size(), radiance));
    const std::int64_t i = row - array * g.size(),
                       count = g.size() * (array == radiance ? harmonics_each(g) : 1);
    out = put_text(out, i == 0 ? beginnings[array] : ", ");
    if (i > 0 && i % 8 == 0) out = put_text(out, "\n        ");
    out = put_value(out, g, array, static_cast<std::size_t>(i));
    return i + 1 < count ? out : put_text(out, array_end(g, array));
}

/// Three standard deviations around all centres.
std::string extent_text(const Gaussians& g) {
    glm::vec3 lo(std::numeric_limits<float>::max()), hi(-lo);
    for (std::size_t i = 0; i < g.position.size(); ++i) {
        const glm::vec3& s = g.scale[i];
        const glm::vec3 reach(3.0f * glm::max(s.x, glm::max(s.y, s.z)));
        lo = glm::min(lo, g.position[i] - reach);
        hi = glm::max(hi, g.position[i] + reach);
    }
    return fmt::format("[({}, {}, {}), ({}, {}, {})]", lo.x, lo.y, lo.z, hi.x, hi.y, hi.z);
}

}  // namespace

void write_gaussian_usda(const WriteTarget& target, const Gaussians& gaussians, const Progress& progress) {
    assert(gaussians.size() > 0);
    const std::string header =
        "#usda 1.0\n(\n    defaultPrim = \"Splats\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
        "def ParticleField3DGaussianSplat \"Splats\"\n{\n    float3[] extent = " +
        extent_text(gaussians) +
        "\n    uniform token projectionModeHint = \"perspective\"\n"
        "    uniform token sortingModeHint = \"cameraDistance\"\n" +
        fmt::format("    uniform int radiance:sphericalHarmonicsDegree = {}\n", gaussians.degree);
    write_ordered(
        target, header, (radiance + harmonics_each(gaussians)) * gaussians.size(), rows_written_at_once,
        longest_row, progress,
        [&](std::int64_t begin, std::int64_t end, char* out) {
            for (std::int64_t row = begin; row < end; ++row) out = put_row(out, gaussians, row);
            return out;
        },
        [] { return std::string("}\n"); });
}

}  // namespace astrosplat
