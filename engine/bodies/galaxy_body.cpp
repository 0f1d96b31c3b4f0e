#include "bodies/galaxy_body.h"

#include <limits>

#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"
#include "source/source.h"

namespace astrosplat {
namespace {

using shared::as_exp, shared::as_log, shared::as_mix, shared::as_uniform;

// Of a Gaussian's width, and of the disk's rms width. INCLINED's are those of disks seen aslant, where
// thicker ones are streaks along the line of sight; from above, where the picture tells nothing, thin ones
// were .047 of their length thick (NGC 891: .076).
struct Thickness {
    double from_above, aslant;
    double at(double sine) const { return std::lerp(from_above, aslant, sine * sine); }
};
constexpr Thickness disk_flatness{0.13, 0.085}, fine_thickness{0.038, 0.022};
constexpr double dust_thickness = 0.012, thinnest_disk = 0.05, thickest_disk = 0.35;
// Of the disk's rms width: wider Gaussians, which are the tail of its light, are no thicker, or from the edge
// they were a slab.
constexpr double widest_thickening = 0.7;
constexpr double least_dust = 1.2;  // texels
constexpr double flattest_spheroid = 0.35;
constexpr double widest = 0.42;  // of the picture's width: a Gaussian
constexpr double seen_from_edge_deg = 75.0;
constexpr double hidden_to_deg = 80.0;
constexpr double plane_reach = 3.0;     // radii
constexpr std::int64_t plane_px = 256;  // a side

// A Gaussian in space: its width along the plane and its thickness across it.
struct SpaceGaussian {
    double width, thickness, flux;
};

LineGaussian on_lines_of_sight(const SpaceGaussian& g, double c, double s) {
    const double S2 = g.width * g.width, t2 = g.thickness * g.thickness, V = S2 * c * c + t2 * s * s;
    return {float(g.flux / (g.width * std::sqrt(V))), float(0.5 / S2), float(0.5 / V),
            float((S2 - t2) * s * c / V), float(g.width * g.thickness / std::sqrt(V))};
}

// Those that are bright enough to be seen, in texels; one of the given width where there is none.
std::vector<SpaceGaussian> in_space(const std::vector<GaussianLight>& gaussians, double texels, double scale,
                                    double width_if_none) {
    constexpr double least = 1e-4;
    double brightest = 0.0;
    for (const GaussianLight& g : gaussians) brightest = std::max(brightest, g.flux);
    std::vector<SpaceGaussian> found;
    for (const GaussianLight& g : gaussians)
        if (g.flux > least * brightest)
            found.push_back({texels * std::min(g.sigma, widest), 0.0, scale * g.flux});
    if (found.empty()) found.push_back({texels * width_if_none, 0.0, 1e-12});
    return found;
}

double rms_width(const std::vector<SpaceGaussian>& gaussians) {
    double flux = 0.0, square = 0.0;
    for (const SpaceGaussian& g : gaussians) flux += g.flux, square += g.flux * g.width * g.width;
    return std::sqrt(square / flux);
}

// By how much the light of each family is to be raised for the spheroid to have its share.
struct FamilyScale {
    double disk = 1.0, spheroid = 1.0;
};
FamilyScale scale_to(std::optional<double> wanted, double found) {
    constexpr double none = 1e-9;
    if (!wanted || found <= none || found >= 1.0 - none) return {};
    return {std::max(none, (1.0 - *wanted) / (1.0 - found)), std::max(none, *wanted / found)};
}

// Of a disk's thickness over its width: seen, where it is seen from the edge.
double own_flatness(const GalaxyLight& light, double i_deg, double c, double s) {
    if (i_deg < seen_from_edge_deg) return disk_flatness.at(s);
    const double square = (light.disk_ratio * light.disk_ratio - c * c) / (s * s);
    return std::sqrt(std::clamp(square, thinnest_disk * thinnest_disk, thickest_disk * thickest_disk));
}

// Of a spheroid that is seen from above nothing tells how flat it is.
double own_roundness(const GalaxyLight& light, double c, double s) {
    constexpr double least_square = 0.05;
    if (s * s < least_square) return usual_roundness;
    const double square = (light.spheroid_ratio * light.spheroid_ratio - c * c) / (s * s);
    return std::sqrt(std::clamp(square, flattest_spheroid * flattest_spheroid, 1.0));
}

float light_there(const LineGaussian& g, glm::vec2 uv) {
    return g.light * as_exp(-uv.x * uv.x * g.u2 - uv.y * uv.y * g.v2);
}

const std::vector<LineGaussian>& part_of(const GalaxyBody& body, GalaxyPart part) {
    return body.parts[std::size_t(part)];
}

float sum_there(const std::vector<LineGaussian>& gaussians, glm::vec2 uv) {
    float sum = 0.0f;
    for (const LineGaussian& g : gaussians) sum += light_there(g, uv);
    return sum;
}

// Of deviation 1.
float spread_of(float u) { return near_logistic(u) / logistic_deviation; }

// A Gaussian's quantile within .03 (Shore 1982, Applied Statistics 31, 108). A spheroid's must end where its
// light does: cut as spread_of() is, at 2.3 deviations in every line of sight, it had straight sides.
float gaussian_spread_of(float u) {
    constexpr float outermost = 5e-4f, steep = 0.1186f, far = 5.5556f;
    const float side = std::clamp(std::min(u, 1.0f - u), outermost, 0.5f);
    const float away = far * (1.0f - as_exp(steep * as_log(side / (1.0f - side))));
    return u < 0.5f ? -away : away;
}

}  // namespace

float GalaxyBody::value_at(const Image& field, float x, float y) const {
    return bilinear(field, 0, (x - field_begins) * to_field, (y - field_begins) * to_field);
}

std::optional<std::size_t> GalaxyClouds::at(glm::vec2 uv) const {
    const float column = uv.x / length + 0.5f * float(columns),
                row = uv.y / (cloud_flat * length) + 0.5f * float(rows);
    if (!(column >= 0.0f && row >= 0.0f && column < float(columns) && row < float(rows))) return {};
    return std::size_t(std::int64_t(row) * columns + std::int64_t(column));
}

glm::vec2 GalaxyClouds::middle(std::size_t cloud) const {
    const auto n = std::int64_t(cloud);
    return length * glm::vec2(float(n % columns) + 0.5f - 0.5f * float(columns),
                              cloud_flat * (float(n / columns) + 0.5f - 0.5f * float(rows)));
}

glm::vec2 along_and_across(const GalaxyBody& body, float x, float y) {
    const glm::vec2 d = glm::vec2(x, y) - body.center;
    return {d.x * body.major.x + d.y * body.major.y, d.x * body.near.x + d.y * body.near.y};
}

glm::vec2 place_of(const GalaxyBody& body, glm::vec2 uv) {
    return body.center + uv.x * body.major + uv.y * body.near;
}

glm::vec3 GalaxyBody::in_disk(float x, float y, float z) const {
    const glm::vec2 uv = along_and_across(*this, x, y);
    return {uv.x, uv.y * cos_i + z * sin_i, z * cos_i - uv.y * sin_i};
}

glm::vec3 GalaxyBody::in_picture(const glm::vec3& p) const {
    const float v = p.y * cos_i - p.z * sin_i;
    const glm::vec2 place = place_of(*this, {p.x, v});
    return {place.x, place.y, p.y * sin_i + p.z * cos_i};
}

namespace {

GalaxyBody lying_as(const GalaxyPlane& plane, double width) {
    const double i = real::radians(plane.inclination_deg);
    const auto ca = float(real::cos(plane.angle)), sa = float(real::sin(plane.angle));
    GalaxyBody body;
    body.center = {float(plane.x * width), float(plane.y * width)};
    body.major = {ca, -sa};
    body.near = float(plane.near_side) * glm::vec2(-sa, -ca);
    body.cos_i = float(real::cos(i));
    body.sin_i = float(real::sin(i));
    body.hidden = float(
        std::clamp((plane.inclination_deg - hidden_from_deg) / (hidden_to_deg - hidden_from_deg), 0.0, 1.0));
    return body;
}

}  // namespace

GalaxyBody make_galaxy_body(const GalaxyLight& light, const GalaxyPlane& plane, const GalaxyShape& shape,
                            double width) {
    const double i = real::radians(plane.inclination_deg), c = real::cos(i), s = real::sin(i);
    GalaxyBody body = lying_as(plane, width);
    if (light.ring) body.ring = float(*light.ring * width);
    const FamilyScale scale = scale_to(shape.bulge, light.bulge);
    const std::vector<SpaceGaussian> disk = in_space(light.disk, width, scale.disk, 0.2 * widest),
                                     ball = in_space(light.spheroid, width, scale.spheroid, 0.05 * widest);
    const double radius = rms_width(light.disk.empty() ? ball : disk),
                 flatness = own_flatness(light, plane.inclination_deg, c, s),
                 fine = std::max(
                     std::lerp(flatness * widest_thickening, fine_thickness.at(s), shape.roughness) * radius,
                     double(least_disk_thickness)),
                 dust = std::max(dust_thickness * radius, least_dust), roundness = own_roundness(light, c, s);
    body.radius = float(radius);
    body.thickness = float(shape.thicker * fine);
    const auto add = [&](GalaxyPart part, SpaceGaussian g, double thickness) {
        g.thickness = thickness;
        body.parts[std::size_t(part)].push_back(on_lines_of_sight(g, c, s));
    };
    for (const SpaceGaussian& g : disk) {
        // Where a Gaussian is what is seen, a disk that flares is thicker than in its middle.
        const double out = std::min(1.0, 3.0 * g.width / width),
                     times = shape.thicker * (1.0 + shape.flare * out * out);
        add(GalaxyPart::disk, g, times * flatness * std::min(g.width, widest_thickening * radius));
        add(GalaxyPart::fine, g, times * std::min(fine, std::lerp(flatness, 0.5, shape.roughness) * g.width));
        add(GalaxyPart::dust, g, times * std::min(dust, 0.5 * g.width));
    }
    for (const SpaceGaussian& g : ball) add(GalaxyPart::spheroid, g, roundness * g.width);
    return body;
}

GalaxyLightAt light_at(const GalaxyBody& body, float x, float y) {
    const glm::vec2 uv = along_and_across(body, x, y);
    return {sum_there(part_of(body, GalaxyPart::disk), uv),
            sum_there(part_of(body, GalaxyPart::spheroid), uv)};
}

Image invented_plane(float radius, std::uint32_t seed) {
    constexpr float pitch = 0.30573068f, steep = 3.3f;  // tan 17 degrees; of the clouds' direction
    constexpr float arms = 1.1f, bent = 0.7f, bend_wave = 0.8f, cloud_wave = 0.35f;  // radii: INCLINED 3
    constexpr float unit = 1.0f / 0.26f;  // over an octave's deviation
    const float step = float(2.0 * plane_reach) * radius / float(plane_px);
    Image plane = unfilled_image(plane_px, plane_px, 1);
    for_each_pixel(plane, [&](std::int64_t column, std::int64_t row) {
        const float x = (float(column) + 0.5f) * step - float(plane_reach) * radius,
                    y = (float(row) + 0.5f) * step - float(plane_reach) * radius;
        const float r = std::sqrt(x * x + y * y) + 1e-3f, turn = float(real::atan2(double(y), double(x)));
        const float wound = as_log(r / radius + 0.05f);
        const auto noise = [&](float at_x, float at_y, float wave, std::uint32_t field) {
            return unit *
                   shared::as_noise(at_x / (wave * radius), at_y / (wave * radius), 0.5f, seed + field);
        };
        const float sheared = turn + steep * wound;
        const float arm =
            float(real::cos(double(2.0f * turn - 2.0f * wound / pitch + bent * noise(x, y, bend_wave, 3))));
        *plane.at(column, row) = arms * arm * std::min(1.0f, r / (cloud_wave * radius)) +
                                 noise(r * float(real::cos(double(sheared))),
                                       r * float(real::sin(double(sheared))), cloud_wave, 4);
    });
    return plane;
}

float depth_of(const GalaxyBody& body, GalaxyPart part, float x, float y, float share) {
    const glm::vec2 uv = along_and_across(body, x, y);
    const std::vector<LineGaussian>& gaussians = part_of(body, part);
    float before = share * sum_there(gaussians, uv);
    for (const LineGaussian& g : gaussians) {
        const float light = light_there(g, uv);
        if (before < light || &g == &gaussians.back())
            return uv.y * g.slope + g.deviation * gaussian_spread_of(before / std::max(light, 1e-30f));
        before -= light;
    }
    return 0.0f;
}

namespace {

constexpr float cloud_scatter = 0.45f, cloud_depth = 0.4f;  // of a cloud's length: INCLINED 3

}  // namespace

std::vector<std::size_t> reached_clouds(const GalaxyBody& body, float width, float height) {
    constexpr float rounding = 0.05f;  // texels
    const GalaxyClouds& clouds = body.clouds;
    const Image& excess = body.excess;
    const float texels = 1.0f / body.to_field;  // of a field's pixel
    const glm::vec2 reach =
        cloud_scatter * clouds.length * spread_of(1.0f) * glm::vec2(1.0f, cloud_flat) + rounding;
    const glm::i64vec2 last(clouds.columns - 1, clouds.rows - 1);
    const auto cell_at = [&](glm::vec2 uv) {
        const glm::vec2 cell = uv / (clouds.length * glm::vec2(1.0f, cloud_flat)) +
                               0.5f * glm::vec2(clouds.columns, clouds.rows);
        return glm::clamp(glm::i64vec2(glm::floor(cell)), glm::i64vec2(0), last);
    };
    // Where a pixel of the field counts; the outermost ones do in all of a margin.
    const auto span = [&](std::int64_t pixel, std::int64_t count, float end) {
        const float middle = (float(pixel) + 0.5f) * texels + body.field_begins;
        return glm::vec2(pixel == 0 ? -texels : middle - texels,
                         pixel + 1 == count ? end + texels : middle + texels);
    };
    std::vector<bool> reached(clouds.z.size());
    for (std::int64_t y = 0; y < excess.height; ++y)
        for (std::int64_t x = 0; x < excess.width; ++x) {
            if (!(*excess.at(x, y) > 0.0f)) continue;
            const glm::vec2 xs = span(x, excess.width, width), ys = span(y, excess.height, height);
            glm::vec2 low(std::numeric_limits<float>::max()), high = -low;
            for (const float px : {xs.x, xs.y})
                for (const float py : {ys.x, ys.y}) {
                    const glm::vec2 uv = along_and_across(body, px, py);
                    low = glm::min(low, uv);
                    high = glm::max(high, uv);
                }
            const glm::i64vec2 from = cell_at(low - reach), to = cell_at(high + reach);
            for (std::int64_t row = from.y; row <= to.y; ++row)
                std::fill_n(reached.begin() + row * clouds.columns + from.x, to.x - from.x + 1, true);
        }
    std::vector<std::size_t> clouds_reached;
    for (std::size_t i = 0; i < reached.size(); ++i)
        if (reached[i]) clouds_reached.push_back(i);
    return clouds_reached;
}

void gather_in_clouds(const GalaxyBody& body, DepthBlock& block) {
    const GalaxyClouds& clouds = body.clouds;
    for (int i = 0; i < block.count; ++i) {
        std::uint32_t random = as_mix(block.random[i] ^ 0x3c6ef372u);
        const auto next = [&] { return as_uniform(random = as_mix(random + 0x9e3779b9u)); };
        const float x = block.x[i], y = block.y[i];
        if (next() >= body.hidden * body.value_at(body.excess, x, y)) continue;
        const glm::vec2 uv =
            along_and_across(body, x, y) +
            cloud_scatter * clouds.length * glm::vec2(spread_of(next()), cloud_flat * spread_of(next()));
        if (const std::optional<std::size_t> cloud = clouds.at(uv))
            block.z[i] = clouds.z[*cloud] + cloud_depth * clouds.length * spread_of(next());
    }
}

namespace {

// A part of a place's stars, spread as a logistic of that scale height.
struct StarLayer {
    float share, middle, height;
};

std::vector<StarLayer> star_layers(const GalaxyBody& body, glm::vec2 uv, float in_disk) {
    constexpr float thicker = 1.5f;       // than what is small in the disk: INCLINED 3
    constexpr float least_depth = 0.15f;  // of the sky's stars, of the disk's radius
    std::vector<StarLayer> layers;
    const auto add = [&](GalaxyPart part, float share, float times) {
        const float sum = std::max(sum_there(part_of(body, part), uv), 1e-30f);
        for (const LineGaussian& g : part_of(body, part))
            layers.push_back(
                {share * light_there(g, uv) / sum, uv.y * g.slope, times * g.deviation / logistic_deviation});
    };
    const float around = 0.5f * (1.0f - in_disk);
    add(GalaxyPart::fine, in_disk, thicker);
    add(GalaxyPart::spheroid, around, 1.0f);
    // About a galaxy that lies in the picture's plane less deep, or they would float before it.
    layers.push_back({around, 0.0f, std::max(least_depth, body.sin_i) * body.radius / logistic_deviation});
    std::erase_if(layers, [](const StarLayer& layer) { return layer.share < 1e-4f; });
    return layers;
}

}  // namespace

float star_depth(const GalaxyBody& body, float x, float y, float u, float in_disk) {
    const std::vector<StarLayer> layers = star_layers(body, along_and_across(body, x, y), in_disk);
    float low = 0.0f, high = 0.0f, all = 0.0f;
    for (const StarLayer& layer : layers) {
        low = std::min(low, layer.middle - 6.0f * layer.height);
        high = std::max(high, layer.middle + 6.0f * layer.height);
        all += layer.share;
    }
    for (int turn = 0; turn < 24; ++turn) {
        const float z = 0.5f * (low + high);
        float below = 0.0f;
        for (const StarLayer& layer : layers)
            below += layer.share / (1.0f + as_exp(std::min((layer.middle - z) / layer.height, 80.0f)));
        (below < u * all ? low : high) = z;
    }
    return 0.5f * (low + high);
}

namespace {

float invented_at(const GalaxyBody& body, const glm::vec3& p) {
    const float to_px = float(plane_px) / (float(2.0 * plane_reach) * body.radius);
    const auto px = [&](float at) {
        return std::clamp<std::int64_t>(std::int64_t((at + float(plane_reach) * body.radius) * to_px), 0,
                                        plane_px - 1);
    };
    return *body.plane.at(px(p.x), px(p.y));
}

// Dust of a lane lies in a ring, and what absorbs stands in front (INCLINED 4).
float dust_weight(const GalaxyBody& body, const glm::vec3& p, float z) {
    constexpr float before = 2.5f, outside = 0.08f, inside = 0.35f;
    float weight = before * body.hidden * z / body.radius;
    if (body.ring) {
        const float off = (std::sqrt(p.x * p.x + p.y * p.y) - *body.ring) / *body.ring;
        const float wide = off > 0.0f ? outside : inside;
        weight -= 0.5f * off * off / (wide * wide);
    }
    return weight;
}

}  // namespace

void set_candidates(const GalaxyBody& body, GalaxyPart part, float force, DepthBlock& block,
                    DepthCandidates& candidates) {
    LinePlaces places;
    for (int i = 0; i < block.count; ++i) {
        const glm::vec2 uv = along_and_across(body, block.x[i], block.y[i]);
        places.u[i] = uv.x, places.v[i] = uv.y;
    }
    spread_candidates(part_of(body, part), places, block, candidates);
    for (int i = 0; i < block.count; ++i)
        block.clumping[i] =
            part == GalaxyPart::dust ? 1.0f : body.value_at(body.roughness, block.x[i], block.y[i]);
    const bool weighs = !body.plane.pixels.empty();
    for (int k = 0; k < DepthCandidates::count; ++k)
        for (int i = 0; i < block.count; ++i) {
            float& weight = candidates.weight[k][i] = 0.0f;
            if (!weighs) continue;
            const float z = candidates.z[k][i];
            const glm::vec3 p = body.in_disk(block.x[i], block.y[i], z);
            weight = force * invented_at(body, p);
            if (part == GalaxyPart::dust) weight += dust_weight(body, p, z);
        }
}

}  // namespace astrosplat
