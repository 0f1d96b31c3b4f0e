#include "render/lod.h"

#include <glm/common.hpp>
#include <iterator>

#include "core/real.h"
#include "core/shared_maths.h"
#include "render/footprint.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

constexpr int first_level = shared::CHILD_FIRST_LEVEL, alpha_steps = shared::CHILD_ALPHA_STEPS,
              fade_steps = shared::CHILD_FADE_STEPS, radius_steps = shared::CHILD_RADIUS_STEPS;
constexpr double disc_radius = 1.5;  // parent radii; children reach no farther than 1.25

/// (1 - x)^(4^level) for x in [0, 1].
double power_of_rest(double x, int level) {
    double rest = std::max(0.0, 1.0 - x);
    for (int i = 0; i < 2 * level; ++i) rest *= rest;
    return rest;
}

/// Radius of the ball that holds the children's centres, in parent radii.
double centre_ball(int level) { return 1.0 - 0.5 * double(shared::child_radius_scale(level)); }

}  // namespace

int finest_level(int max_children) {
    int finest = 0;
    while (finest < shared::CHILD_FINEST_LEVEL && children_of_level(finest + 1) <= max_children) ++finest;
    return finest;
}

LevelChoice choose_levels(float diameter_px, float limit_px, int max_children) {
    return shared::choose_levels(diameter_px, limit_px, finest_level(max_children));
}

float near_star_size(float nearness) { return shared::near_star_size(nearness); }

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
    std::vector<double> parent;
    for (double t : nodes_) parent.push_back(falloff_value(falloff_, t));
    footprints_.push_back(std::move(parent));
    for (int i = 0; i <= alpha_steps; ++i) numbers_.steady.push_back(double(i) / alpha_steps);
    numbers_.radius.resize(shared::CHILD_RADII);
    numbers_.fading.resize(std::size_t(shared::CHILD_ALPHAS) * shared::CHILD_FADES);
}

void LodTable::prepare(int finest, const Progress& progress) {
    while (int(footprints_.size()) <= finest) build(int(footprints_.size()), progress);
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
    const double ball = centre_ball(level), child = double(shared::child_radius_scale(level));
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
double LodTable::solve(double target, const std::vector<double>& rest, int level) const {
    const std::vector<double>& footprint = footprints_[level];
    const auto light = [&](double alpha) {
        double sum = 0.0;
        for (std::size_t n = 0; n < nodes_.size(); ++n)
            sum += weights_[n] * (1.0 - rest[n] * power_of_rest(alpha * footprint[n], level));
        return sum;
    };
    double lo = 0.0, hi = 1.0;
    for (int i = 0; i < 26; ++i) {
        const double middle = 0.5 * (lo + hi);
        (light(middle) < target ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

void LodTable::build(int level, const Progress& progress) {
    const double ball = centre_ball(level);
    footprints_.push_back(mean_footprint(level));

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
        numbers_.radius.push_back(float(ball * (k + part) / fine_rings));
    }

    const int coarse = level <= first_level ? 0 : level - 1;
    const double parent_light = falloff_integral(falloff_);
    const std::vector<double> nothing(nodes_.size(), 1.0);
    for (int i = 0; i <= alpha_steps; ++i) {
        const double a = numbers_.steady[i],
                     coarse_steady = numbers_.steady[coarse * shared::CHILD_ALPHAS + i];
        numbers_.steady.push_back(solve(a * parent_light, nothing, level));
        for (int f = 0; f <= fade_steps; ++f) {
            progress.check();
            const double coarse_alpha = coarse_steady * (1.0 - double(f) / fade_steps);
            std::vector<double> rest;
            for (double q : footprints_[coarse]) rest.push_back(power_of_rest(coarse_alpha * q, coarse));
            numbers_.fading.push_back(float(solve(a * parent_light, rest, level)));
        }
    }
}

ChildNoise make_child_noise(float strength, float radius, int level, std::uint32_t seed) {
    ChildNoise noise;
    noise.strength = strength;
    if (!(strength > 0.0f)) return noise;
    for (int i = 0; i < shared::CHILD_OCTAVES; ++i) {
        const shared::ChildOctave octave = shared::child_octave(strength, radius, level, seed, i);
        if (octave.amplitude > 0.0f) noise.octaves[noise.count++] = octave;
        noise.offset -= octave.offset;
    }
    return noise;
}

float child_light(const ChildNoise& noise, const glm::vec3& p) {
    float exponent = 0.0f;
    for (int i = 0; i < noise.count; ++i) exponent += shared::child_noise(noise.octaves[i], p);
    return shared::child_factor(noise.strength, exponent, noise.offset);
}

float largest_child_light(float strength) {
    return shared::as_exp(shared::CHILD_LARGEST_EXPONENT * strength);
}

}  // namespace astrosplat
