#include "usd/usda_stage.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/real.h"
#include "core/rotation.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr std::string_view op_prefix = "xformOp:", inverse_prefix = "!invert!", reset = "!resetXformStack!";

/// "translate" of "xformOp:translate:pivot".
std::string kind_of_op(std::string_view name) {
    name.remove_prefix(op_prefix.size());
    return std::string(name.substr(0, name.find(':')));
}

glm::dmat4 from_axes(const glm::dmat3& axes) {
    glm::dmat4 m(1.0);
    for (int c = 0; c < 3; ++c) m[c] = glm::dvec4(axes[c], 0.0);
    return m;
}

/// About the x, y or z axis.
glm::dmat4 turn(char axis, double degrees) {
    const double angle = real::radians(std::fmod(degrees, 360.0)), c = real::cos(angle), s = real::sin(angle);
    const int i = (axis - 'X' + 1) % 3, j = (axis - 'X' + 2) % 3;
    glm::dmat4 m(1.0);
    m[i][i] = c, m[i][j] = s, m[j][i] = -s, m[j][j] = c;
    return m;
}

bool is_order(std::string_view axes) {
    return axes.size() == 3 && axes.find_first_not_of("XYZ") == axes.npos;
}

/// USD's own matrices have rows where ours have columns, so that theirs reads in as ours.
glm::dmat4 op_matrix(const std::string& kind, const std::vector<double>& v) {
    glm::dmat4 m(1.0);
    if (kind == "translate") {
        m[3] = {v[0], v[1], v[2], 1.0};
    } else if (kind == "scale") {
        for (int i = 0; i < 3; ++i) m[i][i] = v[i];
    } else if (kind == "transform") {
        for (std::size_t i = 0; i < 16; ++i) m[int(i / 4)][int(i % 4)] = v[i];
    } else if (kind == "orient") {
        const glm::dvec4 q(v[1], v[2], v[3], v[0]);
        m = from_axes(matrix_of_quaternion(q / glm::length(q)));
    } else if (kind.size() == 7) {
        m = turn(kind[6], v[0]);
    } else {
        for (const char axis : kind.substr(6))  // the first acts first; the angles are of x, y and z
            m = turn(axis, v[axis - 'X']) * m;
    }
    return m;
}

std::size_t numbers_of_op(const std::string& kind) {
    if (kind == "translate" || kind == "scale") return 3;
    if (kind == "transform") return 16;
    if (kind == "orient") return 4;
    const std::string_view axes = std::string_view(kind).substr(std::min<std::size_t>(6, kind.size()));
    if (!kind.starts_with("rotate")) return 0;
    if (axes.size() == 1 && axes.find_first_of("XYZ") == 0) return 1;
    return is_order(axes) ? 3 : 0;
}

glm::dmat4 op_at(const UsdPrim& prim, const std::string& name, double time, const std::string& file) {
    const std::string kind = kind_of_op(name);
    const std::size_t wanted = numbers_of_op(kind);
    if (wanted == 0)
        bad_input(file, fmt::format("a transform operation of USD in '{}'", printable(prim.name)),
                  "'" + printable(name) + "'");
    const std::vector<double> numbers = numbers_at(prim, name, time, {});
    const bool zero = kind == "orient" && std::ranges::all_of(numbers, [](double x) { return x == 0.0; });
    if (numbers.size() != wanted || zero ||
        !std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
        bad_input(
            file,
            fmt::format("{} finite numbers as {} of '{}'", wanted, printable(name), printable(prim.name)),
            zero ? "zeros" : std::to_string(numbers.size()));
    return op_matrix(kind, numbers);
}

/// `resets`: what its parents do does not count.
glm::dmat4 parent_from_prim(const UsdPrim& prim, double time, const std::string& file, bool& resets) {
    glm::dmat4 m(1.0);
    resets = false;
    for (const std::string& word : prim.attribute("xformOpOrder").value.words) {
        if (word == reset) {
            resets = true;
            m = glm::dmat4(1.0);
            continue;
        }
        const bool inverted = word.starts_with(inverse_prefix);
        const std::string name = inverted ? word.substr(inverse_prefix.size()) : word;
        if (!name.starts_with(op_prefix))
            bad_input(file, fmt::format("a transform operation of USD in '{}'", printable(prim.name)),
                      "'" + printable(name) + "'");
        const glm::dmat4 op = op_at(prim, name, time, file);
        if (inverted && !(std::fabs(glm::determinant(op)) > 0.0))
            bad_input(file,
                      fmt::format("{} of '{}' that has an inverse", printable(name), printable(prim.name)),
                      "none");
        m = m * (inverted ? glm::inverse(op) : op);
    }
    return m;
}

}  // namespace

std::vector<double> numbers_at(const UsdPrim& prim, const std::string& name, double time,
                               std::vector<double> fallback) {
    const UsdAttribute& attribute = prim.attribute(name);
    const auto& samples = attribute.samples;
    if (samples.empty()) return attribute.has_value ? attribute.value.numbers : fallback;
    const auto next = std::ranges::upper_bound(samples, time, {}, &std::pair<double, UsdValue>::first);
    if (next == samples.begin()) return samples.front().second.numbers;
    const auto& [before, value] = *(next - 1);
    std::vector<double> numbers = value.numbers;
    if (next == samples.end() || next->second.numbers.size() != numbers.size()) return numbers;
    const double t = (time - before) / (next->first - before);
    const std::vector<double>& after = next->second.numbers;
    if (name.starts_with("xformOp:orient") && numbers.size() == 4) {
        const glm::dvec4 q(numbers[0], numbers[1], numbers[2], numbers[3]),
            p(after[0], after[1], after[2], after[3]);
        const glm::dvec4 turn = quaternion_between(glm::normalize(q), glm::normalize(p), t);
        return {turn[0], turn[1], turn[2], turn[3]};
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += t * (after[i] - numbers[i]);
    return numbers;
}

glm::dmat4 world_from_prim(std::span<const UsdPrim* const> prims, double time, const std::string& file) {
    glm::dmat4 m(1.0);
    for (const UsdPrim* const prim : prims) {
        bool resets = false;
        const glm::dmat4 own = parent_from_prim(*prim, time, file, resets);
        m = resets ? own : m * own;
    }
    return m;
}

void add_times(const UsdPrim& prim, std::set<double>& times) {
    for (const auto& [name, attribute] : prim.attributes)
        for (const auto& [time, value] : attribute.samples) times.insert(time);
}

}  // namespace astrosplat
