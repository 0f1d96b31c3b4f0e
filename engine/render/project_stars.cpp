#include "render/project.h"

#include <glm/geometric.hpp>

#include "camera/projection.h"
#include "core/real.h"
#include "render/shape.h"
#include "render/sphere_shape.h"

namespace astrosplat {
namespace {

constexpr float faintest_peak = 1.0f / 16384.0f;  // of a wing's or a spike's splat, scene light
constexpr float infinity_from = 1e15f;            // scene units

/// A gaussian of these deviations, px, the pixel filter included, along (x, y) and across.
StarSplat make_splat(double share, double along_px, double across_px, double x, double y,
                     const FootprintTable& footprint) {
    // No narrower than a pixel's filter and a little: light is right at every radius, peaks stay in range.
    const double filter = double(footprint.pixel_filter_px), least = 0.25;
    const auto radius = [&](double deviation) {
        const double own = std::sqrt(std::fmax(0.0, deviation * deviation - filter * filter));
        return std::fmax(own / std::sqrt(double(footprint.variance)), least);
    };
    const double a = radius(along_px), b = radius(across_px);
    StarSplat splat;
    splat.share = float(share);
    splat.per_light = float(1.0 / (double(footprint.integral) * a * b));
    splat.radius_px = float(a);
    splat.is_round = a == b;
    splat.shape = {float(x * a), float(-y * b), float(y * a), float(x * b)};
    return splat;
}

float square(float x) { return x * x; }

/// Of the pixel that a star's light was measured in, scene units.
float measured_side(const LayerProjection& layer, const glm::vec3& place) {
    const StarPixels& pixels = layer.star_pixels;
    const double side =
        pixels.side > 0.0 ? pixels.side : pixels.side_at_1 * glm::length(glm::dvec3(place) - pixels.from);
    return float(side) * layer.radius_scale;
}

/// The light of one star at the camera.
struct StarLight {
    glm::vec3 light;  // over all pixels
    float distance;   // scene units
    bool infinite;
};
StarLight star_light(const LayerProjection& layer, const glm::vec3& p, std::int64_t index) {
    const glm::vec3& place = layer.splats->position[index];
    StarLight star{layer.splats->color[index], std::sqrt(glm::dot(p, p)), false};
    star.infinite = !(star.distance < infinity_from);
    if (star.infinite) return star;
    const float reach = std::max({star.distance, layer.lens.near_fade, layer.lens.near});
    if (layer.star_pixels.are_known()) {
        const bool parallel = shared::has_parallel_rays(layer.lens);
        star.light *= square(measured_side(layer, place) * layer.lens.focal_px / (parallel ? 1.0f : reach));
    } else {
        star.light *= square(std::sqrt(glm::dot(place, place)) * layer.radius_scale / reach);
    }
    return star;
}

float brightest(const glm::vec3& light) { return std::max({light.x, light.y, light.z}); }

/// Which share of a splat of a wing or a spike is drawn.
float shown_share(const StarSplat& splat, float light) {
    return real::smoothstep(
        std::clamp((light * splat.share * splat.per_light / faintest_peak - 1.0f) / 3.0f, 0.0f, 1.0f));
}

}  // namespace

std::vector<StarSplat> star_splats(const StarPsf& psf, const FootprintTable& footprint) {
    const double core_px = psf.core_px;
    const double wings = psf.wing_share, spikes = std::min(double(psf.spike_share), 1.0 - wings);
    std::vector<StarSplat> splats{make_splat(1.0 - wings - spikes, core_px, core_px, 1.0, 0.0, footprint)};
    const auto mixture = [](int from, int to, const auto& density) {
        std::vector<std::pair<double, double>> parts;  // value, share
        double sum = 0.0;
        for (int k = from; k <= to; ++k) {
            const double value = std::ldexp(1.0, k);
            parts.emplace_back(value, density(value));
            sum += parts.back().second;
        }
        for (auto& part : parts) part.second /= sum;
        return parts;
    };
    // A part no wider than the core is added to it: equal splats of one star would have no order.
    const auto add = [&](double share, double along_px, double across_px, double turn) {
        if (along_px <= core_px)
            splats[0].share += float(share);
        else
            splats.push_back(
                make_splat(share, along_px, across_px, real::cos(turn), -real::sin(turn), footprint));
    };
    if (wings > 0.0)
        for (const auto& [t, share] :
             mixture(-6, 3, [&](double t) { return real::pow(t, psf.wing_power - 1.0) * real::exp(-t); })) {
            const double deviation = double(psf.wing_px) / std::sqrt(2.0 * t);
            add(wings * share, deviation, deviation, 0.0);
        }
    if (!(spikes > 0.0) || psf.vanes < 1) {
        splats[0].share += float(spikes);
        return splats;
    }
    const int lines = psf.vanes % 2 == 0 ? psf.vanes / 2 : psf.vanes;
    for (int line = 0; line < lines; ++line) {
        const double turn = real::radians(double(psf.vane_deg)) + real::pi * line / lines;
        for (const auto& [v, share] : mixture(-4, 2, [](double v) { return v * real::exp(-v); }))
            add(spikes * share / lines, double(psf.spike_px) * std::sqrt(2.0 * v), core_px, turn);
    }
    return splats;
}

void project_stars(const LayerProjection& layer, std::int64_t begin, std::int64_t end, const ScreenRect& rect,
                   Buffer<ScreenSplat>& out, Buffer<Shape>& shapes) {
    const Lens& lens = layer.lens;
    const bool sphere = shared::is_onto_sphere(lens);
    const float period = shared::period_px(lens);
    for (std::int64_t i = begin; i < end; ++i) {
        const glm::vec3 p = to_camera(layer, layer.splats->position[i]);
        const StarLight star = star_light(layer, p, i);
        const shared::Instance at = shared::instance_of(lens, p);
        if (!(at.depth > lens.near) || !(star.infinite || shared::is_in_range(lens, at.depth))) continue;
        ScreenSplat splat;
        splat.x_px = shared::snap_px(at.x_px);
        splat.y_px = shared::snap_px(at.y_px);
        splat.opacity = layer.opacity * shared::near_fade(lens, at.depth, 0.0f);
        splat.depth = std::bit_cast<std::uint32_t>(shared::sort_depth(lens, p));
        splat.index = std::uint32_t(i);
        splat.layer = layer.layer;
        splat.hybrid = 0;
        const float light = brightest(star.light);
        if (!(light > 0.0f) || !(splat.opacity > 0.0f)) continue;
        const auto draw = [&](const StarSplat& part, float share) {
            ScreenSplat drawn = splat;
            Shape shape = part.shape;
            float light_here = share * part.per_light,
                  reach_px = part.radius_px * layer.reach + layer.margin_px;
            if (!part.is_round) {
                if (sphere) {
                    const SphereAxes axes = sphere_axes(lens, double(splat.x_px), double(splat.y_px));
                    shape = onto_sphere(axes, part.shape);
                    light_here *= float(frame_area(axes));
                }
                reach_px = shape_support_px(shape, {layer.reach, layer.margin_px, layer.variance});
            }
            const float support = shared::frame_reach_px(lens, splat.x_px, splat.y_px, reach_px);
            if (!shared::appears_in_rect(lens, splat.x_px, splat.y_px, support, rect.x0, rect.y0, rect.x1,
                                         rect.y1))
                return;
            for (int k = 0; k < 3; ++k) drawn.color[k] = star.light[k] * light_here;
            drawn.radius_px = part.radius_px;
            if (!part.is_round) {
                set_shape_number(drawn, std::uint32_t(shapes.size()));
                shapes.push_back(shape);
            }
            push_places(drawn, period, support, rect, out);
        };
        float core_share = layer.star_splats[0].share;
        for (std::size_t d = 1; d < layer.star_splats.size(); ++d) {
            const StarSplat& part = layer.star_splats[d];
            const float shown = shown_share(part, light);
            core_share += part.share * (1.0f - shown);
            if (shown > 0.0f) draw(part, part.share * shown);
        }
        draw(layer.star_splats[0], core_share);
    }
}

float largest_star_light(const LayerProjection& layer) {
    float largest = 0.0f;
    for (std::int64_t i = 0; i < layer.splats->size(); ++i)
        largest = std::max(
            largest, brightest(star_light(layer, to_camera(layer, layer.splats->position[i]), i).light));
    return largest * layer.star_splats[0].per_light * layer.opacity;
}

}  // namespace astrosplat
