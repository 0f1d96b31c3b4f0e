// Fewer splats in the place of many; how each looks on a frame; the Gaussians that are made of them.
#include "gaussians/gaussians.h"

#include <glm/geometric.hpp>

#include "core/bounds.h"
#include "core/color.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/rotation.h"
#include "merge/cut.h"
#include "merge/tree.h"
#include "render/footprint.h"
#include "render/shared_render.h"

namespace astrosplat {
namespace {

constexpr double frame_px = 65536.0;  // of the frame that shows the whole model: every splat has some size

/// A set of what the look left, because the tree is of a set.
std::shared_ptr<const SplatSet> set_of(const RenderLayer& layer) {
    const ShadedSplats& splats = *layer.splats;
    auto set = std::make_shared<SplatSet>();
    set->absorbs = layer.absorbs;
    set->position = splats.position;
    set->color = splats.color;
    set->alpha = splats.alpha;
    set->radius = splats.radius;
    set->id = splats.id;
    set->distance.assign(splats.position.size(), 0.0f);
    return set;
}

/// A camera with parallel rays that shows all positions.
Camera camera_around(std::span<const RenderLayer> layers, const glm::dmat3& world_from_camera) {
    Bounds box;
    for (const RenderLayer& layer : layers)
        for (const glm::vec3& p : layer.splats->position) box.add(layer.to_world(glm::dvec3(p)));
    const double size = std::max(glm::length(box.extent()), 1e-6);
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.world_from_camera = world_from_camera;
    camera.eye = box.center() + 2.0 * size * world_from_camera[2];
    camera.focal_px = frame_px / (1.1 * size);
    camera.center_x_px = camera.center_y_px = 0.5 * frame_px;
    camera.near = 1e-3 * size;
    return camera;
}

ShadedSplats with_opacity(const RenderLayer& layer) {
    ShadedSplats splats = *layer.splats;
    for (float& alpha : splats.alpha) alpha *= layer.render.opacity;
    return splats;
}

/// A Gaussian is its own nearest one.
GaussianProfile profile_of(const RenderLayer& layer) {
    const Falloff& falloff = layer.render.falloff;
    if (layer.gaussians && falloff.shape == Falloff::Shape::gaussian)
        return {1.0, std::sqrt(0.5 / double(falloff.sharpness))};
    return nearest_gaussian(falloff);
}

}  // namespace

std::vector<ShadedSplats> reduce_splats(std::span<const RenderLayer> layers,
                                        const glm::dmat3& world_from_camera, std::int64_t count,
                                        const Progress& progress) {
    std::vector<ShadedSplats> reduced;
    std::int64_t all = 0;
    for (const RenderLayer& layer : layers) all += layer.splats->size();
    if (all <= count) {
        for (const RenderLayer& layer : layers) reduced.push_back(with_opacity(layer));
        return reduced;
    }
    RenderSettings frame;
    frame.width = frame.height = std::int64_t(frame_px);
    const Camera camera = camera_around(layers, world_from_camera);
    std::vector<MergedSplats> merged(layers.size());
    std::vector<MergeSettings> merging;
    for (const RenderLayer& layer : layers) merging.emplace_back(layer.render);
    std::vector<CutLayer> cuts;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::shared_ptr<const SplatSet> set = set_of(layers[i]);
        const auto tree = std::make_shared<const MergeTree>(build_merge_tree(*set, progress));
        merged[i] = merge_splats({set, tree}, *layers[i].splats, progress);
        RenderLayer plain = layers[i];
        plain.render.lod = {};  // this camera only measures, however near it is
        cuts.push_back({&merged[i], &merging[i], make_projection(plain, std::uint16_t(i), camera, frame)});
    }
    CutSettings settings;
    settings.budget = count;
    settings.least_px = 0.0f;
    settings.width = settings.height = frame.width;
    return cut_splats(cuts, settings);
}

LayerAppearance::LayerAppearance(const RenderLayer& layer, const Camera& camera, double gain)
    : layer_(layer),
      camera_(camera),
      gain_(float(gain)),
      profile_(profile_of(layer)),
      axis_(glm::normalize(layer.world_from_layer * layer.axis)) {
    assert(layer.splats && !layer.stars);
}

SplatAppearance LayerAppearance::of(std::size_t i, BakeCounts& counts) const {
    const ShadedSplats& splats = *layer_.splats;
    SplatAppearance seen;
    seen.place = layer_.to_world(glm::dvec3(splats.position[i]));
    seen.sigma = profile_.sigma * splats.radius[i] * layer_.scale;
    const float s = std::min(1.0f, splats.alpha[i] * layer_.render.opacity);
    glm::vec3 color = splats.color[i];
    if (splats.encoded)
        for (int k = 0; k < 3; ++k) color[k] = float(real::srgb_to_linear(color[k]));
    const Blended blend = blended(color, s, seen.place, counts);
    seen.shows = profile_.peak * s;
    seen.hides = profile_.peak * blend.hides;
    seen.light = profile_.peak * glm::dvec3(blend.light);
    return seen;
}

glm::dmat3 LayerAppearance::axes_of(std::size_t i) const {
    const ShadedSplats& splats = *layer_.splats;
    return splats.stretch.empty() ? layer_.world_from_layer
                                  : layer_.world_from_layer * glm::dmat3(splats.stretch[i]);
}

LayerAppearance::Blended LayerAppearance::blended(const glm::vec3& color, float s, const glm::dvec3& place,
                                                  BakeCounts& counts) const {
    const LayerRender& r = layer_.render;
    const int blend = int(r.blend);
    if (r.holdout) return {s, glm::vec3(0.0f)};
    if (shared::blend_absorbs(blend, color.x)) {
        ++counts.dust;
        double let_through = 0.0;
        for (int k = 0; k < 3; ++k)
            let_through += real::pow(1.0 - s, shared::blend_exponent(blend, color[k], r.absorb[k])) / 3.0;
        return {float(1.0 - let_through), glm::vec3(0.0f)};
    }
    const glm::vec3 light = s * gain_ * color;
    const float bright = std::min(1.0f, std::max({color.x, color.y, color.z}) * gain_);
    return {s * shared::blend_occlusion(blend, bright, hybrid(place)), light};
}

float LayerAppearance::hybrid(const glm::dvec3& place) const {
    if (layer_.render.blend != Blend::hybrid) return 0.0f;
    return shared::hybrid_amount(float(std::abs(glm::dot(axis_, direction_to(camera_, place)))),
                                 layer_.render.hybrid_from_deg, layer_.render.hybrid_to_deg);
}

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

/// The largest with a coefficient that is not 0.
int degree_of(const Buffer<Harmonics>& harmonics) {
    int degree = 0;
    for (const Harmonics& h : harmonics) {
        for (std::size_t k = harmonics_up_to(degree); k < Harmonics::count; ++k)
            if (h.c[k] != glm::vec3(0.0f))
                degree = k < harmonics_up_to(1) ? 1 : k < harmonics_up_to(2) ? 2 : 3;
        if (degree == 3) break;
    }
    return degree;
}

/// One layer on its way into Gaussians, behind those that are there already.
class Baker {
  public:
    Baker(const RenderLayer& layer, const Camera& camera, double gain, Gaussians& out)
        : layer_(layer),
          appearance_(layer, camera, gain),
          turn_(quaternion_of_matrix(layer.world_from_layer)) {
        if (layer.directional) begin_harmonics(out);
    }

    void add(std::size_t i, Gaussians& out, BakeCounts& counts) {
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
        out.alpha.push_back(float(alpha));
        if (layer_.splats->stretch.empty()) {
            out.scale.push_back(glm::vec3(float(std::sqrt(square))));
            out.rotation.push_back({0.0f, 0.0f, 0.0f, 1.0f});
        } else {
            add_shape(layer_.splats->stretch[i], std::sqrt(square), out);
        }
        if (layer_.directional) add_harmonics(layer_.splats->id[i], out);
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

    /// Of the layer's set, which are taken along.
    void begin_harmonics(Gaussians& out) const {
        const std::size_t before = out.position.size(), all = before + layer_.splats->position.size();
        claim_memory(std::int64_t(all * sizeof(Harmonics)), "harmonics");
        out.harmonics.reserve(all);
        out.harmonics.resize(before);
        out.degree = std::max(out.degree, degree_of(layer_.directional->harmonics));
        out.sources.push_back(
            {before, before, layer_.directional->display_harmonics, layer_.world_from_layer});
    }

    void add_harmonics(std::uint64_t id, Gaussians& out) {
        // Both are in ascending order of id, and no row is there twice.
        while (layer_.directional->id[row_] != id) ++row_;
        out.harmonics.push_back(layer_.directional->harmonics[row_]);
        out.sources.back().end = out.harmonics.size();
    }

    const RenderLayer& layer_;
    LayerAppearance appearance_;
    glm::dvec4 turn_;
    std::size_t row_ = 0;  // of the set
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
    Baker baker(layer, camera, gain, out);
    for (std::size_t i = 0; i < layer.splats->position.size(); ++i) baker.add(i, out, counts);
}

void encode_for_display(Gaussians& gaussians) {
    parallel_each(gaussians.color.size(), 1 << 14, [&](std::size_t i) {
        for (int k = 0; k < 3; ++k) {
            float& c = gaussians.color[i][k];
            c = c > 1.0f ? float(real::linear_to_srgb(c)) : display_srgb(c);
        }
    });
}

}  // namespace astrosplat
