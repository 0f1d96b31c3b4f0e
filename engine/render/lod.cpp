#include "render/lod.h"

#include <glm/common.hpp>
#include <iterator>

#include "core/real.h"
#include "core/shared_maths.h"
#include "render/footprint.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

constexpr int first_level = 2;  // four children (level 1) would be as large as their parent
constexpr float fade_span = 1.5f;
constexpr int alpha_steps = 32;  // table over alpha in [0, 1]
constexpr int fade_steps = 16;   // table over fade in [0, 1]
constexpr int radius_steps = 512;
constexpr double disc_radius = 1.5;  // parent radii; children reach no farther than 1.25

/// (1 - x)^(4^level) for x in [0, 1].
double power_of_rest(double x, int level) {
    double rest = std::max(0.0, 1.0 - x);
    for (int i = 0; i < 2 * level; ++i) rest *= rest;
    return rest;
}

/// Radius of the ball that holds the children's centres, in parent radii.
double centre_ball(int level) { return 1.0 - 0.5 * child_radius_scale(level); }

float lerp(float a, float b, float t) { return a + (b - a) * t; }

constexpr float octave_gain = 0.75f;          // amplitude of an octave over that of the one twice as wide
constexpr float unit_gain = 0.66143783f;      // sqrt(1 - octave_gain^2): all octaves have variance 1 together
constexpr float noise_deviation = 0.260521f;  // of as_noise over space
constexpr float farthest_cell = 0x1p30f;      // as_noise counts cells in 32 bits
constexpr float largest_exponent = 3.5f;      // times the strength; rarer than once in 2000 children

// ln of the mean of e^(x N) over space, N = as_noise over its deviation: by its cumulants of order 2, 4 and
// 6, within 0.002 for x <= 1.3.
float log_mean_exponential(float x) {
    const float x2 = x * x;
    return x2 * (0.5f + x2 * (-0.019142f + x2 * 0.00179f));
}

// Share of an octave whose cells are 2^-t diameters of the splat wide: all from the diameter down to that of
// the children, (level - 1) octaves below, and less over one octave beyond either, so that a growing splat
// takes octaves up and drops them smoothly.
float octave_share(float t, int level) {
    const float last = float(level - 2);
    return std::clamp(std::min(t + 1.0f, last + 1.0f - t), 0.0f, 1.0f);
}

}  // namespace

int finest_level(int max_children) {
    int finest = 0;
    while (finest < 12 && children_of_level(finest + 1) <= max_children) ++finest;
    return finest;
}

LevelChoice choose_levels(float diameter_px, float limit_px, int max_children) {
    const int finest = finest_level(max_children);
    LevelChoice choice;
    if (!(limit_px > 0.0f) || !(diameter_px > limit_px) || finest < first_level) return choice;
    float threshold_px = limit_px;  // above it, level `fine`
    int fine = first_level;
    while (diameter_px > 2.0f * threshold_px && fine < finest) {
        threshold_px *= 2.0f;
        ++fine;
    }
    choice.fine = fine;
    choice.coarse = fine == first_level ? 0 : fine - 1;
    choice.fade = std::min(1.0f, (diameter_px / threshold_px - 1.0f) / (fade_span - 1.0f));
    return choice;
}

LodTable::LodTable(const Falloff& falloff) : falloff_(falloff) {
    // Panels shrink towards the centre, where sharp falloffs have their light.
    constexpr double ends[] = {0.0, 0.02, 0.06, 0.12, 0.22, 0.35, 0.5, 0.7, 0.9, 1.0, 1.25, disc_radius};
    for (std::size_t i = 0; i + 1 < std::size(ends); ++i) {
        const double center = 0.5 * (ends[i] + ends[i + 1]), half = 0.5 * (ends[i + 1] - ends[i]);
        for (int sign = -1; sign <= 1; sign += 2) {
            for (std::size_t k = 0; k < gauss_nodes.size(); ++k) {
                const double t = center + sign * half * gauss_nodes[k];
                nodes_.push_back(t);
                weights_.push_back(2.0 * real::pi * t * half * gauss_weights[k]);
            }
        }
    }
    Level parent;
    for (double t : nodes_) parent.footprint.push_back(falloff_value(falloff_, t));
    for (int i = 0; i <= alpha_steps; ++i) parent.steady.push_back(double(i) / alpha_steps);
    levels_.push_back(std::move(parent));
}

void LodTable::prepare(int finest, const Progress& progress) {
    while (int(levels_.size()) <= finest) build(int(levels_.size()), progress);
}

/// Centres per area of the parent's disc at distances 0 .. ball in equal steps, integrating to 1: the density
/// w(|p|) in the ball, seen along the line of sight.
std::vector<double> LodTable::centre_density(int level) const {
    constexpr int steps = 256, depth_steps = 64;
    const double ball = centre_ball(level);
    std::vector<double> density;
    double sum = 0.0;
    for (int i = 0; i <= steps; ++i) {
        const double s = ball * i / steps, half_chord = std::sqrt(ball * ball - s * s);
        double column = 0.0;
        for (int k = 0; k < depth_steps; ++k) {
            const double z = half_chord * (k + 0.5) / depth_steps;
            column += falloff_value(falloff_, std::sqrt(s * s + z * z)) * half_chord / depth_steps;
        }
        density.push_back(column);
        sum += 2.0 * real::pi * s * column * ball / steps;
    }
    for (double& d : density) d /= sum;
    return density;
}

/// q(t): the weight of a child, averaged over where its centre may lie.
std::vector<double> LodTable::mean_footprint(int level) const {
    constexpr int azimuth_steps = 24, rings = 4;
    const double ball = centre_ball(level), child = child_radius_scale(level);
    const std::vector<double> density = centre_density(level);
    const auto density_at = [&](double s) {
        const double x = s / ball * double(density.size() - 1);
        const auto i = std::size_t(x);
        return i + 1 < density.size() ? density[i] + (density[i + 1] - density[i]) * (x - double(i)) : 0.0;
    };
    std::vector<double> azimuth_cosine;
    for (int k = 0; k < azimuth_steps; ++k)
        azimuth_cosine.push_back(real::cos(real::pi * (k + 0.5) / azimuth_steps));
    std::vector<double> q;
    for (double t : nodes_) {
        const auto ring = [&](double r) {  // centres at distance r from the point
            double sum = 0.0;
            for (double c : azimuth_cosine)
                sum += density_at(std::sqrt(std::max(0.0, t * t + r * r + 2.0 * t * r * c)));
            return 2.0 * real::pi * r * falloff_value(falloff_, r / child) * sum / azimuth_steps;
        };
        double sum = 0.0;
        for (int i = 0; i < rings; ++i)
            sum += integrate_panel(child * i / rings, child * (i + 1) / rings, ring);
        q.push_back(std::min(1.0, sum));
    }
    return q;
}

/// The child alpha for which the light of both levels reaches `target`; `rest` is what the coarser
/// one lets through.
double LodTable::solve(double target, const std::vector<double>& rest, int number, const Level& level) const {
    const auto light = [&](double alpha) {
        double sum = 0.0;
        for (std::size_t n = 0; n < nodes_.size(); ++n)
            sum += weights_[n] * (1.0 - rest[n] * power_of_rest(alpha * level.footprint[n], number));
        return sum;
    };
    double lo = 0.0, hi = 1.0;
    for (int i = 0; i < 26; ++i) {
        const double middle = 0.5 * (lo + hi);
        (light(middle) < target ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

void LodTable::build(int number, const Progress& progress) {
    Level level;
    const double ball = centre_ball(number);
    level.footprint = mean_footprint(number);

    std::vector<double> cumulative(1, 0.0);
    constexpr int fine_rings = 2048;
    for (int i = 0; i < fine_rings; ++i) {
        const double r = ball * (i + 0.5) / fine_rings;
        cumulative.push_back(cumulative.back() + r * r * falloff_value(falloff_, r));
    }
    for (int i = 0, k = 0; i <= radius_steps; ++i) {
        const double wanted = cumulative.back() * i / radius_steps;
        while (k + 1 < fine_rings && cumulative[k + 1] < wanted) ++k;
        const double step = cumulative[k + 1] - cumulative[k];
        const double part = step > 0.0 ? std::clamp((wanted - cumulative[k]) / step, 0.0, 1.0) : 0.0;
        level.radius_of_u.push_back(float(ball * (k + part) / fine_rings));
    }

    const Level& parent = levels_[0];
    const int coarse_number = number <= first_level ? 0 : number - 1;
    const Level& coarse = levels_[coarse_number];
    const double parent_light = falloff_integral(falloff_);
    const std::vector<double> nothing(nodes_.size(), 1.0);
    for (int i = 0; i <= alpha_steps; ++i) {
        const double a = parent.steady[i];
        level.steady.push_back(solve(a * parent_light, nothing, number, level));
        for (int f = 0; f <= fade_steps; ++f) {
            progress.check();
            const double coarse_alpha = coarse.steady[i] * (1.0 - double(f) / fade_steps);
            std::vector<double> rest;
            for (double q : coarse.footprint) rest.push_back(power_of_rest(coarse_alpha * q, coarse_number));
            level.fading.push_back(float(solve(a * parent_light, rest, number, level)));
        }
    }
    levels_.push_back(std::move(level));
}

LodTable::Alphas LodTable::alphas(const LevelChoice& choice, float a) const {
    const Level& fine = levels_[choice.fine];
    const Level& coarse = levels_[choice.coarse];
    const float x = std::clamp(a, 0.0f, 1.0f) * alpha_steps, y = choice.fade * fade_steps;
    const int i = std::min(int(x), alpha_steps - 1), j = std::min(int(y), fade_steps - 1);
    const float u = x - float(i), v = y - float(j);
    const float* row = &fine.fading[i * (fade_steps + 1) + j];
    const float steady = float(coarse.steady[i] + (coarse.steady[i + 1] - coarse.steady[i]) * u);
    return {steady * (1.0f - choice.fade),
            lerp(lerp(row[0], row[1], v), lerp(row[fade_steps + 1], row[fade_steps + 2], v), u)};
}

LodTable::Alphas LodTable::alphas_for_add(const LevelChoice& choice, float a) {
    // a (R / r)^2 / N with r = 2 R / sqrt(N) is a / 4 at every level.
    return {(choice.coarse == 0 ? a : 0.25f * a) * (1.0f - choice.fade), 0.25f * a * choice.fade};
}

glm::vec3 LodTable::child_offset(int level, std::int64_t child, std::uint32_t seed, std::uint64_t id) const {
    const std::uint32_t mixed =
        shared::as_mix(seed + std::uint32_t(child) * 0x9e3779b9u + std::uint32_t(level) * 0x85ebca6bu);
    const auto low = std::uint32_t(id), high = std::uint32_t(id >> 32);
    const auto uniform = [&](std::uint32_t n) {
        return shared::as_uniform(shared::as_hash(mixed, low, high, shared::PURPOSE_CHILD + n));
    };
    const float x = uniform(0) * radius_steps;
    const int i = int(x);
    const std::vector<float>& radius = levels_[level].radius_of_u;
    const float r = lerp(radius[i], radius[i + 1], x - float(i));
    const float z = 1.0f - 2.0f * uniform(1);
    const float ring = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const real::OnCircle around = real::on_circle(uniform(2));
    return r * glm::vec3(ring * around.cosine, ring * around.sine, z);
}

ChildNoise make_child_noise(float strength, float radius, int level, std::uint32_t seed) {
    ChildNoise noise;
    if (!(strength > 0.0f)) return noise;
    noise.limit = largest_exponent * strength;
    const float octaves_per_unit = 1.44269504f;  // 1 / ln 2
    const float size = octaves_per_unit * shared::as_log(2.0f * radius);
    const int first = int(std::floor(-1.0f - size)) + 1;
    for (int i = 0; i < int(noise.octaves.size()); ++i) {
        const float t = float(first + i) + size;
        const float share = octave_share(t, level);
        if (!(share > 0.0f)) continue;
        const float deviation =
            strength * share * unit_gain * shared::as_exp(t * shared::as_log(octave_gain));
        const auto octave = std::uint32_t(first + i);
        const auto hash = [&](std::uint32_t n) {
            return shared::as_hash(seed, octave, n, shared::PURPOSE_CHILD_NOISE);
        };
        noise.octaves[noise.count++] = {
            std::ldexp(1.0f, first + i),
            deviation / noise_deviation,
            {shared::as_uniform(hash(0)), shared::as_uniform(hash(1)), shared::as_uniform(hash(2))},
            hash(3)};
        noise.offset -= log_mean_exponential(deviation);
    }
    return noise;
}

float child_light(const ChildNoise& noise, const glm::vec3& p) {
    float exponent = 0.0f;
    for (int i = 0; i < noise.count; ++i) {
        const ChildNoise::Octave& octave = noise.octaves[i];
        const glm::vec3 q = glm::clamp(p * octave.frequency + octave.shift, -farthest_cell, farthest_cell);
        exponent += octave.amplitude * shared::as_noise(q.x, q.y, q.z, octave.seed);
    }
    return shared::as_exp(std::min(exponent, noise.limit) + noise.offset);
}

float largest_child_light(float strength) { return shared::as_exp(largest_exponent * strength); }

}  // namespace astrosplat
