// Colours: our own renderer lays the encoded Gaussians over each other as their readers do, and every
// Gaussian's light is multiplied by the ratio of wanted to rendered light where its centre is seen; several
// times, because alphas that were raised hide more of what lies behind. Harmonics of the other space are
// evaluated all around and fitted again.
#include "gaussians/gaussians.h"

#include <glm/common.hpp>

#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/rotation.h"
#include "render/project.h"
#include "render/render.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

constexpr int rounds = 8;
constexpr float reach_sigmas = 4.0f;      // where a Gaussian of 0.03 % is cut off
constexpr float least_encoded = 1.0e-3f;  // of a display's range: darker pixels say nothing
constexpr float most_step = 2.0f;         // by which light grows or shrinks in a round

bool is_round(const glm::vec3& scale) { return scale.x == scale.y && scale.y == scale.z; }

/// The Gaussians as splats of one layer; their arrays are copies.
ShadedSplats as_splats(const Gaussians& gaussians) {
    ShadedSplats splats;
    splats.position = gaussians.position;
    splats.color = gaussians.color;
    splats.alpha = gaussians.alpha;
    splats.radius.resize(gaussians.position.size());
    splats.id.resize(gaussians.position.size());
    for (std::size_t i = 0; i < splats.id.size(); ++i) {
        const glm::vec3& scale = gaussians.scale[i];
        splats.radius[i] = reach_sigmas * std::max({scale.x, scale.y, scale.z});
        splats.id[i] = i;
    }
    if (std::ranges::all_of(gaussians.scale, is_round)) return splats;
    for (std::size_t i = 0; i < splats.id.size(); ++i) {
        glm::dmat3 shape = matrix_of_quaternion(glm::dvec4(gaussians.rotation[i]));
        for (int k = 0; k < 3; ++k)
            shape[k] *= double(reach_sigmas) * double(gaussians.scale[i][k]) / double(splats.radius[i]);
        splats.stretch.push_back(glm::mat3(shape));
    }
    return splats;
}

Image encoded(const Image& linear) {
    Image display = linear;
    for (float& value : display.pixels) value = display_srgb(value);
    return display;
}

/// Factor of a Gaussian's light, per channel, for the pixel that its centre is seen in.
glm::vec3 step_at(const Image& wanted, const Image& found, std::int64_t x, std::int64_t y) {
    glm::vec3 step(1.0f);
    for (int k = 0; k < 3; ++k) {
        const float is = found.at(x, y)[k], should = wanted.at(x, y)[k];
        if (is + should > 2.0f * least_encoded)
            step[k] =
                std::clamp((should + least_encoded) / (is + least_encoded), 1.0f / most_step, most_step);
    }
    return step;
}

}  // namespace

void fit_to_view(Gaussians& gaussians, const Image& wanted, const Camera& camera,
                 const RenderSettings& settings) {
    const Image goal = encoded(wanted);
    ShadedSplats splats = as_splats(gaussians);
    RenderLayer layer;
    layer.splats = &splats;
    layer.render.falloff.sharpness = 0.5f * reach_sigmas * reach_sigmas;
    const LayerProjection projection = make_projection(layer, 0, camera, settings);
    RenderCache cache;
    for (int round = 0; round < rounds; ++round) {
        const Image found = render({&layer, 1}, camera, nullptr, settings, {}, &cache).beauty;
        parallel_each(splats.position.size(), 1 << 12, [&](std::size_t i) {
            const shared::Instance at =
                shared::instance_of(projection.lens, to_camera(projection, splats.position[i]));
            if (!(at.depth > projection.lens.near)) return;
            if (!(at.x_px >= 0.0f && at.y_px >= 0.0f && at.x_px < float(settings.width) &&
                  at.y_px < float(settings.height)))
                return;
            glm::vec3 light = splats.alpha[i] * splats.color[i];
            light *= step_at(goal, found, std::int64_t(at.x_px), std::int64_t(at.y_px));
            splats.alpha[i] = std::min(1.0f, std::max({splats.alpha[i], light.x, light.y, light.z}));
            splats.color[i] = glm::min(light / splats.alpha[i], glm::vec3(1.0f));
        });
    }
    gaussians.color = std::move(splats.color);
    gaussians.alpha = std::move(splats.alpha);
}

namespace {

constexpr float dark = 1e-3f;       // a channel below says nothing about what a look does to it
constexpr float most_apart = 4.0f;  // a channel's factor and that of all three

/// A rule over all directions, exact up to degree 11: twice that of harmonics,
/// and what a display's curve adds.
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
                    all.push_back(
                        {harmonic_functions(glm::vec3(d)), float(weight * 2.0 * real::pi / around)});
                }
    }
};

glm::vec3 color_between(glm::vec3 color, bool from_display, bool to_display) {
    for (int k = 0; k < 3 && from_display != to_display; ++k)
        color[k] = float(to_display ? real::linear_to_srgb(color[k]) : real::srgb_to_linear(color[k]));
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

void finish_harmonics(Gaussians& gaussians, const Camera& camera, bool encoded) {
    if (gaussians.harmonics.empty() || gaussians.degree == 0) {
        gaussians.harmonics = {};
        gaussians.degree = 0;
        return;
    }
    const Directions directions;
    const std::size_t count = gaussians.harmonics_each();
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
