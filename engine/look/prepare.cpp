// Resolves one group of the look's keys after the other into LookUniforms.
#include "look/prepare.h"

#include <fmt/format.h>

#include <charconv>

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

LookEdge edge_between(const glm::vec2& from, const glm::vec2& to) {
    const glm::dvec2 along = glm::dvec2(to) - glm::dvec2(from);
    const double length2 = along.x * along.x + along.y * along.y;
    const double per_length2 = length2 > 1e-30 ? 1.0 / length2 : 0.0;
    const double slope = to.y != from.y ? along.x / along.y : 0.0;
    return {from.x, from.y, float(along.x), float(along.y), float(per_length2), float(slope), to.y, 0};
}

// Strokes are one by one, so that a splat is measured against those near it; polygons may be holes of others.
void add_outline(LookOutline o, std::span<const std::vector<glm::vec2>> lines, PreparedLook& u) {
    o.first_edge = int(u.edges.size());
    glm::vec2 lo(std::numeric_limits<float>::max()), hi(-lo);
    for (const std::vector<glm::vec2>& line : lines) {
        for (const glm::vec2& p : line) lo = glm::min(lo, p), hi = glm::max(hi, p);
        for (std::size_t i = 1; i < line.size(); ++i) u.edges.push_back(edge_between(line[i - 1], line[i]));
        if (o.half_width == 0.0f) u.edges.push_back(edge_between(line.back(), line.front()));
    }
    o.bounds = vec4(lo.x, lo.y, hi.x, hi.y);
    o.edge_count = int(u.edges.size()) - o.first_edge;
    u.outlines.push_back(o);
}

void prepare_outline(const Crop& crop, PreparedLook& u) {
    const glm::dmat3 axes = rotation_from_degrees(glm::dvec3(crop.rotate));
    LookOutline o{};
    o.eye = crop.center;
    o.half_width = 0.5f * crop.width;
    o.right = vec3(axes[0]);
    o.up = vec3(axes[1]);
    o.forward = vec3(-axes[2]);
    o.soft = crop.soft;
    o.outside = crop.keep == Crop::Keep::outside ? 1 : 0;
    o.parallel = crop.parallel ? 1 : 0;
    const std::vector<std::vector<glm::vec2>> lines = outline_lines(crop.outline);
    if (crop.width == 0.0f) return add_outline(o, lines, u);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        o.goes_on = i + 1 < lines.size() ? 1 : 0;
        add_outline(o, {&lines[i], 1}, u);
    }
}

void prepare_crops(const Look& look, PreparedLook& u) {
    std::size_t outlines = 0;
    for (const Crop& crop : look.crop) {
        if (crop.shape == Crop::Shape::outline) {
            if (++outlines <= most_outlines) prepare_outline(crop, u);
        } else if (u.crop_count < LOOK_MAX_CROPS) {
            u.crops[u.crop_count++] = prepare_crop(crop);
        }
    }
    const std::size_t volumes = look.crop.size() - outlines;
    if (volumes > std::size_t(LOOK_MAX_CROPS))
        bad_input("look.crop", fmt::format("at most {} boxes and spheres", LOOK_MAX_CROPS),
                  fmt::format("{}", volumes));
    if (outlines > most_outlines)
        bad_input("look.crop", fmt::format("at most {} outlines", most_outlines),
                  fmt::format("{}", outlines));
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

PreparedLook prepare_look(const SplatSet& set, const Look& look, const LookInputs& inputs) {
    PreparedLook u{};
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

float outlined(const PreparedLook& look, const glm::vec3& place) {
    float left = 1.0f, inside = 0.0f;
    for (const LookOutline& outline : look.outlines) {
        const vec3 seen = shared::look_outline_place(outline, place.x, place.y, place.z);
        const bool beyond = shared::look_beyond_outline(outline, seen.x, seen.y, seen.z);
        float distance2 = 3.0e38f;
        int crossed = 0;
        for (int k = 0; k < outline.edge_count && !beyond; ++k) {
            const LookEdge& edge = look.edges[std::size_t(outline.first_edge + k)];
            distance2 = std::min(distance2, shared::look_edge_distance2(edge, seen.x, seen.y));
            crossed += shared::look_edge_crossed(edge, seen.x, seen.y);
        }
        inside = std::max(inside, shared::look_inside_outline(outline, distance2, crossed, seen.z, beyond));
        if (outline.goes_on != 0) continue;
        left *= outline.outside != 0 ? 1.0f - inside : inside;
        inside = 0.0f;
    }
    return left;
}

std::vector<std::vector<glm::vec2>> outline_lines(std::string_view outline) {
    constexpr std::size_t most_points = 4096;
    const auto refuse = [](const std::string& found) {
        throw InputError("expected lines \"M x y x y ... M ...\" of at least two points each, found " +
                         found);
    };
    std::vector<std::vector<glm::vec2>> lines;
    std::vector<float> numbers;
    std::size_t points = 0;
    const auto close_line = [&] {
        if (lines.empty() && numbers.empty()) return;
        if (lines.empty()) refuse("a number before the first M");
        if (numbers.size() % 2 != 0 || numbers.size() < 4)
            refuse(fmt::format("a line of {} numbers", numbers.size()));
        for (std::size_t i = 0; i < numbers.size(); i += 2)
            lines.back().emplace_back(numbers[i], numbers[i + 1]);
        if ((points += numbers.size() / 2) > most_points)
            refuse(fmt::format("more than {} points", most_points));
        numbers.clear();
    };
    for (std::size_t at = 0; at < outline.size();) {
        if (std::string_view(" ,\t\n\r").find(outline[at]) != std::string_view::npos) {
            ++at;
        } else if (outline[at] == 'M') {
            close_line();
            lines.emplace_back();
            ++at;
        } else {
            float number = 0.0f;
            const auto [end, error] =
                std::from_chars(outline.data() + at, outline.data() + outline.size(), number);
            if (error != std::errc() || !(std::fabs(number) <= 1e6f))
                refuse(fmt::format("'{}'", outline.substr(at, 12)));
            numbers.push_back(number);
            at = std::size_t(end - outline.data());
        }
    }
    close_line();
    if (lines.empty()) refuse("nothing");
    return lines;
}

std::string outline_text(std::span<const std::vector<glm::vec2>> lines) {
    std::string text;
    for (const std::vector<glm::vec2>& line : lines) {
        text += text.empty() ? "M" : " M";
        for (const glm::vec2& p : line) text += fmt::format(" {:.5g} {:.5g}", p.x, p.y);
    }
    return text;
}

}  // namespace astrosplat
