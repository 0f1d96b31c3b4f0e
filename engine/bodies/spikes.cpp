// Every star votes for the angles at which all of its rays but one are ridges; where the picture's angle is
// known, rays are followed at it. Lengths are in texels, or px where these are many a texel.
#include "bodies/spikes.h"

#include <glm/common.hpp>

#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "detect/background.h"
#include "detect/peaks.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

// Of light as it is shown: found in eight pictures with crosses and fourteen without.
constexpr double plateau_blurs[] = {8.0, 4.0, 2.0, 1.0};  // under which plateaus have one peak
constexpr float least_peak = 0.45f, least_above = 0.25f, least_ridge = 0.012f;
constexpr int widest_core = 44;
constexpr int turns = 720;                          // angles all around that are looked at
constexpr std::size_t most_voters = 300;            // the brightest
constexpr double disc_widths = 2.2, disc_px = 3.0;  // half widths, and more: of what is a star's

// Roots of the channels, their mean: a glow of one colour alone is burnt out long before its star.
struct Shown {
    Image all, soft;  // one channel; the second a little blurred
    double texel;     // px
};

Shown shown_of(const Image& light, int times) {
    Image all = made_by_pixel(light, 1, [](const float* in, float* out) {
        *out = (std::sqrt(in[0]) + std::sqrt(in[1]) + std::sqrt(in[2])) / 3.0f;
    });
    Image soft = gaussian_blur(all, 0.8 * times);
    return {std::move(all), std::move(soft), double(times)};
}

bool is_within(const RoundStar& star, const RoundStar& other, double radius) {
    const double dx = double(star.x - other.x), dy = double(star.y - other.y);
    return dx * dx + dy * dy < radius * radius;
}

double disc_radius(const RoundStar& star, double texel) {
    return disc_widths * double(star.half_width) + disc_px * texel;
}

struct BrightPoint {
    RoundStar star;
    float peak;
};

std::optional<BrightPoint> point_at(const Shown& shown, std::int64_t column, std::int64_t row, double blur) {
    const auto x = float(column) + 0.5f, y = float(row) + 0.5f, texel = float(shown.texel);
    const float peak = *shown.soft.at(column, row);
    if (peak < least_peak) return {};
    std::array<float, widest_core + 1> ring;
    for (std::size_t r = 0; r < ring.size(); ++r)
        ring[r] = ring_at(shown.all, 0, x, y, float(r) * texel).median;
    const float sky = std::min(peak, *std::ranges::min_element(ring)), half = 0.5f * (peak + sky);
    int r = 1;
    while (r < widest_core && ring[r] > half) ++r;
    if (peak - sky < least_above || r == widest_core || double(r) < blur) return {};
    const std::int64_t reach = std::min({std::int64_t(float(r + 2) * texel), column, row,
                                         shown.all.width - 1 - column, shown.all.height - 1 - row});
    const PointLight middle = light_about(shown.all, column, row, reach, half);
    const float part = std::clamp((ring[r - 1] - half) / std::max(1e-6f, ring[r - 1] - ring[r]), 0.0f, 1.0f);
    return BrightPoint{{middle.x, middle.y, (float(r - 1) + part) * texel}, peak};
}

// The widest first, of which each keeps narrower ones away; then by how much light they have.
std::vector<RoundStar> bright_points(const Shown& shown) {
    std::vector<BrightPoint> points;
    for (const double blur : plateau_blurs) {
        const Image blurred = gaussian_blur(shown.all, blur * shown.texel);
        const auto reach = std::int64_t((blur + 1.0) * shown.texel);
        const auto find = [&](std::int64_t x, std::int64_t y) -> std::optional<BrightPoint> {
            if (*blurred.at(x, y) < 0.6f * least_peak || !is_peak(blurred, x, y, reach)) return {};
            return point_at(shown, x, y, blur);
        };
        for (const BrightPoint& point : found_by_rows(blurred, 2, find))
            if (std::ranges::none_of(points, [&](const BrightPoint& other) {
                    return is_within(point.star, other.star,
                                     1.2 * double(other.star.half_width) + 2.0 * shown.texel);
                }))
                points.push_back(point);
    }
    std::ranges::stable_sort(points, std::greater(),
                             [](const BrightPoint& p) { return p.peak * p.star.half_width; });
    std::vector<RoundStar> stars;
    for (const BrightPoint& point : points) stars.push_back(point.star);
    return stars;
}

// A ray from about the middle of a star.
struct SpikeRay {
    double angle, shift, x, y, cosine, sine;
    SpikeRay(const RoundStar& star, double turned, double shifted = 0.0)
        : angle(turned), shift(shifted), cosine(real::cos(turned)), sine(real::sin(turned)) {
        x = double(star.x) - shift * sine;
        y = double(star.y) + shift * cosine;
    }
    std::pair<float, float> at(double along, double across = 0.0) const {
        return {float(x + along * cosine - across * sine), float(y + along * sine + across * cosine)};
    }
    bool leaves(const Image& image, double along) const {
        const auto [to_x, to_y] = at(along);
        return to_x < 0.0f || to_y < 0.0f || to_x >= float(image.width) || to_y >= float(image.height);
    }
};

// How far a ray stands out of both its sides.
float ridge_at(const Shown& shown, const RoundStar& star, const SpikeRay& ray, double along) {
    const double aside = 3.0 * shown.texel + 0.25 * double(star.half_width);
    const auto value = [&](double across) {
        const auto [x, y] = ray.at(along, across);
        return bilinear(shown.soft, 0, x, y);
    };
    return value(0.0) - std::max(value(aside), value(-aside));
}

struct RayPart {
    double begin, end;  // px from the star
    int samples;        // at most 64
};

float ridge_of(const Shown& shown, const RoundStar& star, const SpikeRay& ray, const RayPart& part) {
    std::array<float, 64> values;
    for (int i = 0; i < part.samples; ++i)
        values[i] = ridge_at(shown, star, ray, part.begin + (part.end - part.begin) * i / part.samples);
    return median(std::span(values).first(std::size_t(part.samples)));
}

RayPart first_part(const RoundStar& star, double texel) {
    const double begin = 2.0 * double(star.half_width) + 3.0 * texel;
    return {begin, begin + 36.0 * texel, 36};
}

using Ridges = std::array<float, turns>;

// The second least of a cross's ridges: one may be hidden.
float cross_at(const Ridges& ridges, int arms, int first) {
    std::array<float, 6> values;
    for (int i = 0; i < arms; ++i) values[i] = ridges[(first + i * turns / arms) % turns];
    std::nth_element(values.begin(), values.begin() + 1, values.begin() + arms);
    return values[1];
}

struct Cross {
    int arms = 0, first = 0;  // first: of `turns`
    float score = 0.0f;
};

// Where votes stand out of those for other angles, and one star's are plain.
Cross cross_of(const std::vector<Ridges>& voters) {
    constexpr float least_vote = -0.02f, most_vote = 0.1f, least_signal = 8.0f, plain = 0.045f;
    Cross best;
    for (const int arms : {4, 6}) {
        std::vector<float> score(std::size_t(turns / arms), 0.0f), plainest(score.size(), 0.0f), own(score);
        for (const Ridges& ridges : voters) {
            for (std::size_t i = 0; i < own.size(); ++i) own[i] = cross_at(ridges, arms, int(i));
            if (*std::ranges::max_element(own) < least_ridge) continue;
            for (std::size_t i = 0; i < own.size(); ++i) {
                score[i] += std::clamp(own[i], least_vote, most_vote);
                plainest[i] = std::max(plainest[i], own[i]);
            }
        }
        const auto first = std::ranges::max_element(score) - score.begin();
        std::vector<float> values = score;
        const Background others = background_of(values);
        const float above = score[first] - others.level;
        if (above >= least_signal * std::max(0.001f, others.noise()) && plainest[first] >= plain &&
            above > best.score)
            best = {arms, int(first), above};
    }
    return best;
}

// The last place that a ray is a ridge at, before it is none for some way. Where it is long, and so faint, it
// is looked at over more of its length.
double end_of(const Shown& shown, const RoundStar& star, const SpikeRay& ray) {
    constexpr float faintest = 0.006f;
    constexpr std::size_t least_smooth = 15, most_smooth = 63;
    const double texel = shown.texel, begin = 1.2 * double(star.half_width) + texel;
    std::vector<float> ridge;
    double last = begin;
    for (double r = begin; !ray.leaves(shown.all, r); r += texel) {
        ridge.push_back(ridge_at(shown, star, ray, r));
        std::array<float, most_smooth> values;
        const std::size_t count = std::min({least_smooth + ridge.size() / 10, ridge.size(), most_smooth});
        std::copy_n(ridge.end() - std::ptrdiff_t(count), count, values.begin());
        const double middle = r - 0.5 * double(count) * texel;
        if (median(std::span(values).first(count)) >= faintest) last = std::max(last, middle);
        if (middle - last > 12.0 * texel + 0.2 * (last - begin)) break;
    }
    return last;
}

// The highest ridge about a ray. Stars are not found as exactly as their spikes are thin.
SpikeRay turned(const Shown& shown, const RoundStar& star, const SpikeRay& ray, double shift_step,
                double angle_step, const RayPart& part) {
    SpikeRay best = ray;
    float highest = ridge_of(shown, star, ray, part);
    for (int s = -3; s <= 3; ++s)
        for (int i = -8; i <= 8; ++i) {
            const SpikeRay other(star, ray.angle + i * angle_step, ray.shift + s * shift_step);
            const float ridge = ridge_of(shown, star, other, part);
            if (ridge > highest) highest = ridge, best = other;
        }
    return best;
}

struct Arm {
    SpikeRay ray;
    double end;  // px from the star
};

std::optional<Arm> arm_at(const Shown& shown, const RoundStar& star, double angle) {
    const double texel = shown.texel, core = double(star.half_width);
    float near = -1.0f;
    for (int k = -2; k <= 2; ++k)
        near = std::max(near, ridge_of(shown, star, SpikeRay(star, angle + k * 2.0 * real::pi / turns),
                                       first_part(star, texel)));
    if (near < 0.3f * least_ridge) return {};
    RayPart part{2.0 * core, 2.0 * core + 50.0 * texel, 50};
    Arm arm{turned(shown, star, SpikeRay(star, angle), std::max(0.4 * texel, 0.07 * core),
                   real::radians(0.125), part),
            0.0};
    arm.end = end_of(shown, star, arm.ray);
    for (int i = 0; i < 3 && arm.end > part.end + 20.0 * texel; ++i) {
        part = {part.begin, arm.end, 64};
        const SpikeRay ray =
            turned(shown, star, arm.ray, 0.4 * texel, 0.4 * texel / (part.end - part.begin), part);
        if (const double end = end_of(shown, star, ray); end >= arm.end) arm = {ray, end};
    }
    const RayPart first{1.5 * core, 1.5 * core + 30.0 * texel, 30};
    if (arm.end - core < 12.0 * texel || ridge_of(shown, star, arm.ray, first) < least_ridge) return {};
    return arm;
}

struct CrossedStar {
    RoundStar star;
    std::vector<Arm> arms;
};

// To where the arms meet: least squares of its distances from them.
void move_to_middle(CrossedStar& cross) {
    double xx = 0.0, xy = 0.0, yy = 0.0, x = 0.0, y = 0.0;
    for (const auto& [ray, end] : cross.arms) {
        xx += ray.sine * ray.sine;
        xy -= ray.sine * ray.cosine;
        yy += ray.cosine * ray.cosine;
        x -= ray.shift * ray.sine;
        y += ray.shift * ray.cosine;
    }
    const double determinant = xx * yy - xy * xy;
    if (determinant < 0.5) return;  // they are one line
    cross.star.x += float((yy * x - xy * y) / determinant);
    cross.star.y += float((xx * y - xy * x) / determinant);
}

// All arms are there but one and those that the picture's edge is too near for.
std::optional<CrossedStar> crossed(const Shown& shown, const RoundStar& star, const Cross& cross) {
    CrossedStar found{star, {}};
    int missing = 0;
    for (int i = 0; i < cross.arms; ++i) {
        const double angle = 2.0 * real::pi * (double(cross.first) / turns + double(i) / cross.arms);
        if (const std::optional<Arm> arm = arm_at(shown, star, angle))
            found.arms.push_back(*arm);
        else if (!SpikeRay(star, angle).leaves(shown.all, first_part(star, shown.texel).end) && ++missing > 1)
            return {};
    }
    if (found.arms.size() < 2) return {};
    move_to_middle(found);
    return found;
}

// What is taken out of light, and whose it is.
struct Taking {
    Image& light;
    Image taken = make_image(light.width, light.height, 3);
    Buffer<std::int32_t> star = Buffer<std::int32_t>(std::size_t(light.width * light.height), -1);

    // A channel that is burnt out does not tell how much of it a star is before a glow: most, it is supposed.
    void take(std::int64_t x, std::int64_t y, glm::vec3 more, std::int32_t of) {
        constexpr float burnt_out = 0.8f, surely = 0.95f, white = 0.6f;
        more = glm::max(more, 0.0f);
        const float most = std::max({more.x, more.y, more.z});
        float* const pixel = light.at(x, y);
        for (int c = 0; c < 3; ++c) {
            const float full = std::clamp((pixel[c] - burnt_out) / (surely - burnt_out), 0.0f, 1.0f);
            const float own = std::max(more[c], full * white * std::min(most, pixel[c]));
            taken.at(x, y)[c] += own;
            pixel[c] -= own;
        }
        star[std::size_t(y * light.width + x)] = of;
    }
};

glm::vec3 color_at(const Image& light, std::pair<float, float> at) {
    const LinearSample place(light, at.first, at.second);
    return {place.of(light, 0), place.of(light, 1), place.of(light, 2)};
}

// What stands out of the line between both sides, where it does so along the ray: the cloud's grain stays.
void take_arm(const CrossedStar& of, const Arm& arm, const Image& before, double texel, std::int32_t number,
              Taking& taking) {
    constexpr double reach = 1.5, near_side = 1.6, far_side = 2.3;  // half widths of the ray
    constexpr int mean_px = 5;
    const SpikeRay& ray = arm.ray;
    const double core = double(of.star.half_width), end = arm.end + 6.0 * texel, pad = 6.0 * texel + core;
    const auto [to_x, to_y] = ray.at(end);
    const auto take = [&](std::int64_t i, std::int64_t j) {
        const double dx = double(i) + 0.5 - ray.x, dy = double(j) + 0.5 - ray.y;
        const double along = dx * ray.cosine + dy * ray.sine, across = dy * ray.cosine - dx * ray.sine;
        if (along < 0.5 * core || along >= end || std::fabs(across) >= pad) return;
        const double half = texel * (2.2 + 1.5 * real::exp(-along / (3.0 * core))) +
                            0.12 * core * real::exp(-along / (20.0 * core));
        if (std::fabs(across) >= reach * half) return;
        const auto side = [&](double sign) {
            return 0.5f * (color_at(taking.light, ray.at(along, sign * near_side * half)) +
                           color_at(taking.light, ray.at(along, sign * far_side * half)));
        };
        const auto t = float(std::clamp(0.5 + 0.5 * across / (near_side * half), 0.0, 1.0));
        const glm::vec3 between = (1.0f - t) * side(-1.0) + t * side(1.0);
        glm::vec3 mean(0.0f);
        for (int n = -mean_px; n <= mean_px; ++n)
            mean += color_at(before, ray.at(along + n * texel, across)) / (2.0f * mean_px + 1.0f);
        const auto weight = float(std::clamp((reach - std::fabs(across) / half) / 0.5, 0.0, 1.0) *
                                  std::clamp((end - along) / (8.0 * texel), 0.0, 1.0));
        const float* const here = taking.light.at(i, j);
        const glm::vec3 most = 1.5f * glm::max(mean - between, 0.0f);
        taking.take(i, j, weight * glm::min(glm::vec3(here[0], here[1], here[2]) - between, most), number);
    };
    for_each_between(before, std::int64_t(std::min(ray.x, double(to_x)) - pad),
                     std::int64_t(std::min(ray.y, double(to_y)) - pad),
                     std::int64_t(std::max(ray.x, double(to_x)) + pad),
                     std::int64_t(std::max(ray.y, double(to_y)) + pad), take);
}

// Numbers of pixels that are holes; -1: not one of them.
struct Holes {
    std::int64_t width, height;
    Buffer<std::int32_t> numbers = Buffer<std::int32_t>(std::size_t(width * height), -1);
    std::int32_t& at(std::int64_t x, std::int64_t y) { return numbers[std::size_t(y * width + x)]; }
};

constexpr double fill_blurs[] = {3.0, 6.0, 12.0, 24.0};  // texels

// Light of a region as it is around holes, of four channels: blurs of what is known, of the narrowest that
// knows enough.
Image filled_from_around(const Image& light, Holes& holes, const Region& region, double texel) {
    constexpr float enough = 0.15f;  // of a blur's weight
    Image known = unfilled_image(region.width, region.height, 4);
    for_each_pixel(known, [&](std::int64_t x, std::int64_t y) {
        const float share = holes.at(region.x + x, region.y + y) < 0 ? 1.0f : 0.0f;
        const float* const from = light.at(region.x + x, region.y + y);
        float* const to = known.at(x, y);
        for (int c = 0; c < 3; ++c) to[c] = share * from[c];
        to[3] = share;
    });
    Image filled = make_image(region.width, region.height, 4);
    for (const double blur : fill_blurs) {
        const Image wide = gaussian_blur(known, blur * texel);
        for_each_pixel(filled, [&](std::int64_t x, std::int64_t y) {
            const float* const from = wide.at(x, y);
            float* const to = filled.at(x, y);
            const float share = std::min(1.0f, from[3] / enough) * (1.0f - to[3]);
            for (int c = 0; c < 3; ++c) to[c] += share * from[c] / std::max(from[3], 1e-6f);
            to[3] += share;
        });
    }
    change_pixels(filled, [](float* p) {
        for (int c = 0; c < 3; ++c) p[c] /= std::max(p[3], 1e-6f);
    });
    return filled;
}

// The same at the holes, by their numbers: square by square, with all around that their blurs reach, begun
// where the blurs' halvings begin.
std::vector<glm::vec3> light_around(const Image& light, Holes& holes, std::int64_t count, double texel) {
    constexpr std::int64_t side = 512, halvings = 64;              // px; of which no blur halves more often
    const auto reach = std::int64_t(4.0 * fill_blurs[3] * texel);  // of a Gaussian's weights, and of halvings
    const std::int64_t about = (reach + 2 * halvings) / halvings * halvings;
    const std::int64_t columns = (holes.width + side - 1) / side, rows = (holes.height + side - 1) / side;
    std::vector<glm::vec3> around(std::size_t(count), glm::vec3(0.0f));
    parallel_for(columns * rows, [&](std::int64_t i, int) {
        const std::int64_t x = i % columns * side, y = i / columns * side;
        std::optional<Image> filled;
        const std::int64_t left = std::max<std::int64_t>(0, x - about),
                           top = std::max<std::int64_t>(0, y - about);
        for_each_between(holes, x, y, x + side - 1, y + side - 1, [&](std::int64_t at_x, std::int64_t at_y) {
            const std::int32_t number = holes.at(at_x, at_y);
            if (number < 0) return;
            if (!filled)
                filled = filled_from_around(light, holes,
                                            {left, top, std::min(x + side + about, holes.width) - left,
                                             std::min(y + side + about, holes.height) - top},
                                            texel);
            const float* const value = filled->at(at_x - left, at_y - top);
            around[std::size_t(number)] = {value[0], value[1], value[2]};
        });
    });
    return around;
}

// What of stars is brighter than what lies around.
void take_discs(std::span<const RoundStar> stars, double texel, Taking& taking) {
    Holes holes{taking.light.width, taking.light.height};
    std::int32_t count = 0;
    const auto visit_discs = [&](const auto& visit) {
        for (std::size_t i = 0; i < stars.size(); ++i)
            for_each_within(holes, double(stars[i].x), double(stars[i].y), disc_radius(stars[i], texel),
                            [&](std::int64_t x, std::int64_t y, double, double) { visit(x, y, i); });
    };
    visit_discs([&](std::int64_t x, std::int64_t y, std::size_t) {
        if (holes.at(x, y) < 0) holes.at(x, y) = count++;
    });
    const std::vector<glm::vec3> around = light_around(taking.light, holes, count, texel);
    visit_discs([&](std::int64_t x, std::int64_t y, std::size_t i) {
        const std::int32_t number = std::exchange(holes.at(x, y), -1);
        if (number < 0) return;
        const float* const here = taking.light.at(x, y);
        taking.take(x, y, glm::vec3(here[0], here[1], here[2]) - around[std::size_t(number)],
                    std::int32_t(i));
    });
}

}  // namespace

std::vector<SpikeLight> by_squares(int times, const Image& taken, const Buffer<std::int32_t>& star,
                                   Image& light) {
    constexpr float least = 0.003f, least_share = 0.03f;  // of white, and of what is left there
    const std::int64_t rows = (light.height + times - 1) / times;
    std::vector<std::vector<SpikeLight>> by_rows(static_cast<std::size_t>(rows));
    parallel_for(rows, [&](std::int64_t row, int) {
        std::vector<SpikeLight>& found = by_rows[std::size_t(row)];
        for (std::int64_t column = 0; column * times < light.width; ++column) {
            SpikeLight here{column, row, -1};
            float left = 0.0f;
            const auto visit = [&](const auto& use) {
                for_each_between(light, column * times, row * times, (column + 1) * times - 1,
                                 (row + 1) * times - 1, [&](std::int64_t x, std::int64_t y) {
                                     use(taken.at(x, y), light.at(x, y),
                                         star[std::size_t(y * light.width + x)]);
                                 });
            };
            visit([&](const float* own, const float* rest, std::int32_t of) {
                here.star = std::max(here.star, of);
                here.light += glm::max(glm::vec3(own[0], own[1], own[2]), 0.0f) / float(times * times);
                left = std::max({left, rest[0], rest[1], rest[2]});
            });
            if (here.star < 0) continue;
            if (std::max({here.light.x, here.light.y, here.light.z}) >= std::max(least, least_share * left))
                found.push_back(here);
            else
                visit([](const float* own, float* rest, std::int32_t) {
                    for (int c = 0; c < 3; ++c) rest[c] += std::max(0.0f, own[c]);
                });
        }
    });
    std::vector<SpikeLight> found;
    for (const std::vector<SpikeLight>& row : by_rows) found.insert(found.end(), row.begin(), row.end());
    return found;
}

Spikes take_spikes(Image& light, int times, const Image* before) {
    Spikes spikes;
    Shown shown = shown_of(light, times);
    const std::vector<RoundStar> points = bright_points(shown);
    std::vector<Ridges> voters(std::min(points.size(), most_voters));
    parallel_each(voters.size(), 1, [&](std::size_t i) {
        for (int t = 0; t < turns; ++t)
            voters[i][t] = ridge_of(shown, points[i], SpikeRay(points[i], 2.0 * real::pi * t / turns),
                                    first_part(points[i], shown.texel));
    });
    const Cross cross = cross_of(voters);
    if (cross.arms == 0) return spikes;
    spikes.arms = cross.arms;
    spikes.angle = 2.0 * real::pi * cross.first / turns;
    std::vector<std::optional<CrossedStar>> found(points.size());
    parallel_each(points.size(), 1, [&](std::size_t i) { found[i] = crossed(shown, points[i], cross); });
    shown = {};
    const Image copy = before ? Image() : copied(light);
    Taking taking{light};
    for (const std::optional<CrossedStar>& each : found) {
        if (!each || std::ranges::any_of(spikes.stars, [&](const RoundStar& other) {
                return is_within(each->star, other, disc_radius(other, double(times)));
            }))
            continue;
        for (const Arm& arm : each->arms)
            take_arm(*each, arm, before ? *before : copy, double(times), std::int32_t(spikes.stars.size()),
                     taking);
        spikes.stars.push_back(each->star);
    }
    take_discs(spikes.stars, double(times), taking);
    constexpr float core_share =
        0.5f;  // of half widths: the core of a star is round, its halo lies in the plane
    std::vector<RoundStar> cores = spikes.stars;
    for (RoundStar& core : cores) core.half_width *= core_share;
    spikes.gaussians = take_bright_stars(taking.taken, cores);
    spikes.light = by_squares(times, taking.taken, taking.star, light);
    return spikes;
}

}  // namespace astrosplat
