#include "camera_files/gltf_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "core/real.h"
#include "core/text.h"

namespace astrosplat {
namespace {

/// Times are floats: what lies within a thousandth of a whole frame is meant to lie on it.
double frame_of(double seconds, double fps) {
    const double frame = seconds * fps, whole = std::floor(frame + 0.5);
    return std::fabs(frame - whole) < 1e-3 ? whole : frame;
}

/// Turns go the short way round, at even speed (glTF 2.0, appendix C.3).
glm::dvec4 turned_between(const glm::dvec4& a, glm::dvec4 b, double t) {
    double cosine = glm::dot(a, b);
    if (cosine < 0.0) b = -b, cosine = -cosine;
    if (cosine > 1.0 - 1e-9) return glm::normalize(a + t * (b - a));
    const double angle = real::acos(cosine), sine = real::sin(angle);
    return (real::sin((1.0 - t) * angle) / sine) * a + (real::sin(t * angle) / sine) * b;
}

}  // namespace

GltfCurve gltf_curve(GltfFile& file, const nlohmann::json& sampler, int components, double fps) {
    GltfCurve curve;
    curve.components = components;
    const std::string between = sampler.value("interpolation", "LINEAR");
    if (between != "LINEAR" && between != "STEP" && between != "CUBICSPLINE")
        file.fail("LINEAR, STEP or CUBICSPLINE", "'" + printable(between) + "'");
    curve.between = between == "LINEAR" ? GltfCurve::Between::linear
                    : between == "STEP" ? GltfCurve::Between::step
                                        : GltfCurve::Between::cubic;
    curve.fps = fps;
    for (const float seconds : file.numbers(sampler.at("input"), 1))
        curve.frames.push_back(frame_of(double(seconds), fps));
    curve.values = file.numbers(sampler.at("output"), components);
    const std::size_t each = curve.between == GltfCurve::Between::cubic ? 3 : 1;
    if (curve.values.size() != curve.frames.size() * each * static_cast<std::size_t>(components))
        file.fail(fmt::format("{} values for {} times", curve.frames.size() * each, curve.frames.size()),
                  std::to_string(curve.values.size() / static_cast<std::size_t>(components)));
    if (std::adjacent_find(curve.frames.begin(), curve.frames.end(), std::greater_equal<>()) !=
        curve.frames.end())
        file.fail("times that ascend", "others");
    return curve;
}

glm::dvec4 value_of(const GltfCurve& curve, double frame) {
    const auto after = std::ranges::upper_bound(curve.frames, frame);
    const auto next = static_cast<std::size_t>(after - curve.frames.begin());
    const bool cubic = curve.between == GltfCurve::Between::cubic;
    /// Part 0 arrives, 1 is the value, 2 leaves.
    const auto value = [&](std::size_t key, std::size_t part) {
        glm::dvec4 v(0.0);
        const std::size_t at = (cubic ? 3 * key + part : key) * static_cast<std::size_t>(curve.components);
        for (int c = 0; c < curve.components; ++c)
            v[c] = double(curve.values[at + static_cast<std::size_t>(c)]);
        return v;
    };
    const bool turn = curve.components == 4;
    const auto unit = [&](const glm::dvec4& v) { return turn ? glm::normalize(v) : v; };
    if (next == 0) return unit(value(0, 1));
    if (next == curve.frames.size() || curve.between == GltfCurve::Between::step)
        return unit(value(next - 1, 1));
    const double from = curve.frames[next - 1], length = curve.frames[next] - from,
                 t = (frame - from) / length;
    const glm::dvec4 a = value(next - 1, 1), b = value(next, 1);
    if (!cubic) return turn ? turned_between(unit(a), unit(b), t) : a + t * (b - a);
    const glm::dvec4 leaving = length / curve.fps * value(next - 1, 2),
                     arriving = length / curve.fps * value(next, 0);
    const double t2 = t * t, t3 = t2 * t;
    return unit((2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * b +
                (t3 - t2) * arriving);
}

}  // namespace astrosplat
