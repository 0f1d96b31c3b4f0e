// Resolves one group of the look's keys after the other into LookUniforms.
#include "look/prepare.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/rotation.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

using namespace shared_types;
using Match = VerticalAlpha::Match;

// Shapes of a density are numbered as the shaders number profiles.
static_assert(numbered_as<DensityCurve::Shape>(PROFILE_CONSTANT, PROFILE_LINEAR, PROFILE_QUADRATIC,
                                               PROFILE_EXPONENTIAL, PROFILE_GAUSSIAN, PROFILE_SMOOTH,
                                               PROFILE_CURVE));

int profile_shape(VerticalAlpha::Shape shape) {
    switch (shape) {
        case VerticalAlpha::Shape::linear:
            return PROFILE_LINEAR;
        case VerticalAlpha::Shape::exponential:
            return PROFILE_EXPONENTIAL;
        case VerticalAlpha::Shape::s106:
            return PROFILE_S106;
        case VerticalAlpha::Shape::curve:
            return PROFILE_CURVE;
        default:
            return PROFILE_CONSTANT;
    }
}

vec3 unit_axis(const glm::vec3& axis) {
    const glm::dvec3 a(axis);
    const double length = std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return length > 0.0 ? vec3(a / length) : vec3(0.0f, 1.0f, 0.0f);
}

// One stop with the layer's own pdf unless there is a map whose values can choose between several.
void prepare_stops(const SplatSet& set, const Look& look, const LookInputs& inputs, LookUniforms& u) {
    const Thickness& thickness = look.thickness;
    if (thickness.stops.size() > std::size_t(LOOK_MAX_STOPS))
        bad_input("look.thickness.keys", fmt::format("at most {} stops", LOOK_MAX_STOPS),
                  fmt::format("{}", thickness.stops.size()));
    const bool has_map = !thickness.map.empty();
    if (has_map && set.uv.empty())
        bad_input("look.thickness.map", "splats with texture coordinates", "a set without");
    assert(!has_map || inputs.thickness_map);
    (void)inputs;
    std::vector<ThicknessStop> stops = thickness.stops;
    if (stops.empty()) stops.push_back({glm::vec3(1.0f), 1.0f, look.pdf});
    if (!has_map && stops.size() > 1) {
        log_warning("look.thickness: several stops need a map to choose between them; the first is used");
        stops.resize(1);
    }
    u.stop_count = int(stops.size());
    for (std::size_t k = 0; k < stops.size(); ++k) {
        const std::string name =
            thickness.stops.empty() ? "look.pdf" : fmt::format("look.thickness.keys[{}]", k);
        u.stops[k].color = stops[k].color;
        u.stops[k].scale = stops[k].scale;
        u.stops[k].pdf = density_profile(stops[k].pdf, name);
    }
}

bool changes_anything(const Noise& noise) {
    return noise.cull != 0.0f || noise.silhouette != 0.0f || noise.jitter != 0.0f || noise.alpha != 0.0f ||
           noise.brightness != 0.0f;
}

LookNoise prepare_noise(const Noise& noise) {
    LookNoise n{};
    n.frequency = noise.frequency;
    n.lacunarity = noise.lacunarity;
    n.gain = noise.gain;
    n.octaves = std::clamp(noise.octaves, 1, shared::AS_NOISE_MAX_OCTAVES);
    double amplitude = 1.0, sum = 0.0;
    for (int i = 0; i < n.octaves; ++i) {
        sum += amplitude;
        amplitude *= std::fabs(double(noise.gain));
    }
    n.scale = float(1.0 / sum);
    n.seed = uint(noise.seed);
    n.cull = noise.cull;
    n.silhouette = noise.silhouette;
    n.jitter = noise.jitter;
    n.alpha = noise.alpha;
    n.brightness = noise.brightness;
    return n;
}

void prepare_noises(const Look& look, LookUniforms& u) {
    for (const Noise& noise : look.noise) {
        if (!changes_anything(noise)) continue;
        if (u.noise_count == LOOK_MAX_NOISES)
            bad_input("look.noise", fmt::format("at most {} noises", LOOK_MAX_NOISES),
                      fmt::format("{}", look.noise.size()));
        u.noises[u.noise_count++] = prepare_noise(noise);
    }
}

LookCrop prepare_crop(const Crop& crop) {
    LookCrop c{};
    c.center = crop.center;
    c.x = vec3(1.0f, 0.0f, 0.0f);
    c.y = vec3(0.0f, 1.0f, 0.0f);
    c.z = vec3(0.0f, 0.0f, 1.0f);
    c.soft = crop.soft;
    c.outside = crop.keep == Crop::Keep::outside ? 1 : 0;
    if (crop.shape == Crop::Shape::sphere) {
        c.radius = crop.radius;
        return c;
    }
    const glm::dmat3 sides = rotation_from_degrees(glm::dvec3(crop.rotate));
    c.x = vec3(sides[0]);
    c.y = vec3(sides[1]);
    c.z = vec3(sides[2]);
    c.half_x = 0.5f * crop.size.x;
    c.half_y = 0.5f * crop.size.y;
    c.half_z = 0.5f * crop.size.z;
    return c;
}

void prepare_crops(const Look& look, LookUniforms& u) {
    if (look.crop.size() > std::size_t(LOOK_MAX_CROPS))
        bad_input("look.crop", fmt::format("at most {} crops", LOOK_MAX_CROPS),
                  fmt::format("{}", look.crop.size()));
    for (const Crop& crop : look.crop) u.crops[u.crop_count++] = prepare_crop(crop);
}

void prepare_alpha(const SplatSet& set, const Look& look, LookUniforms& u) {
    u.alpha = horizontal_step(look.alpha);
    u.absorbs = set.absorbs ? 1 : 0;
    if (look.alpha.unpremultiply && set.divided)
        log_warning(
            "look.alpha.unpremultiply: the source has divided the colours by alpha; they are divided again");
}

void prepare_radius(const SplatSet& set, const Radius& radius, LookUniforms& u) {
    u.radius.horizontal_scale = radius.horizontal_scale;
    u.radius.vertical_scale = radius.vertical_scale;
    u.radius.smallest = radius.min;
    u.radius.largest = radius.max;
    if (radius.min != 0.0f || radius.max != 0.0f) return;
    u.radius.own = set.radius.empty() ? 0 : 1;
    if (u.radius.own) return;
    if (!set.generated && set.size() > 0)
        bad_input("look.radius", "min and max, since the splat file holds no radius", "0 and 0");
    const glm::dvec3 s = set.spacing;
    u.radius.smallest = u.radius.largest = float(0.6 * std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z));
}

void prepare_grade(const Grade& grade, LookUniforms& u) {
    u.grade.black = grade.black;
    u.grade.tint = grade.tint * grade.gain;
    u.grade.saturation = grade.saturation;
    u.grade.inverse_gamma = float(1.0 / std::max(double(grade.gamma), 1e-6));
}

// Mean square of the set's own radii, summed in fixed chunks so that threads do not show.
double own_mean_square(const Buffer<float>& radius) {
    constexpr std::int64_t chunk = 1 << 16;
    const auto count = std::int64_t(radius.size());
    std::vector<double> sums(std::size_t((count + chunk - 1) / chunk));
    parallel_chunks(count, chunk, [&](std::int64_t begin, std::int64_t end, int) {
        double sum = 0.0;
        for (std::int64_t i = begin; i < end; ++i) sum += double(radius[i]) * double(radius[i]);
        sums[begin / chunk] = sum;
    });
    double sum = 0.0;
    for (double s : sums) sum += s;
    return count > 0 ? sum / double(count) : 0.0;
}

// automatic is resolved: coverage for generated sets, none for files.
Match resolved_match(const SplatSet& set, const VerticalAlpha& vertical) {
    if (vertical.match != Match::automatic) return vertical.match;
    return set.generated ? Match::coverage : Match::none;
}

int match_kind(Match match, ColumnLaw law) {
    if (match == Match::none) return MATCH_NONE;
    if (match == Match::sum) return MATCH_PLANES;
    if (law == ColumnLaw::maximum) return MATCH_NONE;
    if (law == ColumnLaw::screen && match == Match::picture) return MATCH_SCREEN;
    return law == ColumnLaw::sum ? MATCH_LIGHT : MATCH_TRANSMITTANCE;
}

// The factor of the integral, per scene unit of reach: splats times their area,
// or planes per scene unit.
double column_factor(const SplatSet& set, const LookInputs& inputs, const LookUniforms& u) {
    const glm::dvec3 s = set.spacing, a(u.axis);
    if (u.match == MATCH_PLANES) {
        const glm::dvec3 step = a * s;
        return 2.0 / std::sqrt(step.x * step.x + step.y * step.y + step.z * step.z);
    }
    const double area = u.radius.own ? own_mean_square(set.radius)
                                     : mean_square(double(u.radius.smallest), double(u.radius.largest));
    return 2.0 * (2.0 / (s.x * s.y * s.z)) * inputs.falloff_integral * area;
}

void prepare_match(const SplatSet& set, const Look& look, const LookInputs& inputs, LookUniforms& u) {
    u.vertical = vertical_profile(look.vertical);
    u.vertical_reach = look.vertical.reach;
    u.match = match_kind(resolved_match(set, look.vertical), inputs.column);
    if (u.match == MATCH_NONE) return;
    if (!(set.spacing.x > 0.0 && set.spacing.y > 0.0 && set.spacing.z > 0.0))
        bad_input("look.vertical.match", "none, since the spacing of the splat file's lattice is not known",
                  std::string(name_of(resolved_match(set, look.vertical))));
    const double factor = column_factor(set, inputs, u);
    const double vertical_scale = u.match == MATCH_PLANES ? 1.0 : double(u.radius.vertical_scale);
    for (int k = 0; k < u.stop_count; ++k) {
        const double reach = double(u.reach) * double(u.stops[k].scale);
        if (!(reach > 0.0)) continue;
        ColumnProfile column{u.stops[k].pdf, u.vertical, double(u.density), 1.0, 1.0};
        column.end = std::min(1.0, set.max_distance / reach);
        if (u.vertical_reach > 0.0f) column.vertical_ratio = reach / double(u.vertical_reach);
        u.stops[k].column = float(factor * column_integral(column, vertical_scale));
    }
}

}  // namespace

LookProfile density_profile(const DensityCurve& pdf, const std::string& key) {
    LookProfile profile{};
    profile.shape = int(pdf.shape);
    profile.rate = pdf.rate;
    if (pdf.shape == DensityCurve::Shape::gaussian) {
        const double sigma = std::max(double(pdf.sigma), 1e-6);
        profile.rate = float(0.5 / (sigma * sigma));
    }
    profile.curve = make_curve(pdf.points, key + ".points");
    return profile;
}

LookProfile vertical_profile(const VerticalAlpha& vertical) {
    LookProfile profile{};
    profile.shape = profile_shape(vertical.shape);
    profile.rate = vertical.rate;
    profile.curve = make_curve(vertical.points, "look.vertical.points");
    return profile;
}

LookAlpha horizontal_step(const HorizontalAlpha& alpha) {
    return {alpha.threshold, alpha.power, alpha.gain, alpha.unpremultiply ? 1 : 0};
}

LookUniforms prepare_look(const SplatSet& set, const Look& look, const LookInputs& inputs) {
    LookUniforms u{};
    u.seed = inputs.seed;
    u.axis = unit_axis(inputs.axis);
    u.reach = look.reach > 0.0f ? look.reach : float(set.max_distance);
    u.density = look.density;
    prepare_stops(set, look, inputs, u);
    prepare_noises(look, u);
    prepare_crops(look, u);
    prepare_alpha(set, look, u);
    prepare_radius(set, look.radius, u);
    prepare_grade(look.grade, u);
    prepare_match(set, look, inputs, u);
    return u;
}

}  // namespace astrosplat
