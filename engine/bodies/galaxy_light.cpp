#include "bodies/galaxy_light.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <queue>
#include <tuple>

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr double edge_on_ratio = 0.13;      // of a disk that is seen from its edge (INCLINED 1)
constexpr std::int64_t fitted_width = 240;  // px

// Numbers are those of INCLINED 1 and 2, found on inclined galaxies, where no comment says otherwise.
// Red counts most: it has less of dust and of young stars. Compact is what is so many times as bright as the
// median of 9 x 9 px, and brighter by so much.
constexpr glm::vec3 of_channels{0.6f, 0.3f, 0.1f};
constexpr float compact_times = 1.35f, compact_more = 0.02f;
constexpr std::int64_t around_px = 4;
// Within the core, where the light blurred by this is that share of its top, what is compact stays.
constexpr double core_blur_px = 6.0;
constexpr float core_of_top = 0.6f;

bool stands_out(const Image& grey, const Image& median, std::int64_t x, std::int64_t y) {
    const auto brighter = [&](std::int64_t i, std::int64_t j) {
        if (i < 0 || j < 0 || i >= grey.width || j >= grey.height) return false;
        const float own = *grey.at(i, j), around = *median.at(i, j);
        return own > compact_times * around + compact_more;
    };
    return brighter(x, y) || brighter(x - 1, y) || brighter(x + 1, y) || brighter(x, y - 1) ||
           brighter(x, y + 1);
}

Image medians_about(const Image& grey, std::int64_t reach_px) {
    Image medians = grey;
    for_each_pixel(grey, [&](std::int64_t x, std::int64_t y) {
        std::vector<float> values;
        for_each_about(grey, x, y, reach_px,
                       [&](std::int64_t i, std::int64_t j) { values.push_back(*grey.at(i, j)); });
        *medians.at(x, y) = median(values);
    });
    return medians;
}

}  // namespace

Image light_to_fit(const Image& light) {
    const int green = std::min(1, light.channels - 1), blue = std::min(2, light.channels - 1);
    const Image grey =
        made_by_pixel(reduced_to_width(light, fitted_width), 1, [&](const float* c, float* to) {
            *to = of_channels.x * c[0] + of_channels.y * c[green] + of_channels.z * c[blue];
        });
    const Image medians = medians_about(grey, around_px), wide = gaussian_blur(grey, core_blur_px);
    const float core = core_of_top * std::ranges::max(wide.pixels);
    Image clean = grey;
    for_each_pixel(grey, [&](std::int64_t x, std::int64_t y) {
        if (*wide.at(x, y) < core && stands_out(grey, medians, x, y)) *clean.at(x, y) = *medians.at(x, y);
    });
    return clean;
}

std::vector<Image> shares_of(const Image& to_fit, const std::vector<glm::dvec2>& centers) {
    std::vector<Image> shares(centers.size(), make_image(to_fit.width, to_fit.height, 1, 1.0f));
    if (centers.size() < 2) return shares;
    constexpr double smooth = 0.03, soft = 0.008;  // of the width: of the light, of the shares' edges
    const auto width = double(to_fit.width);
    const Image light = gaussian_blur(to_fit, smooth * width);
    using Place = std::tuple<float, std::int64_t, std::size_t>;  // its light, pixel, whose
    std::priority_queue<Place> next;
    for (std::size_t k = 0; k < centers.size(); ++k) {
        const auto x = std::clamp<std::int64_t>(std::int64_t(centers[k].x * width), 0, to_fit.width - 1);
        const auto y = std::clamp<std::int64_t>(std::int64_t(centers[k].y * width), 0, to_fit.height - 1);
        next.emplace(*light.at(x, y), -(y * to_fit.width + x), k);
    }
    for (Image& share : shares) std::ranges::fill(share.pixels, 0.0f);
    std::vector<bool> taken(to_fit.pixels.size(), false);
    while (!next.empty()) {
        const auto [level, negative, owner] = next.top();
        next.pop();
        const std::int64_t pixel = -negative, x = pixel % to_fit.width, y = pixel / to_fit.width;
        if (taken[pixel]) continue;
        taken[pixel] = true;
        *shares[owner].at(x, y) = 1.0f;
        for_each_about(light, x, y, 1, [&](std::int64_t i, std::int64_t j) {
            if (i == x || j == y) next.emplace(*light.at(i, j), -(j * to_fit.width + i), owner);
        });
    }
    for (Image& share : shares) share = gaussian_blur(share, soft * width);
    return shares;
}

double ratio_of_inclination(double degrees) {
    constexpr double thin2 = edge_on_ratio * edge_on_ratio;
    const double c = real::cos(real::radians(degrees));
    return std::sqrt(c * c * (1.0 - thin2) + thin2);
}

double inclination_of_ratio(double ratio) {
    constexpr double thin2 = edge_on_ratio * edge_on_ratio;
    const double cos2 = std::clamp((ratio * ratio - thin2) / (1.0 - thin2), 0.0, 1.0);
    return real::degrees(real::acos(std::sqrt(cos2)));
}

Ellipses ellipses_of(const GalaxyPlane& plane, std::int64_t width) {
    constexpr double usual_spheroid = 0.8;  // ratio that a fit begins with
    const auto w = double(width);
    return bounded({plane.x * w - 0.5, plane.y * w - 0.5, -plane.angle,
                    ratio_of_inclination(plane.inclination_deg), usual_spheroid});
}

Ellipses bounded(Ellipses e) {
    constexpr double thinnest = 0.04, roundest_disk = 0.98;
    // A spheroid is rounder than the disk: by at least so much, up to what leaves room for the fit.
    constexpr double least_spheroid = 0.5, rounder = 0.1, roundest_least = 0.95;
    e.disk = std::clamp(e.disk, thinnest, roundest_disk);
    const double least = std::max(least_spheroid, std::min(e.disk + rounder, roundest_least));
    e.spheroid = std::clamp(e.spheroid, least, 1.0);
    return e;
}

Ellipses at_half_size(Ellipses e) {
    e.x = 0.5 * (e.x + 0.5) - 0.5;
    e.y = 0.5 * (e.y + 0.5) - 0.5;
    return e;
}

Image at_half_size(const Image& image) {
    const auto half = [](std::int64_t px) { return std::max<std::int64_t>(1, px / 2); };
    return reduced_by_area(image, half(image.width), half(image.height));
}

namespace {

constexpr double darker = 0.35;  // weight of what is darker than the sum: dust only takes away
// Light that is added where its noise weighs it, where one divides by it, and where the loss is weighed.
constexpr double noise_light = 0.03, divided_light = 0.02, least_weight = 0.01;
constexpr double outlier = 0.4, most_off = 1.5;  // share of the sum: counts half from there; and no more
constexpr int reweighted = 3;

double power_of_three_halves(double x) { return x * std::sqrt(x); }

}  // namespace

double misfit(const Ellipses& e, const Image& light, const Image& share, const std::vector<double>& sigmas) {
    const GaussianBasis basis = basis_of(e, light, sigmas);
    const std::size_t pixels = light.pixels.size();
    const std::vector<bool> all(std::size_t(basis.count), true);
    std::vector<double> weights(pixels), model, away(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        weights[p] = double(share.pixels[p]) / power_of_three_halves(double(light.pixels[p]) + noise_light);
    for (int turn = 0; turn < reweighted; ++turn) {
        model = sum_of(basis, nonnegative_amplitudes(basis, light, weights, all));
        for (std::size_t p = 0; p < pixels; ++p) {
            const double r = away[p] = (double(light.pixels[p]) - model[p]) / (model[p] + divided_light);
            weights[p] = double(share.pixels[p]) / power_of_three_halves(model[p] + noise_light) *
                         (r < 0.0 ? darker : 1.0) / (1.0 + (r / outlier) * (r / outlier));
        }
    }
    double sum = 0.0, whole = 1e-300;
    for (std::size_t p = 0; p < pixels; ++p) {
        const double weight = double(share.pixels[p]) * std::sqrt(model[p] + least_weight);
        const double off = power_of_three_halves(std::min(std::fabs(away[p]), most_off));
        sum += off * (away[p] < 0.0 ? darker : 1.0) * weight;
        whole += weight;
    }
    return sum / whole;
}

namespace {

constexpr double shape_tells = 75.0;  // degrees, from which on disk and spheroid differ in shape

// The sum for the light as it is, core included.
struct FittedSum {
    std::vector<double> sigmas, amplitudes, model;  // px; of disk, spheroid, constant; of every pixel
    Ellipses ellipses;                              // their ratios, where the shape cannot tell them
};

// Parts the families by size: the disk's rms width times .4 lies between them (INCLINED 2). Wider ones count
// as wide as a frame shows.
void allow_by_size(const FittedSum& found, double width, std::vector<bool>& allowed) {
    constexpr double parts_at = 0.4, spheroids_below = 0.85, widest_seen = 0.4;
    const std::size_t n = found.sigmas.size();
    double all = 1e-300, square = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        const double s = found.sigmas[k], seen = std::min(s, widest_seen * width);
        const double flux = found.amplitudes[k] * seen * seen;
        all += flux;
        square += flux * seen * seen;
    }
    const double parting = parts_at * std::sqrt(square / all);
    for (std::size_t k = 0; k < n; ++k) {
        allowed[k] = found.sigmas[k] > parting;
        allowed[n + k] = found.sigmas[k] < spheroids_below * parting;
    }
}

// `dusty`: what is darker counts little.
FittedSum fitted_sum(Ellipses e, const Image& light, const Image& share, bool dusty) {
    constexpr double finest_px = 0.9, widest = 0.6;  // INCLINED 2: sixteen of them, the last of the width
    constexpr int widths = 16, rounds = 4;
    constexpr double dark_weight = 0.3;  // of what is darker, which may be dust
    FittedSum found{geometric(finest_px, widest * double(light.width), widths), {}, {}, e};
    const double i = real::radians(inclination_of_ratio(e.disk)), s = real::sin(i), c = real::cos(i);
    const bool by_size = inclination_of_ratio(e.disk) < shape_tells;
    if (by_size) found.ellipses.spheroid = std::sqrt(usual_roundness * usual_roundness * s * s + c * c);
    const GaussianBasis basis = basis_of(found.ellipses, light, found.sigmas);
    std::vector<bool> allowed(std::size_t(basis.count), true);
    std::vector<double> weights(light.pixels.size());
    for (int turn = 0; turn < (by_size ? 2 : 1); ++turn) {
        for (std::size_t p = 0; p < weights.size(); ++p)
            weights[p] = double(share.pixels[p]) / (double(light.pixels[p]) + divided_light);
        for (int round = 0; round < rounds; ++round) {
            found.amplitudes = nonnegative_amplitudes(basis, light, weights, allowed);
            found.model = sum_of(basis, found.amplitudes);
            for (std::size_t p = 0; p < weights.size(); ++p) {
                const bool dark = double(light.pixels[p]) < found.model[p];
                weights[p] = double(share.pixels[p]) / (found.model[p] + divided_light) *
                             (dusty && dark ? dark_weight : 1.0);
            }
        }
        allow_by_size(found, double(light.width), allowed);
    }
    return found;
}

// Optical depth: darker than the model and than what is around, where the galaxy shines. The model alone took
// its own errors for dust (INCLINED 1).
Image dust_map(const Image& light, const std::vector<double>& model, const Image& share) {
    constexpr double noise_px = 0.6, near_by = 0.02, far_off = 0.04;    // blurs; the latter of the width
    constexpr float dark_sky = 0.01f;                                   // added to light
    constexpr double lit_share = 0.12, top = 0.995;                     // of the model's top, a percentile
    constexpr float model_errs = 0.15f, noise = 0.05f, deepest = 2.0f;  // in logarithms
    const auto width = double(light.width);
    Image logarithm = gaussian_blur(light, noise_px);
    for (float& value : logarithm.pixels) value = shared::as_log(value + dark_sky);
    const Image near = gaussian_blur(logarithm, near_by * width),
                far = gaussian_blur(logarithm, far_off * width);
    const double lit = lit_share * percentile(model, top);
    Image dust = make_image(light.width, light.height, 1);
    for (std::size_t p = 0; p < dust.pixels.size(); ++p) {
        if (model[p] <= lit || share.pixels[p] <= 0.5f) continue;
        const float below = shared::as_log(float(model[p]) + dark_sky) - logarithm.pixels[p] + model_errs;
        const float around = std::max(near.pixels[p], far.pixels[p]) - logarithm.pixels[p];
        dust.pixels[p] = std::clamp(std::min(below, around) - noise, 0.0f, deepest);
    }
    return dust;
}

// The sum without the light that dust takes, and the dust.
struct SumAndDust {
    FittedSum sum;
    Image dust;
};
SumAndDust sum_and_dust(const Ellipses& e, const Image& light, const Image& share) {
    constexpr float dusty = 0.03f;  // optical depth
    const Image first = dust_map(light, fitted_sum(e, light, share, true).model, share);
    Image undimmed = share;
    for (std::size_t p = 0; p < undimmed.pixels.size(); ++p)
        if (first.pixels[p] >= dusty) undimmed.pixels[p] = 0.0f;
    FittedSum sum = fitted_sum(e, light, undimmed, false);
    Image dust = dust_map(light, sum.model, share);
    return {std::move(sum), std::move(dust)};
}

// A lane is the near half of a ring of dust: v = R cos i sqrt(1 - (u / R)^2) + t u.
struct Lane {
    double angle = 0.0;        // of the major axis
    double inclination = 0.0;  // degrees
    double radius = 0.0;       // px
    double spread = 9.0;       // of the dust about it, of the radius
};

struct DustAt {
    double u, v, depth;
};

// Within so many px of the major axis; by |u|.
std::vector<DustAt> dust_near_axis(const Ellipses& e, const Image& dust, double within_px) {
    constexpr double farthest = 0.45;  // of the width, along the axis
    std::vector<DustAt> points;
    for (std::int64_t y = 0; y < dust.height; ++y)
        for (std::int64_t x = 0; x < dust.width; ++x) {
            const AlongEllipses a = along(e, double(x), double(y));
            if (*dust.at(x, y) > 0.0f && std::fabs(a.v) < within_px &&
                std::fabs(a.u) < farthest * double(dust.width))
                points.push_back({a.u, a.v, double(*dust.at(x, y))});
        }
    std::ranges::sort(points, {}, [](const DustAt& p) { return std::fabs(p.u); });
    return points;
}

// The lane through these, by least squares; false where there are too few. Its radius is 1.05 of that within
// which 95 % of the dust lies (INCLINED 1); it turns by a part of the way, so that turns end.
bool fit_lane(const std::vector<DustAt>& points, Lane& lane) {
    constexpr double least_dust = 3.0;  // optical depths of a pixel
    constexpr double inner_share = 0.95, beyond = 1.05, part_of_turn = 0.7;
    double all = 0.0, sum = 0.0;
    for (const DustAt& p : points) all += p.depth;
    if (all < least_dust) return false;
    for (const DustAt& p : points) {
        if ((sum += p.depth) < inner_share * all) continue;
        lane.radius = beyond * std::fabs(p.u) + 1.0;
        break;
    }
    const auto ring = [&](double u) {
        return std::sqrt(std::max(0.0, 1.0 - (u / lane.radius) * (u / lane.radius)));
    };
    double rr = 0.0, ru = 0.0, uu = 0.0, rv = 0.0, uv = 0.0, square = 0.0;
    for (const auto& [u, v, d] : points) {
        const double r = ring(u);
        rr += d * r * r, ru += d * r * u, uu += d * u * u, rv += d * r * v, uv += d * u * v;
    }
    const double whole = rr * uu - ru * ru;
    if (!(std::fabs(whole) > 0.0)) return false;
    const double height = (rv * uu - uv * ru) / whole, slope = (rr * uv - ru * rv) / whole;
    for (const auto& [u, v, d] : points) {
        const double rest = v - height * ring(u) - slope * u;
        square += d * rest * rest;
    }
    lane.spread = std::sqrt(square / all) / lane.radius;
    lane.angle += part_of_turn * real::atan2(slope, 1.0);
    lane.inclination = real::degrees(real::acos(std::min(1.0, std::fabs(height) / lane.radius)));
    return true;
}

double degrees_between_axes(double a, double b) {
    const double turns = (a - b) / real::pi;
    return std::fabs(turns - std::round(turns)) * 180.0;
}

double lost_share(const Image& dust, const std::vector<double>& model) {
    double lost = 0.0, all = 1e-300;
    for (std::size_t p = 0; p < model.size(); ++p) {
        lost += model[p] * (1.0 - double(shared::as_exp(-dust.pixels[p])));
        all += model[p];
    }
    return lost / all;
}

std::optional<Lane> find_lane(const Ellipses& e, const SumAndDust& seen) {
    constexpr double least_deg = 72.0, most_turn_deg = 12.0, most_spread = 0.03, least_lost = 0.008;
    // It is looked for ever nearer to the axis: of the width, at first and in the end; times so much a turn.
    constexpr double within_first = 0.12, within_last = 0.03, closing_in = 0.6;
    constexpr int turns = 8;
    if (inclination_of_ratio(e.disk) <= least_deg) return {};
    const auto width = double(seen.dust.width);
    Lane lane{e.angle};
    Ellipses turned = e;
    double narrow = within_first * width;
    for (int turn = 0; turn < turns; ++turn, narrow *= closing_in) {
        turned.angle = lane.angle;
        const double within_px = std::max(narrow, within_last * width);
        if (!fit_lane(dust_near_axis(turned, seen.dust, within_px), lane)) return {};
    }
    if (lane.inclination > least_deg && degrees_between_axes(lane.angle, e.angle) < most_turn_deg &&
        lane.spread < most_spread && lost_share(seen.dust, seen.sum.model) > least_lost)
        return lane;
    return {};
}

// By the light that dust takes away on either side of the major axis: positive where v is.
double more_dust_below(const Ellipses& e, const SumAndDust& seen) {
    // Of a disk as it is seen; of the width; of an ellipse's height there.
    constexpr double thinnest = 0.1, farthest = 0.3, off_axis = 0.3;
    const double q = std::max(e.disk, thinnest), reach = farthest * double(seen.dust.width);
    double below = 0.0, above = 0.0;
    for (std::int64_t y = 0; y < seen.dust.height; ++y)
        for (std::int64_t x = 0; x < seen.dust.width; ++x) {
            const AlongEllipses a = along(e, double(x), double(y));
            if (std::hypot(a.u, a.v / q) >= reach || std::fabs(a.v) <= off_axis * q * std::fabs(a.u))
                continue;
            const double taken = seen.sum.model[y * seen.dust.width + x] *
                                 (1.0 - double(shared::as_exp(-*seen.dust.at(x, y))));
            (a.v > 0.0 ? below : above) += taken;
        }
    return (below - above) / (below + above + 1e-9);
}

std::vector<GaussianLight> gaussians(const FittedSum& sum, std::size_t first, double ratio, double width) {
    std::vector<GaussianLight> found;
    for (std::size_t k = 0; k < sum.sigmas.size(); ++k) {
        const double sigma = sum.sigmas[k] / width;
        if (sum.amplitudes[first + k] > 0.0)
            found.push_back({sigma, sigma * sigma * ratio * sum.amplitudes[first + k]});
    }
    return found;
}

double flux_within_picture(const std::vector<GaussianLight>& gaussians) {
    constexpr double half = 0.5;  // of the width: of wider ones the picture shows a square of it
    double sum = 0.0;
    for (const GaussianLight& g : gaussians) sum += g.flux * std::min(1.0, half * half / (g.sigma * g.sigma));
    return sum;
}

// What ratios are tried with, at half the size.
std::vector<double> sigmas_of_trials(const Image& light) {
    constexpr double finest_px = 0.8, widest = 0.55;  // of the width
    return geometric(finest_px, widest * double(light.width), 12);
}

// Seen from the edge, how thick a disk and how round a spheroid is shows in the light: a coarse grid of
// ratios, then the disk's in finer steps.
Ellipses with_ratios_seen(Ellipses e, const Image& light, const Image& share) {
    const Image half = at_half_size(light), half_share = at_half_size(share);
    const std::vector<double> sigmas = sigmas_of_trials(light);
    Ellipses best = e;
    double least = 1e300;
    const auto try_ratios = [&](double disk, double spheroid) {
        e.disk = disk;
        e.spheroid = spheroid;
        const double loss = misfit(at_half_size(bounded(e)), half, half_share, sigmas);
        if (loss < least) least = loss, best = bounded(e);
    };
    for (const double disk : {0.06, 0.1, 0.16, 0.25, 0.38})
        for (const double spheroid : {0.5, 0.65, 0.8, 1.0}) try_ratios(disk, spheroid);
    const Ellipses about = best;
    for (const double times : {0.8, 0.89, 1.12, 1.26}) try_ratios(times * about.disk, about.spheroid);
    return best;
}

// Of light that is round in space, both families are alike.
Ellipses as_one_spheroid(Ellipses e, const Image& light, const Image& share) {
    const Image half = at_half_size(light), half_share = at_half_size(share);
    const std::vector<double> sigmas = sigmas_of_trials(light);
    constexpr double flattest = 0.3, step = 0.05;  // ellipticals are no flatter
    double least = 1e300, best = 1.0;
    for (double ratio = flattest; ratio <= 1.0; ratio += step) {
        e.disk = e.spheroid = ratio;
        const double loss = misfit(at_half_size(e), half, half_share, sigmas);
        if (loss < least) least = loss, best = ratio;
    }
    e.disk = e.spheroid = best;
    return e;
}

}  // namespace

DustSeen dust_seen(const Ellipses& e, const Image& to_fit, const Image& share) {
    const SumAndDust seen = sum_and_dust(e, to_fit, share);
    DustSeen found;
    Ellipses turned = e;
    if (const std::optional<Lane> lane = find_lane(e, seen)) {
        found.angle = turned.angle = lane->angle;
        found.inclination_deg = lane->inclination;
        found.ring_px = lane->radius;
    }
    found.more_below = more_dust_below(turned, seen);
    return found;
}

GalaxyLight light_of_galaxy(const Image& to_fit, const Image& share, const GalaxyPlane& plane,
                            bool only_spheroid) {
    const auto width = double(to_fit.width);
    Ellipses e = ellipses_of(plane, to_fit.width);
    if (only_spheroid)
        e = as_one_spheroid(e, to_fit, share);
    else if (plane.inclination_deg >= shape_tells)
        e = with_ratios_seen(e, to_fit, share);
    const SumAndDust seen = sum_and_dust(e, to_fit, share);
    const FittedSum& sum = seen.sum;
    GalaxyLight found;
    found.disk_ratio = e.disk;
    found.spheroid_ratio = sum.ellipses.spheroid;
    found.disk = gaussians(sum, 0, found.disk_ratio, width);
    found.spheroid = gaussians(sum, sum.sigmas.size(), found.spheroid_ratio, width);
    if (only_spheroid) {
        found.spheroid.insert(found.spheroid.end(), found.disk.begin(), found.disk.end());
        found.disk.clear();
    } else if (const std::optional<Lane> lane = find_lane(e, seen)) {
        found.ring = lane->radius / width;
    }
    const double disk = flux_within_picture(found.disk), ball = flux_within_picture(found.spheroid);
    found.bulge = ball / std::max(1e-300, disk + ball);
    return found;
}

}  // namespace astrosplat
