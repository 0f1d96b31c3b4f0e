#include "gaussians/harmonics_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "core/color.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

constexpr float dark = 1e-3f;       // a channel below says nothing about what a look does to it
constexpr float most_apart = 4.0f;  // a channel's factor and that of all three

std::size_t coefficients(int degree) { return static_cast<std::size_t>((degree + 1) * (degree + 1)); }

/// The largest with a coefficient that is not 0.
int degree_of(const Buffer<Harmonics>& harmonics) {
    int degree = 0;
    for (const Harmonics& h : harmonics) {
        for (std::size_t k = coefficients(degree); k < Harmonics::count; ++k)
            if (h.c[k] != glm::vec3(0.0f)) degree = k < coefficients(1) ? 1 : k < coefficients(2) ? 2 : 3;
        if (degree == 3) break;
    }
    return degree;
}

/// A rule over all directions, exact up to degree 11: twice that of harmonics, and what a display's curve
/// adds.
struct Directions {
    struct One {
        std::array<float, Harmonics::count> functions;
        float weight;
    };
    std::vector<One> all;

    Directions() {
        constexpr double nodes[][2] = {{0.2386191860831969, 0.4679139345726910},
                                       {0.6612093864662645, 0.3607615730481386},
                                       {0.9324695142031521, 0.1713244923791704}};
        constexpr int around = 12;
        for (const auto& [node, weight] : nodes)
            for (const double z : {-node, node})
                for (int i = 0; i < around; ++i) {
                    const double angle = 2.0 * real::pi * i / around, r = std::sqrt(1.0 - z * z);
                    const glm::dvec3 d(r * real::cos(angle), r * real::sin(angle), z);
                    all.push_back({harmonic_functions(glm::vec3(d)),
                                   static_cast<float>(weight * 2.0 * real::pi / around)});
                }
    }
};

glm::vec3 color_between(glm::vec3 color, bool from_display, bool to_display) {
    for (int k = 0; k < 3 && from_display != to_display; ++k)
        color[k] =
            static_cast<float>(to_display ? real::linear_to_srgb(color[k]) : real::srgb_to_linear(color[k]));
    return color;
}

/// Harmonics of the first `count` functions for the same colours in the other space.
Harmonics converted(const Harmonics& from, bool to_display, std::size_t count, const Directions& directions) {
    Harmonics to{};
    for (const Directions::One& d : directions.all) {
        glm::vec3 color(0.5f);
        for (std::size_t k = 0; k < count; ++k) color += d.functions[k] * from.c[k];
        color = color_between(glm::max(color, glm::vec3(0.0f)), !to_display, to_display);
        for (std::size_t k = 0; k < count; ++k) to.c[k] += d.weight * d.functions[k] * (color - 0.5f);
    }
    return to;
}

/// Factor of colours where `was` became `became`.
glm::vec3 factors_of(const glm::vec3& was, const glm::vec3& became) {
    const float sum = was.x + was.y + was.z;
    const float whole = sum > dark ? (became.x + became.y + became.z) / sum : 0.0f;
    glm::vec3 factors(whole);
    for (int k = 0; k < 3; ++k)
        if (was[k] > dark)
            factors[k] = std::clamp(became[k] / was[k], whole / most_apart, whole * most_apart);
    return factors;
}

/// Makes a channel's value `wanted` in the direction of these functions, by the least change over all.
void set_value(Harmonics& h, int channel, float wanted, const std::array<float, Harmonics::count>& functions,
               std::size_t count) {
    float value = 0.5f, squares = 0.0f;
    for (std::size_t j = 0; j < count; ++j) {
        value += functions[j] * h.c[j][channel];
        squares += functions[j] * functions[j];
    }
    if (wanted < dark && value < dark) return;  // black is all below 0
    for (std::size_t j = 0; j < count; ++j) h.c[j][channel] += (wanted - value) / squares * functions[j];
}

}  // namespace

HarmonicsTaker::HarmonicsTaker(const RenderLayer& layer, Gaussians& out)
    : layer_(layer), taken_(out.position.size()) {
    if (!layer.directional) return;
    const std::size_t all = out.position.size() + layer.splats->position.size();
    claim_memory(static_cast<std::int64_t>(all * sizeof(Harmonics)), "harmonics");
    out.harmonics.reserve(all);
    out.harmonics.resize(out.position.size());
    out.degree = std::max(out.degree, degree_of(layer.directional->harmonics));
    out.sources.push_back({out.position.size(), out.position.size(), layer.directional->display_harmonics,
                           layer.world_from_layer});
}

void HarmonicsTaker::take(std::size_t i, Gaussians& out) {
    if (!layer_.directional || out.position.size() == taken_) return;
    taken_ = out.position.size();
    // Both are in ascending order of id, and no row is there twice.
    while (layer_.directional->id[row_] != layer_.splats->id[i]) ++row_;
    out.harmonics.push_back(layer_.directional->harmonics[row_]);
    out.sources.back().end = out.harmonics.size();
}

void finish_harmonics(Gaussians& gaussians, const Camera& camera, bool encoded) {
    if (gaussians.harmonics.empty() || gaussians.degree == 0) {
        gaussians.harmonics = {};
        gaussians.degree = 0;
        return;
    }
    const Directions directions;
    const std::size_t count = coefficients(gaussians.degree);
    gaussians.harmonics.resize(gaussians.position.size());
    std::size_t done = 0;
    const auto even = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            gaussians.harmonics[i] = Harmonics{{mean_coefficient(gaussians.color[i])}};
    };
    for (const HarmonicsSource& source : gaussians.sources) {
        even(done, source.begin);
        done = source.end;
        const HarmonicsTurn turn = harmonics_turn(source.turn);
        parallel_each(source.end - source.begin, 1 << 10, [&](std::size_t n) {
            const std::size_t i = source.begin + n;
            Harmonics& h = gaussians.harmonics[i];
            h = turned(h, turn);
            const glm::vec3 seen(direction_to(camera, glm::dvec3(gaussians.position[i])));
            const glm::vec3 became = gaussians.color[i],
                            factors = factors_of(
                                color_between(color_towards(h, seen), source.display, encoded), became);
            if (source.display != encoded) h = converted(h, encoded, count, directions);
            h.c[0] += 0.5f / harmonic_0;
            for (std::size_t j = 0; j < count; ++j) h.c[j] *= factors;
            h.c[0] -= 0.5f / harmonic_0;
            const auto functions = harmonic_functions(seen);
            for (int k = 0; k < 3; ++k) set_value(h, k, became[k], functions, count);
        });
    }
    even(done, gaussians.position.size());
}

}  // namespace astrosplat
