#include "bodies/axis_fit.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr std::int64_t fit_width = 160;  // px
constexpr double steepest_deg = 80.0;

// The picture small, and above what its sky shines: the least twentieth of each channel.
Image small_above_sky(const Image& picture) {
    constexpr double sky_share = 0.05;
    Image light = reduced_to_width(picture, fit_width);
    for (int c = 0; c < light.channels; ++c) {
        const Image one = channel_of(light, c);
        const auto sky = float(percentile({one.pixels.begin(), one.pixels.end()}, sky_share));
        change_pixels(light, [&](float* p) { p[c] = std::max(0.0f, p[c] - sky); });
    }
    return light;
}

// A line in a picture: a place on it, px from the top left corner, and its angle from right counter-clockwise
// as seen.
struct Line {
    glm::dvec2 place{0.0};
    double angle = 0.0;
    glm::dvec2 along() const { return {real::cos(angle), -real::sin(angle)}; }
    glm::dvec2 across() const { return {real::sin(angle), real::cos(angle)}; }
};

bool is_inside(const Image& image, const glm::dvec2& p) {
    return p.x >= 0.5 && p.y >= 0.5 && p.x <= double(image.width) - 0.5 && p.y <= double(image.height) - 0.5;
}

// Of amplitudes about the line, at most 1. What lies across from the outside of the frame is unknown, which
// costs a fifth of what being unlike would.
double symmetry(const Image& root, const Line& line) {
    constexpr double unknown = 0.2;
    const glm::dvec2 across = line.across();
    double unlike = 0.0, all = 1e-30, lost = 0.0;
    for (std::int64_t y = 0; y < root.height; ++y)
        for (std::int64_t x = 0; x < root.width; ++x) {
            const glm::dvec2 p(double(x) + 0.5, double(y) + 0.5), from = p - line.place;
            const glm::dvec2 there = p - 2.0 * (from.x * across.x + from.y * across.y) * across;
            const bool known = is_inside(root, there);
            const LinearSample sample(root, float(there.x), float(there.y));
            for (int c = 0; c < root.channels; ++c) {
                const double here = double(root.at(x, y)[c]), other = double(sample.of(root, c));
                if (known) {
                    unlike += (here - other) * (here - other);
                    all += here * here + other * other;
                } else {
                    lost += here * here;
                }
            }
        }
    return 1.0 - (unlike + unknown * lost) / (all + lost);
}

struct Symmetric {
    Line line;
    double value = -1.0;
};

// How far across a line others are tried, and in what steps.
struct Search {
    double far_px, step_px;
};

// The most symmetric of lines beside one and turned against it by up to `turn`.
Symmetric best_about(const Image& root, const Line& line, const Search& search, double turn = 0.0) {
    constexpr int turns = 6;  // to either side
    const int steps = int(search.far_px / search.step_px), most = turn > 0.0 ? turns : 0,
              lines = 2 * steps + 1;
    std::vector<Symmetric> tried(std::size_t(lines) * std::size_t(2 * most + 1));
    parallel_for(std::int64_t(tried.size()), [&](std::int64_t i, int) {
        Symmetric& one = tried[std::size_t(i)];
        one.line = {line.place + (double(i % lines) - steps) * search.step_px * line.across(),
                    line.angle + (double(i / lines) - most) / turns * turn};
        one.value = symmetry(root, one.line);
    });
    return *std::ranges::max_element(tried, {}, &Symmetric::value);
}

glm::dvec2 middle_of_light(const Image& root) {
    glm::dvec3 sum(0.0, 0.0, 1e-30);
    for (std::int64_t y = 0; y < root.height; ++y)
        for (std::int64_t x = 0; x < root.width; ++x)
            for (int c = 0; c < root.channels; ++c)
                sum += double(root.at(x, y)[c]) * glm::dvec3(double(x) + 0.5, double(y) + 0.5, 1.0);
    return glm::dvec2(sum) / sum.z;
}

// The two lines about which a picture is most symmetric among their neighbours, and the one at right angles
// to the best, for what is symmetric about one is often so about the other; or that of a given angle. Looked
// for without details, which are never quite alike; each through where the halves are most alike.
std::vector<Line> likely_axes(const Image& light, std::optional<double> angle) {
    constexpr int angles = 60;
    constexpr std::int64_t coarser = 2;
    Image root = copied(light);  // of amplitudes: what is bright alone does not decide
    for (float& value : root.pixels) value = std::sqrt(value);
    const Image coarse = reduced_by_area(root, (root.width + 1) / coarser, (root.height + 1) / coarser);
    const glm::dvec2 middle = middle_of_light(coarse), finer(double(root.width) / double(coarse.width),
                                                             double(root.height) / double(coarse.height));
    // About the middle of the light; about what was found there, also turned by an angle's step; and along
    // it.
    constexpr Search first{8.0, 1.0}, second{2.0, 0.5}, lengthwise{24.0, 1.0};
    const double turn = angle ? 0.0 : real::radians(180.0 / angles);
    std::vector<Symmetric> found;
    for (int k = 0; k < (angle ? 1 : angles); ++k)
        found.push_back(best_about(coarse, {middle, angle.value_or(real::pi * k / angles)}, first));
    std::vector<std::size_t> peaks;
    for (std::size_t k = 0, n = found.size(); k < n; ++k)
        if (found[k].value >= found[(k + n - 1) % n].value && found[k].value >= found[(k + 1) % n].value)
            peaks.push_back(k);
    std::ranges::stable_sort(peaks, std::ranges::greater{}, [&](std::size_t k) { return found[k].value; });
    if (peaks.size() > 2) peaks.resize(2);
    if (!angle) peaks.push_back((peaks[0] + angles / 2) % angles);
    std::vector<Line> axes;
    for (const std::size_t k : peaks) {
        const Line start{finer * found[k].line.place, found[k].line.angle};
        Line axis = best_about(root, start, second, turn).line;
        axis.place = best_about(root, {axis.place, axis.angle + 0.5 * real::pi}, lengthwise).line.place;
        axes.push_back(axis);
    }
    return axes;
}

// Red, green, blue and a zero, which make one vector.
using Light = glm::vec4;

// The light on either side of an axis on a grid of lines of sight, in rows along it.
struct Folded {
    int across = 0, along = 0;  // lines
    std::vector<Light> side[2];
    std::vector<float> known[2], weight;  // 0 or 1; both, 0..2
    /// Of both sides, and what is on both: a knot on one of them counts as little as can be.
    std::vector<Light> mean, common;
};

// How far from the axis and from its middle all but a sixtieth of the light lies, px.
glm::dvec2 reach_of(const Image& light, const Line& axis) {
    std::vector<std::pair<double, double>> across, along;  // px, light
    double all = 0.0;
    for (std::int64_t y = 0; y < light.height; ++y)
        for (std::int64_t x = 0; x < light.width; ++x) {
            const glm::dvec2 from = glm::dvec2(double(x) + 0.5, double(y) + 0.5) - axis.place;
            const glm::dvec2 u = axis.across(), v = axis.along();
            const float* p = light.at(x, y);
            const double sum = double(p[0]) + double(p[1]) + double(p[2]);
            across.emplace_back(std::fabs(from.x * u.x + from.y * u.y), sum);
            along.emplace_back(std::fabs(from.x * v.x + from.y * v.y), sum);
            all += sum;
        }
    constexpr double all_but = 1.0 / 60.0, margin_px = 2.0, least_px = 4.0;
    const auto farthest = [&](auto& values) {
        std::ranges::sort(values);
        double sum = 0.0;
        for (const auto& [distance, amount] : values)
            if ((sum += amount) >= all * (1.0 - all_but)) return distance + margin_px;
        return values.back().first;
    };
    return {std::max(least_px, farthest(across)), std::max(least_px, farthest(along))};
}

Folded folded(const Image& light, const Line& axis, const glm::dvec2& reach, double step_px) {
    Folded f;
    f.across = std::max(4, int(std::ceil(reach.x / step_px)));
    f.along = 2 * std::max(4, int(std::ceil(reach.y / step_px)));
    const auto lines = std::size_t(f.across) * std::size_t(f.along);
    f.mean.assign(lines, Light(0.0f));
    f.weight.assign(lines, 0.0f);
    for (int s = 0; s < 2; ++s) {
        f.side[s].resize(lines);
        f.known[s].resize(lines);
        parallel_each(lines, 1024, [&](std::size_t i) {
            const double u = (double(i % std::size_t(f.across)) + 0.5) * step_px * (s == 0 ? 1.0 : -1.0),
                         v = (double(i / std::size_t(f.across)) + 0.5 - 0.5 * f.along) * step_px;
            const glm::dvec2 p = axis.place + u * axis.across() + v * axis.along();
            const LinearSample sample(light, float(p.x), float(p.y));
            f.side[s][i] = {sample.of(light, 0), sample.of(light, 1), sample.of(light, 2), 0.0f};
            f.known[s][i] = is_inside(light, p) ? 1.0f : 0.0f;
            f.mean[i] += f.known[s][i] * f.side[s][i];
            f.weight[i] += f.known[s][i];
        });
    }
    f.common.resize(lines);
    for (std::size_t i = 0; i < lines; ++i) {
        f.mean[i] /= std::max(1.0f, f.weight[i]);
        const Light product = f.side[0][i] * f.side[1][i];
        f.common[i] = f.weight[i] < 2.0f ? f.mean[i] : product / (f.mean[i] + 1e-9f);
    }
    return f;
}

// Where lines of sight cross rings: between which four, and how near each.
struct Crossing {
    int ring;  // the one of least radius and height
    float radius, height;
};
struct Rings {
    int radii = 0, heights = 0;
    std::vector<std::size_t> first;  // crossing of each line; and their number
    std::vector<Crossing> crossings;
    std::span<const Crossing> of(std::size_t line) const {
        return {crossings.data() + first[line], first[line + 1] - first[line]};
    }
};

// Lengths in steps between lines, which are the rings' own.
Rings rings_of(const Folded& f, double tilt) {
    // A tilted body may be longer than it looks, but no ring is wider.
    constexpr double longer = 1.3;
    const double widest = std::max(double(f.across), 0.5 * f.along);
    Rings rings;
    rings.radii = f.across + 2;
    rings.heights = 2 * int(std::ceil(longer * widest)) + 2;
    const double c = real::cos(tilt), s = real::sin(tilt), middle = 0.5 * rings.heights - 0.5;
    const int reach = int(std::ceil(std::hypot(double(rings.radii), 0.5 * rings.heights)));
    for (int j = 0; j < f.along; ++j)
        for (int i = 0; i < f.across; ++i) {
            rings.first.push_back(rings.crossings.size());
            const double u = i + 0.5, v = j + 0.5 - 0.5 * f.along;
            for (int k = -reach; k <= reach; ++k) {
                const double z = k, h = v * c + z * s, a = z * c - v * s;
                const double r = std::max(0.0, std::sqrt(u * u + a * a) - 0.5), at = h + middle;
                if (r >= rings.radii - 1 || at < 0.0 || at >= rings.heights - 1) continue;
                const int x = int(at), y = int(r);
                rings.crossings.push_back({y * rings.heights + x, float(r - y), float(at - x)});
            }
        }
    rings.first.push_back(rings.crossings.size());
    return rings;
}

Light seen_along(const Rings& rings, std::size_t line, const std::vector<Light>& light) {
    Light sum(0.0f);
    for (const Crossing& at : rings.of(line)) {
        const Light* const p = light.data() + at.ring;
        const Light* const q = p + rings.heights;
        sum += (1.0f - at.radius) * ((1.0f - at.height) * p[0] + at.height * p[1]) +
               at.radius * ((1.0f - at.height) * q[0] + at.height * q[1]);
    }
    return sum;
}

// Gives every ring the values of the lines that cross it, as they count there.
template <class Value>
std::vector<Value> given_to_rings(const Rings& rings, const std::vector<Value>& values) {
    constexpr std::int64_t chunk = 2048;  // lines
    const std::size_t cells = std::size_t(rings.radii) * std::size_t(rings.heights);
    std::vector<std::vector<Value>> parts((values.size() + chunk - 1) / chunk);
    parallel_chunks(std::int64_t(values.size()), chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<Value>& part = parts[std::size_t(begin / chunk)];
        part.assign(cells, Value(0.0f));
        for (std::int64_t line = begin; line < end; ++line)
            for (const Crossing& at : rings.of(std::size_t(line))) {
                Value* const p = part.data() + at.ring;
                Value* const q = p + rings.heights;
                const Value near = (1.0f - at.radius) * values[std::size_t(line)],
                            far = at.radius * values[std::size_t(line)];
                p[0] += (1.0f - at.height) * near;
                p[1] += at.height * near;
                q[0] += (1.0f - at.height) * far;
                q[1] += at.height * far;
            }
    });
    for (std::size_t k = 1; k < parts.size(); ++k)
        for (std::size_t i = 0; i < cells; ++i) parts[0][i] += parts[k][i];
    return std::move(parts[0]);
}

struct Solved {
    std::vector<Light> light;  // of each ring
    std::vector<Light> seen;   // along each line
};

struct Rounds {
    int plain, heavy;
};

// Rings from the picture: the multiplicative steps of expectation maximisation (Richardson 1972, Lucy 1974),
// to the power 1.5, by which they need fewer; heavy ones take three quarters of the last one along (Polyak's
// ball, in logarithms), and are worth three or four plain ones once these have found where light is. No ring
// becomes negative, nor wholly dark: one that every round dims would be below the least number in the end,
// and what is seen through such rings would have no colour. Stopped before rings explain noise.
Solved solved(const Folded& f, const std::vector<Light>& light, const Rings& rings, const Rounds& rounds) {
    float brightest = 0.0f;
    for (const Light& p : light) brightest = std::max({brightest, p.x, p.y, p.z});
    constexpr float little_share = 1e-4f;  // added to both sides of a ratio: noise of a dark sky is no ring
    constexpr float trace_share = 1e-6f;   // of the brightest line, that one keeps
    constexpr float largest_step = 4.0f;   // of the heavy, and its inverse
    const float little = little_share * brightest + 1e-12f,
                trace = trace_share * brightest / float(rings.heights);
    const std::vector<float> counted = given_to_rings(rings, f.weight);
    Solved s;
    for (const float lines : counted)
        s.light.emplace_back(lines > 0.0f ? brightest / float(rings.heights) : 0.0f);
    s.seen.resize(light.size());
    std::vector<Light> ratio(light.size()), momentum(counted.size(), Light(1.0f));
    const auto look = [&](std::size_t i) { s.seen[i] = seen_along(rings, i, s.light); };
    for (int round = 0; round < rounds.plain + rounds.heavy; ++round) {
        parallel_each(ratio.size(), 1024, [&](std::size_t i) {
            look(i);
            ratio[i] = f.weight[i] * ((light[i] + little) / (s.seen[i] + little));
        });
        const std::vector<Light> change = given_to_rings(rings, ratio);
        for (std::size_t i = 0; i < counted.size(); ++i) {
            if (!(counted[i] > 0.0f)) continue;
            const Light plain = change[i] / counted[i];
            Light step = plain * glm::sqrt(plain);
            if (round >= rounds.plain) {
                step = glm::clamp(step * momentum[i], 1.0f / largest_step, largest_step);
                momentum[i] = glm::sqrt(step) * glm::sqrt(glm::sqrt(step));
            }
            s.light[i] = glm::max(s.light[i] * step, trace);
        }
    }
    parallel_each(ratio.size(), 1024, look);
    return s;
}

// How far light is from what is seen, of all of it.
template <class Apart>
double unlike(const std::vector<Light>& light, const std::vector<Light>& seen,
              const std::vector<float>& weight, const Apart& of) {
    double sum = 0.0, all = 1e-30;
    for (std::size_t i = 0; i < seen.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            sum += double(weight[i]) * of(double(light[i][c]), double(seen[i][c]));
            all += double(weight[i]) * double(light[i][c]);
        }
    return sum / all;
}

template <class Apart>
double unlike_sides(const Folded& f, const std::vector<Light>& seen, const Apart& of) {
    return 0.5 * (unlike(f.side[0], seen, f.known[0], of) + unlike(f.side[1], seen, f.known[1], of));
}

// What rings leave at a tilt, by amplitude: of what both sides have in common, and of each of them.
struct Tried {
    double tilt_deg = 0.0, of_common = 0.0, of_sides = 0.0;
};

std::vector<Tried> tried_tilts(const Folded& f, double step_deg, std::optional<double> given_deg,
                               int rounds) {
    std::vector<Tried> tried;
    for (double tilt_deg = 0.0; tilt_deg <= steepest_deg; tilt_deg += step_deg) tried.push_back({tilt_deg});
    if (given_deg) tried = {{std::fabs(*given_deg)}};
    parallel_for(std::int64_t(tried.size()), [&](std::int64_t i, int) {
        const auto by_amplitude = [](double p, double q) { return p + q - 2.0 * std::sqrt(p * q); };
        Tried& one = tried[std::size_t(i)];
        const Solved s = solved(f, f.common, rings_of(f, real::radians(one.tilt_deg)), {rounds, 0});
        one.of_common = unlike(f.common, s.seen, f.weight, by_amplitude);
        one.of_sides = unlike_sides(f, s.seen, by_amplitude);
    });
    return tried;
}

struct LikelyAxis {
    Line axis;
    glm::dvec2 reach;  // px, across and along
    Folded folded;
};

// The axis about which rings leave least. Asymmetry counts as far as they cannot be blamed for it, and bodies
// are longer than wide more often than not.
LikelyAxis best_axis(const Image& light, const GivenAxis& given) {
    constexpr int rounds = 20;
    constexpr double asymmetry = 0.3, lines = 32.0;  // within the reach
    constexpr double tilt_step_deg = 10.0;           // enough to tell axes apart; set_tilt() looks closer
    std::optional<LikelyAxis> best;
    double least = 0.0;
    for (const Line& axis : likely_axes(light, given.angle)) {
        LikelyAxis one{axis, reach_of(light, axis), {}};
        one.folded = folded(light, axis, one.reach, std::max(one.reach.x, one.reach.y) / lines);
        const std::vector<Tried> tried = tried_tilts(one.folded, tilt_step_deg, given.tilt_deg, rounds);
        const Tried& tilt = *std::ranges::min_element(tried, {}, &Tried::of_common);
        const double left =
            std::lerp(tilt.of_common, tilt.of_sides, asymmetry) * std::sqrt(one.reach.x / one.reach.y);
        if (best && left >= least) continue;
        least = left;
        best = std::move(one);
    }
    return std::move(*best);
}

// Among those about the best that leave about as little: what rings leave falls until the body is nearly
// tilted as it is, and then grows slowly. An ellipsoid leaves as little at any that is not too steep: then it
// is one of the gentle ones.
void set_tilt(const std::vector<Tried>& tried, AxisFit& fit) {
    // Times what the best leaves, and where between the first and the last of these; axis_fit_test's painted
    // bodies hold them to it.
    constexpr double as_good = 1.4, along = 0.65;
    // Times that and some rounding: what cannot be told apart. Where that begins so gently, so gentle at
    // most.
    constexpr double about_as_good = 1.5, noise = 5e-5, gentle_deg = 15.0, gentlest_deg = 30.0;
    const auto best = std::ranges::min_element(tried, {}, &Tried::of_common);
    const auto worse = [&](const Tried& one) { return one.of_common > as_good * best->of_common; };
    const auto last = std::find_if(best, tried.end(), worse) - 1;
    const auto first = std::find_if(std::make_reverse_iterator(best), tried.rend(), worse).base();
    fit.tilt_deg = std::lerp(first->tilt_deg, last->tilt_deg, along);
    fit.tilt_from_deg = steepest_deg;
    for (const Tried& one : tried) {
        if (one.of_common > about_as_good * best->of_common + noise) continue;
        fit.tilt_from_deg = std::min(fit.tilt_from_deg, one.tilt_deg);
        fit.tilt_to_deg = one.tilt_deg;
    }
    if (!fit.tilt_is_sure() && fit.tilt_from_deg <= gentle_deg)
        fit.tilt_deg = std::min(fit.tilt_deg, gentlest_deg);
}

// The mean difference of mirrored places over that of any two (Gini 1912), from 1: a share of what is uneven,
// not of the light, of which a bright background would be most. Without details, which no nebula has alike.
double alike_sides(const Image& light, const Line& axis, const glm::dvec2& reach, double step_px) {
    constexpr double details_px = 1.5;
    const Folded f = folded(gaussian_blur(light, details_px), axis, reach, step_px);
    std::vector<double> all;
    double mirrored = 0.0, any = 1e-30;
    const auto mean = [](const Light& p) { return double(p.x + p.y + p.z) / 3.0; };
    for (std::size_t i = 0; i < f.weight.size(); ++i) {
        if (f.weight[i] < 2.0f) continue;
        for (const auto& side : f.side) all.push_back(mean(side[i]));
        mirrored += std::fabs(mean(f.side[0][i]) - mean(f.side[1][i]));
    }
    std::ranges::sort(all);
    const auto count = double(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) any += all[i] * (2.0 * double(i) + 1.0 - count) / count;
    return std::max(0.0, 1.0 - mirrored / any);
}

void set_rings(const Image& light, const LikelyAxis& best, AxisFit& fit) {
    constexpr double lines = 60.0;
    constexpr Rounds rounds{30, 120};
    const double step_px = std::max(best.reach.x, best.reach.y) / lines, step = step_px / double(light.width);
    const Line axis{best.axis.place, fit.angle};
    const Folded f = folded(light, axis, best.reach, step_px);
    const Rings rings = rings_of(f, real::radians(fit.tilt_deg));
    const Solved s = solved(f, f.mean, rings, rounds);
    const auto missing = [](double p, double q) { return std::max(0.0, p - q); };
    fit.explained = std::max(0.0, 1.0 - unlike_sides(f, s.seen, missing));
    fit.alike = alike_sides(light, axis, best.reach, step_px);
    fit.reach = 0.5 * rings.heights * step;
    fit.rings = make_image(rings.heights, rings.radii, 3);
    for (std::size_t i = 0; i < s.light.size(); ++i)
        for (int c = 0; c < 3; ++c) fit.rings.pixels[3 * i + std::size_t(c)] = s.light[i][c] / float(step);
}

}  // namespace

bool is_about_axis(const AxisFit& fit) {
    constexpr double least_explained = 0.6, least_alike = 0.6;  // tests/numbers redoes them
    return fit.explained >= least_explained && fit.alike >= least_alike;
}

std::string symmetry_words(const AxisFit& fit) {
    return fmt::format("rings about an axis explain {:.0f} % of its light, whose sides are alike by {:.0f} %",
                       100.0 * fit.explained, 100.0 * fit.alike);
}

AxisFit fit_axis(const Image& picture, const GivenAxis& given) {
    constexpr int rounds = 150;
    constexpr double tilt_step_deg = 5.0;
    const Image light = small_above_sky(picture);
    const LikelyAxis best = best_axis(light, given);
    AxisFit fit;
    fit.angle = best.axis.angle;
    if (!given.angle) fit.angle -= real::pi * std::floor(fit.angle / real::pi);
    fit.x = best.axis.place.x / double(light.width);
    fit.y = best.axis.place.y / double(light.width);
    if (given.tilt_deg)
        fit.tilt_deg = fit.tilt_from_deg = fit.tilt_to_deg = *given.tilt_deg;
    else
        set_tilt(tried_tilts(best.folded, tilt_step_deg, {}, rounds), fit);
    set_rings(light, best, fit);
    return fit;
}

AxisFit fit_axis(const Image& light, const StructureParams& params) {
    GivenAxis given{{}, params.tilt};
    if (params.axis_angle) given.angle = real::radians(*params.axis_angle);
    return fit_axis(light, given);
}

}  // namespace astrosplat
