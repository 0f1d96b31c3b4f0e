// The method on one page, in double precision and without a thought for speed. A splat is a soft disc that
// faces the camera; a pixel sees it through the pixel filter; the pixel's colour C is composited from the
// farthest splat to the nearest, C = s c + B C, where s is the splat's opacity at the pixel, c its colour and
// B what it lets through.
#include "support/reference_renderer.h"

#include <numbers>
#include <tuple>

namespace astrosplat::test {
namespace {

constexpr double pi = std::numbers::pi;

/// The profile of a disc over t = distance / radius: w(0) = 1, w(t) = 0 from t = 1 on.
double profile(const Falloff& falloff, double t) {
    const double k = falloff.sharpness, edge = std::exp(-k);
    if (t >= 1.0) return 0.0;
    switch (falloff.shape) {
        case Falloff::Shape::constant:
            return 1.0;
        case Falloff::Shape::linear:
            return 1.0 - t;
        case Falloff::Shape::trapezoid:
            return t <= falloff.core ? 1.0 : (1.0 - t) / (1.0 - falloff.core);
        case Falloff::Shape::gaussian:
            return (std::exp(-k * t * t) - edge) / (1.0 - edge);
        case Falloff::Shape::exponential:
            return (std::exp(-k * t) - edge) / (1.0 - edge);
    }
    return 0.0;
}

/// Integral of f(x, y) over the disc of this radius about the origin.
template <class Function>
double integral_over_disc(double radius, int rings, int spokes, const Function& f) {
    double sum = 0.0;
    std::vector<glm::dvec2> directions;  // every other one belongs to the odd rings
    for (int k = 0; k < 2 * spokes; ++k)
        directions.push_back({std::cos(pi * k / spokes), std::sin(pi * k / spokes)});
    for (int i = 0; i < rings; ++i)
        for (std::size_t k = i % 2; k < directions.size(); k += 2) {
            const double r = radius * (i + 0.5) / rings;
            sum += r * f(r * directions[k].x, r * directions[k].y);
        }
    return sum * (radius / rings) * (2.0 * pi / spokes);
}

/// A splat on the frame.
struct Disc {
    double x, y, radius_px;  // centre; y down
    double opacity;          // alpha * layer opacity * near fade
    glm::dvec3 color;
    double h;                                      // of the hybrid blend
    std::tuple<double, int, std::uint64_t> order;  // distance, layer, id: a total order
    double gain = 0.0;                             // see corrected()
};

/// The weight of a pixel whose centre lies (dx, dy) from the disc's: the profile convolved with a Gaussian
/// that ends after four standard deviations. The integral runs over the smaller of the two.
double filtered_profile(const Falloff& falloff, double radius_px, double filter_px, double dx, double dy) {
    const double support = 4.0 * filter_px;
    if (std::hypot(dx, dy) > radius_px + support) return 0.0;
    const auto filter = [&](double x, double y) {
        const double d2 = (x * x + y * y) / (filter_px * filter_px);
        return d2 > 16.0 ? 0.0
                         : std::exp(-0.5 * d2) / (2.0 * pi * filter_px * filter_px * (1.0 - std::exp(-8.0)));
    };
    const auto disc = [&](double x, double y) {
        return profile(falloff, std::sqrt(x * x + y * y) / radius_px);
    };
    const bool rim = falloff.shape == Falloff::Shape::constant || falloff.shape == Falloff::Shape::trapezoid;
    const int rings = rim ? 64 : 24;  // a rim's place within the filter is known no better than to a ring
    if (radius_px < support)
        return integral_over_disc(radius_px, rings, 2 * rings,
                                  [&](double x, double y) { return disc(x, y) * filter(dx - x, dy - y); });
    return integral_over_disc(support, rings, 2 * rings,
                              [&](double x, double y) { return filter(x, y) * disc(dx - x, dy - y); });
}

/// A profile's weight at a pixel, corrected so that all weights together are the disc's light at any size and
/// place: all of them by a factor, but where the profile has a flat middle, which stays exactly 1, only those
/// of its rim.
double corrected(const Falloff& falloff, double weight, double gain) {
    const bool flat = falloff.shape == Falloff::Shape::constant || falloff.shape == Falloff::Shape::trapezoid;
    return flat ? weight + gain * weight * (1.0 - weight) : weight + gain * weight;
}

/// The gain that makes the sum over all pixels, also those outside the frame, the integral of the disc.
double gain_of(const Falloff& falloff, const Disc& disc, double filter_px) {
    const double reach = disc.radius_px + 4.0 * filter_px;
    double sum = 0.0, change = 0.0;  // of the weights; and by a gain of 1
    for (double y = std::floor(disc.y - reach) + 0.5; y < disc.y + reach; ++y)
        for (double x = std::floor(disc.x - reach) + 0.5; x < disc.x + reach; ++x) {
            const double weight =
                filtered_profile(falloff, disc.radius_px, filter_px, x - disc.x, y - disc.y);
            sum += weight;
            change += corrected(falloff, weight, 1.0) - weight;
        }
    const double light =
        disc.radius_px * disc.radius_px * integral_over_disc(1.0, 2000, 1, [&](double x, double y) {
            return profile(falloff, std::hypot(x, y));
        });
    return change > 0.0 ? (light - sum) / change : 0.0;
}

double smoothstep(double t) { return t * t * (3.0 - 2.0 * t); }

/// Face-on 0 (over), edge-on 1 (screen): by the angle between the layer's axis line and the ray to the splat.
double hybrid(const LayerRender& render, double cosine) {
    const double degrees = std::acos(std::min(1.0, std::fabs(cosine))) * 180.0 / pi;
    const double from = render.hybrid_from_deg, to = render.hybrid_to_deg;
    return smoothstep(to > from       ? std::clamp((degrees - from) / (to - from), 0.0, 1.0)
                      : degrees >= to ? 1.0
                                      : 0.0);
}

/// The splats of a layer before the camera.
std::vector<Disc> project_layer(const RenderLayer& layer, int number, const Camera& camera,
                                double filter_px) {
    std::vector<Disc> discs;
    const bool parallel = camera.projection == Projection::orthographic;
    const glm::dmat3 camera_from_world = glm::transpose(camera.world_from_camera);
    const glm::dvec3 axis = glm::normalize(camera_from_world * layer.world_from_layer * layer.axis);
    for (std::int64_t i = 0; i < layer.splats->size(); ++i) {
        const glm::dvec3 local = layer.splats->position[i];
        const glm::dvec3 p = camera_from_world *
                             (layer.world_from_layer * (layer.scale * local) + layer.translate - camera.eye);
        const double z = -p.z, radius = layer.splats->radius[i] * layer.scale;
        if (z <= camera.near || (camera.far > 0.0 && z > camera.far)) continue;
        const double px_per_unit = parallel ? camera.focal_px : camera.focal_px / z;
        const auto snapped = [](double px) { return std::floor(px * 256.0 + 0.5) / 256.0; };
        Disc disc;
        disc.x = snapped(camera.center_x_px + p.x * px_per_unit);
        disc.y = snapped(camera.center_y_px - p.y * px_per_unit);
        disc.radius_px = radius * px_per_unit;
        const double fade = smoothstep(std::min(1.0, (z - camera.near) / std::max(camera.near_fade, radius)));
        disc.opacity = layer.splats->alpha[i] * layer.render.opacity * fade;
        disc.color = layer.splats->color[i];
        disc.h = hybrid(layer.render, parallel ? axis.z : glm::dot(axis, p) / glm::length(p));
        disc.order = {parallel ? z : glm::length(p), number, layer.splats->id[i]};
        disc.gain = gain_of(layer.render.falloff, disc, filter_px);
        discs.push_back(disc);
    }
    return discs;
}

/// One splat over what lies behind it, `under` (RGBA).
void composite(const LayerRender& render, const Disc& disc, double s, glm::dvec4& under) {
    double through = 0.0;  // mean of B: what alpha takes of what lies behind
    const bool absorbs = (render.blend == Blend::absorb || disc.color[0] < 0.0) && !render.holdout;
    for (int k = 0; k < 3; ++k) {
        const double exponent = render.blend == Blend::absorb ? double(render.absorb[k]) : -disc.color[k];
        const double sc = absorbs ? 0.0 : s * disc.color[k];
        double b = 1.0 - s;  // over
        if (render.blend == Blend::add) b = 1.0;
        if (render.blend == Blend::screen) b = 1.0 - std::min(1.0, sc);
        if (render.blend == Blend::hybrid) b = 1.0 - s * std::lerp(1.0, std::min(1.0, disc.color[k]), disc.h);
        if (render.holdout) b = 1.0 - s;
        if (absorbs) b = std::pow(1.0 - s, exponent);
        through += b / 3.0;
        if (render.holdout)
            under[k] = b * under[k];
        else if (render.blend == Blend::lighten)
            under[k] = std::max(under[k], sc);
        else
            under[k] = sc + b * under[k];
    }
    under.a = render.holdout ? through * under.a : 1.0 - through + through * under.a;
}

/// An isolated layer's frame, rendered on black, over what lies behind it.
void composite_isolated(Blend blend, const glm::dvec4& top, glm::dvec4& under) {
    double through = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double b = blend == Blend::add      ? 1.0
                         : blend == Blend::screen ? 1.0 - std::min(1.0, top[k])
                                                  : 1.0 - top.a;
        through += b / 3.0;
        under[k] = blend == Blend::lighten ? std::max(under[k], top[k]) : top[k] + b * under[k];
    }
    under.a = 1.0 - through + through * under.a;
}

}  // namespace

Image reference_render(std::span<const RenderLayer> layers, const Camera& camera,
                       const Environment* environment, const RenderSettings& settings) {
    const double filter_px = settings.pixel_filter;
    // Layers that are not isolated are one crowd of splats, at the place of the first of them; each other
    // layer is a crowd of its own. The crowds lie one over the other in the order of the file.
    std::vector<std::vector<Disc>> crowds;
    std::size_t shared = layers.size();
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const bool isolated = layers[l].render.isolate || layers[l].render.blend == Blend::lighten;
        std::vector<Disc> discs = project_layer(layers[l], int(l), camera, filter_px);
        if (isolated || shared == layers.size()) {
            if (!isolated) shared = crowds.size();
            crowds.push_back(std::move(discs));
        } else {
            crowds[shared].insert(crowds[shared].end(), discs.begin(), discs.end());
        }
    }
    for (std::vector<Disc>& crowd : crowds)
        std::sort(crowd.begin(), crowd.end(), [](const Disc& a, const Disc& b) { return a.order > b.order; });

    Image image = make_image(settings.width, settings.height, 4);
    for (std::int64_t row = 0; row < settings.height; ++row)
        for (std::int64_t column = 0; column < settings.width; ++column) {
            const double x = double(column) + 0.5, y = double(row) + 0.5;
            glm::dvec4 pixel(0.0);
            if (environment) {
                const double spread =
                    camera.projection == Projection::orthographic ? 0.0 : 1.0 / camera.focal_px;
                pixel = glm::dvec4(glm::dvec3(sample_environment(*environment, camera.eye,
                                                                 ray_direction(camera, x, y), spread)),
                                   1.0);
            }
            for (const std::vector<Disc>& crowd : crowds) {
                if (crowd.empty()) continue;
                const LayerRender& first = layers[std::size_t(std::get<1>(crowd[0].order))].render;
                const bool alone = (first.isolate || first.blend == Blend::lighten) && !first.holdout &&
                                   first.blend != Blend::absorb;
                glm::dvec4 under = alone ? glm::dvec4(0.0) : pixel;
                for (const Disc& disc : crowd) {
                    const LayerRender& render = layers[std::size_t(std::get<1>(disc.order))].render;
                    const double seen =
                        filtered_profile(render.falloff, disc.radius_px, filter_px, x - disc.x, y - disc.y);
                    const double weight = corrected(render.falloff, seen, disc.gain);
                    composite(render, disc, std::clamp(disc.opacity * weight, 0.0, 1.0), under);
                }
                if (alone)
                    composite_isolated(first.blend, under, pixel);
                else
                    pixel = under;
            }
            for (int k = 0; k < 4; ++k) image.at(column, row)[k] = float(pixel[k]);
        }
    return image;
}

}  // namespace astrosplat::test
