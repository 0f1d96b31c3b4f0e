#include "gaussians/gaussians.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/color.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/rotation.h"
#include "gaussians/appearance.h"
#include "gaussians/harmonics_export.h"
#include "render/falloff.h"

namespace astrosplat {
namespace {

/// Integral of w(t) e^(-k t^2) over the unit disc.
double integral_with_gaussian(const Falloff& falloff, double k) {
    constexpr double ends[] = {0.0, 0.003, 0.01, 0.03, 0.1, 0.2, 0.4, 0.7, 1.0};
    return 2.0 * real::pi * integrate_falloff(falloff, ends, [&](double t) {
               return falloff_value(falloff, t) * real::exp(-k * t * t) * t;
           });
}

/// The place of the least value of f in [low, high], by golden sections.
template <class F>
double least_place(double low, double high, F&& f) {
    constexpr double share = 0.6180339887498949;
    double a = high - share * (high - low), b = low + share * (high - low), fa = f(a), fb = f(b);
    for (int i = 0; i < 80; ++i) {
        if (fa < fb) {
            high = b, b = a, fb = fa, a = high - share * (high - low), fa = f(a);
        } else {
            low = a, a = b, fa = fb, b = low + share * (high - low), fb = f(b);
        }
    }
    return 0.5 * (low + high);
}

float luminance_of(const glm::vec3& c) { return luminance(c.x, c.y, c.z); }

/// Gives axes that are 0 directions across the others.
void complete(glm::dmat3& axes) {
    for (int k = 0; k < 3; ++k) {
        if (axes[k] != glm::dvec3(0.0)) continue;
        glm::dvec3 &next = axes[(k + 1) % 3], &last = axes[(k + 2) % 3];
        if (next == glm::dvec3(0.0) && last == glm::dvec3(0.0)) next = {1.0, 0.0, 0.0};
        glm::dvec3& other = next == glm::dvec3(0.0) ? last : next;
        glm::dvec3& missing = next == glm::dvec3(0.0) ? next : last;
        if (missing == glm::dvec3(0.0)) {
            const glm::dvec3 aside =
                std::fabs(other.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
            missing = glm::normalize(glm::cross(other, aside));
        }
        axes[k] = glm::cross(next, last);
    }
}

void count(const glm::dvec3& light, const glm::dvec3& kept, double alpha, double area, BakeCounts& counts) {
    counts.flux += area * luminance_of(glm::vec3(light));
    const double lost = luminance_of(glm::vec3(light - kept));
    counts.lost += area * lost;
    if (lost > 0.0) ++counts.bright;
    if (alpha < 1.0 / 255.0) ++counts.faint;
}

/// One layer on its way into Gaussians.
class Baker {
  public:
    Baker(const RenderLayer& layer, const Camera& camera, double gain)
        : layer_(layer),
          appearance_(layer, camera, gain),
          turn_(quaternion_of_matrix(layer.world_from_layer)) {}

    void add(std::size_t i, Gaussians& out, BakeCounts& counts) const {
        const SplatAppearance seen = appearance_.of(i, counts);
        double square = seen.sigma * seen.sigma;
        double hides = seen.hides;
        glm::dvec3 light = seen.light;
        if (hides > 1.0) {
            square *= hides;
            light /= hides;
            hides = 1.0;
        }
        const double needed = layer_.gaussians ? 0.0 : std::max({light.x, light.y, light.z});
        const double alpha = std::min(1.0, std::max(hides, needed));
        if (!(alpha > 0.0 && square > 0.0)) {
            ++counts.unseen;
            return;
        }
        const glm::dvec3 kept = layer_.gaussians ? light : glm::min(light, glm::dvec3(alpha));
        count(light, kept, alpha, 2.0 * real::pi * square, counts);
        out.position.push_back(glm::vec3(seen.place));
        const glm::vec3 straight(kept / alpha);
        out.color.push_back(layer_.gaussians ? straight : glm::clamp(straight, 0.0f, 1.0f));
        out.alpha.push_back(static_cast<float>(alpha));
        if (layer_.splats->stretch.empty()) {
            out.scale.push_back(glm::vec3(static_cast<float>(std::sqrt(square))));
            out.rotation.push_back({0.0f, 0.0f, 0.0f, 1.0f});
        } else {
            add_shape(layer_.splats->stretch[i], std::sqrt(square), out);
        }
    }

  private:
    /// The ellipsoid that `stretch` makes of a ball, turned as the layer is.
    void add_shape(const glm::mat3& stretch, double sigma, Gaussians& out) const {
        glm::dmat3 axes(stretch);
        glm::dvec3 length(0.0);
        for (int k = 0; k < 3; ++k) {
            length[k] = glm::length(axes[k]);
            if (length[k] > 0.0) axes[k] /= length[k];
        }
        complete(axes);
        out.scale.push_back(glm::vec3(sigma * length));
        out.rotation.push_back(glm::vec4(quaternion_product(turn_, quaternion_of_matrix(axes))));
    }

    const RenderLayer& layer_;
    LayerAppearance appearance_;
    glm::dvec4 turn_;
};

}  // namespace

GaussianProfile nearest_gaussian(const Falloff& falloff) {
    const double integral = falloff_integral(falloff);
    const double log_k = least_place(real::log(0.1), real::log(1e5), [&](double at) {
        const double k = real::exp(at);
        return k * (0.5 * integral - 2.0 * integral_with_gaussian(falloff, k));
    });
    const double k = real::exp(log_k);
    return {integral * k / real::pi, std::sqrt(0.5 / k)};
}

void bake_layer(const RenderLayer& layer, const Camera& camera, double gain, Gaussians& out,
                BakeCounts& counts) {
    const std::int64_t all = out.size() + layer.splats->size();
    constexpr std::int64_t bytes = 3 * sizeof(glm::vec3) + sizeof(glm::vec4) + sizeof(float);
    claim_memory(all * bytes, "Gaussians");
    out.position.reserve(all);
    out.color.reserve(all);
    out.alpha.reserve(all);
    out.scale.reserve(all);
    out.rotation.reserve(all);
    const Baker baker(layer, camera, gain);
    HarmonicsTaker harmonics(layer, out);
    for (std::size_t i = 0; i < layer.splats->position.size(); ++i) {
        baker.add(i, out, counts);
        harmonics.take(i, out);
    }
}

void encode_for_display(Gaussians& gaussians) {
    parallel_each(gaussians.color.size(), 1 << 14, [&](std::size_t i) {
        for (int k = 0; k < 3; ++k) {
            float& c = gaussians.color[i][k];
            c = c > 1.0f ? static_cast<float>(real::linear_to_srgb(c)) : display_srgb(c);
        }
    });
}

}  // namespace astrosplat
