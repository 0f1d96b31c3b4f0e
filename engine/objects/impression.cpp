#include "objects/impression.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <numeric>
#include <tuple>

#include "bodies/stars.h"
#include "core/real.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

constexpr std::int64_t small_width = 256;  // px, of the copy that is measured
constexpr std::int64_t least_side_px = 16;
constexpr double small_things = 0.012;  // of the width: what stands out of a blur so wide is small
constexpr double edge_share = 0.06;     // of the width, that counts as the picture's edge
constexpr double nothing = 1e-12;

constexpr double rim_share = 0.02;  // of the width
constexpr float dark_rim = 0.001f;  // at an angle it shows several times as bright

struct Pixel {
    double radius = 0.0, light = 0.0;  // px from the middle; above the sky
    glm::dvec3 color{0.0};             // the same of each channel
    double red = 0.0, blue = 0.0;      // with the sky
    bool edge = false;
};

Image of_width(const Image& image, std::int64_t width) {
    const std::int64_t height = std::max<std::int64_t>(1, image.height * width / image.width);
    return resampled(image, map_to_width(image, width, height), width, height, 0.5);
}

// A copy with stars, of twice the width, and what is left of it without them.
struct Copies {
    Image whole, without_stars;
};
Copies copies_of(const Image& light) {
    Image whole = light.width > 2 * small_width ? of_width(light, 2 * small_width) : light;
    Image rest = copied(whole);
    take_stars(rest);
    return {std::move(whole), std::move(rest)};
}

struct Place {
    std::int64_t x = 0, y = 0;
};
Place brightest_place(const Image& channel) {
    const Image smooth = gaussian_blur(channel, 0.02 * double(channel.width));
    const auto top = std::ranges::max_element(smooth.pixels) - smooth.pixels.begin();
    return {top % channel.width, top / channel.width};
}

double sky_of(const Image& channel) {
    return percentile({channel.pixels.begin(), channel.pixels.end()}, 0.1);
}

Image above_sky(Image channel) {
    const auto sky = static_cast<float>(sky_of(channel));
    for (float& value : channel.pixels) value = std::max(0.0f, value - sky);
    return channel;
}

double sum_of(const Image& channel) {
    double sum = 0.0;
    for (const float value : channel.pixels) sum += double(value);
    return sum;
}

// Calls visit(x, y) for every pixel, row by row: sums keep their order.
template <class Visit>
void for_each_in_order(const Image& image, const Visit& visit) {
    for_each_between(image, 0, 0, image.width - 1, image.height - 1, visit);
}

std::vector<Pixel> by_radius(const Image& light, const Image& above, Place middle) {
    const glm::dvec3 sky(sky_of(channel_of(light, 0)), sky_of(channel_of(light, 1)),
                         sky_of(channel_of(light, 2)));
    const auto edge = static_cast<std::int64_t>(edge_share * double(light.width));
    std::vector<Pixel> pixels;
    for_each_in_order(light, [&](std::int64_t x, std::int64_t y) {
        const float* const p = light.at(x, y);
        const bool at_edge = x < edge || y < edge || x >= light.width - edge || y >= light.height - edge;
        pixels.push_back({std::hypot(double(x - middle.x), double(y - middle.y)), double(*above.at(x, y)),
                          glm::max(glm::dvec3(p[0], p[1], p[2]) - sky, 0.0), double(p[0]), double(p[2]),
                          at_edge});
    });
    std::ranges::stable_sort(pixels, {}, &Pixel::radius);
    return pixels;
}

// The radius within which a share of the light is.
double radius_of(const std::vector<Pixel>& pixels, double share) {
    double all = 0.0, sum = 0.0;
    for (const Pixel& p : pixels) all += p.light;
    for (const Pixel& p : pixels)
        if ((sum += p.light) >= share * all) return p.radius;
    return 0.0;
}

struct Part {
    double light = 0.0, redness = 1.0;  // mean; red over blue
    glm::dvec3 color{0.0};
};
template <class Wanted>
Part part_of(const std::vector<Pixel>& pixels, Wanted wanted) {
    Pixel sum;
    double count = 0.0;
    for (const Pixel& p : pixels) {
        if (!wanted(p)) continue;
        sum.light += p.light;
        sum.color += p.color;
        sum.red += p.red;
        sum.blue += p.blue;
        count += 1.0;
    }
    count = std::max(1.0, count);
    return {sum.light / count, sum.red / std::max(nothing, sum.blue), sum.color / count};
}
Part ring_of(const std::vector<Pixel>& pixels, double from, double to) {
    return part_of(pixels, [=](const Pixel& p) { return p.radius >= from && p.radius <= to; });
}

bool is_grey(const std::vector<Pixel>& pixels) {
    return std::ranges::all_of(pixels, [](const Pixel& p) {
        return std::fabs(p.red - p.blue) <= 1e-4 + 0.01 * std::max(p.red, p.blue);
    });
}

// How far the light around the middle differs from that on the opposite side of it: 0 alike .. 1.
double difference_of_sides(const Image& above, Place middle, double half) {
    const Image smooth = gaussian_blur(above, 2.0);
    double difference = 0.0, sum = 0.0;
    for_each_in_order(above, [&](std::int64_t x, std::int64_t y) {
        const std::int64_t u = 2 * middle.x - x, v = 2 * middle.y - y;
        const double radius = std::hypot(double(x - middle.x), double(y - middle.y));
        const bool seen = u >= 0 && v >= 0 && u < above.width && v < above.height;
        if (!seen || radius < 0.35 * half || radius > 1.5 * half) return;
        const auto here = double(*smooth.at(x, y)), there = double(*smooth.at(u, v));
        difference += std::fabs(here - there);
        sum += here + there;
    });
    return sum > 0.0 ? difference / sum : 1.0;
}

double share_in_small_things(const Image& above) {
    const Image wide = gaussian_blur(above, small_things * double(above.width));
    double small = 0.0;
    for (std::size_t i = 0; i < above.pixels.size(); ++i)
        small += double(std::max(0.0f, above.pixels[i] - wide.pixels[i]));
    return small / std::max(nothing, sum_of(above));
}

// Light of stars lies near the colours of glowing bodies, where red grows as blue falls; glowing gas is
// redder, or pink or green. Behind dust, stars are redder and have hardly any blue.
bool of_stars(const glm::dvec3& color) {
    const double red = color.r / std::max(nothing, color.g), blue = color.b / std::max(nothing, color.g);
    const double reddest = blue > 0.9 ? 1.66 : 2.1, pink = red * blue;
    return red >= 0.58 && red <= reddest && pink >= 0.42 && pink <= 2.3;
}

glm::dvec2 chroma_of(const glm::dvec3& color) {
    const double floor = 0.02 * (color.r + color.g + color.b) + nothing;
    return {real::log((color.r + floor) / (color.g + floor)),
            real::log((color.b + floor) / (color.g + floor))};
}

void measure_colors(const std::vector<Pixel>& pixels, double half, Impression& seen) {
    const glm::dvec2 mean = chroma_of(ring_of(pixels, 0.0, 1.6 * half).color);
    seen.red = mean.x;
    seen.blue = mean.y;
    double gas = 0.0, away = 0.0, sum = 0.0;
    for (const Pixel& p : pixels) {
        const glm::dvec2 from_mean = chroma_of(p.color) - mean;
        if (!of_stars(p.color)) gas += p.light;
        away += p.light * std::hypot(from_mean.x, from_mean.y);
        sum += p.light;
    }
    seen.gas = gas / std::max(nothing, sum);
    seen.colours = away / std::max(nothing, sum);
}

double detail_of(const Image& above) {
    const Image smooth = gaussian_blur(above, 3.0);
    double away = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < above.pixels.size(); ++i) {
        away += double(std::fabs(above.pixels[i] - smooth.pixels[i]));
        sum += double(smooth.pixels[i]);
    }
    return away / std::max(nothing, sum);
}

// Axis ratio by second moments about the middle.
double roundness_of(const Image& above, Place middle, double reach) {
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for_each_within(above, double(middle.x) + 0.5, double(middle.y) + 0.5, reach,
                    [&](std::int64_t x, std::int64_t y, double dx, double dy) {
                        const auto w = double(*above.at(x, y));
                        xx += w * dx * dx;
                        xy += w * dx * dy;
                        yy += w * dy * dy;
                    });
    const double mean = 0.5 * (xx + yy), turn = std::hypot(0.5 * (xx - yy), xy);
    return mean > 0.0 ? std::sqrt(std::max(0.0, mean - turn) / (mean + turn)) : 1.0;
}

double dark_share(const Image& above) {
    const auto bound =
        static_cast<float>(0.03 * percentile({above.pixels.begin(), above.pixels.end()}, 0.99));
    const auto dark = std::ranges::count_if(above.pixels, [&](float value) { return value < bound; });
    return double(dark) / double(above.pixels.size());
}

Place centre_of(const Image& above) {
    double x_sum = 0.0, y_sum = 0.0, sum = nothing;
    for_each_in_order(above, [&](std::int64_t x, std::int64_t y) {
        const auto w = double(*above.at(x, y));
        x_sum += w * double(x);
        y_sum += w * double(y);
        sum += w;
    });
    return {std::llround(x_sum / sum), std::llround(y_sum / sum)};
}

}  // namespace

Impression impression_of(const Image& light) {
    if (light.width < least_side_px || light.height < least_side_px) return {};
    const Copies copies = copies_of(light);
    const Image small = gaussian_blur(of_width(copies.without_stars, small_width), 1.0);
    const Image above = above_sky(brightest_channel(small));
    const Place middle = brightest_place(above);
    const std::vector<Pixel> pixels = by_radius(small, above, middle);
    Impression seen;
    const Part all = part_of(pixels, [](const Pixel&) { return true; });
    seen.lit = all.light > 0.0;
    if (!seen.lit) return seen;
    seen.middle = {(double(middle.x) + 0.5) / double(small.width),
                   (double(middle.y) + 0.5) / double(small.height)};
    const double half = radius_of(pixels, 0.5);
    const Part core = ring_of(pixels, 0.0, 0.35 * half);
    seen.grey = is_grey(pixels);
    seen.peak = real::log(core.light / std::max(nothing, ring_of(pixels, 0.8 * half, 1.2 * half).light));
    seen.redness =
        real::log(core.redness / std::max(nothing, ring_of(pixels, 0.9 * half, 1.6 * half).redness));
    seen.edge = part_of(pixels, [](const Pixel& p) { return p.edge; }).light / all.light;
    seen.sides = difference_of_sides(above, middle, half);
    const Image whole = above_sky(brightest_channel(copies.whole));
    seen.small = share_in_small_things(whole);
    Image stars = brightest_channel(copies.whole);
    const Image rest = brightest_channel(copies.without_stars);
    for (std::size_t i = 0; i < stars.pixels.size(); ++i)
        stars.pixels[i] = std::max(0.0f, stars.pixels[i] - rest.pixels[i]);
    seen.stars = sum_of(stars) / std::max(nothing, sum_of(whole));
    measure_colors(pixels, half, seen);
    seen.size = half / double(small.width);
    seen.detail = detail_of(above);
    seen.roundness = roundness_of(above, middle, 1.5 * half);
    seen.dark = dark_share(above);
    const Place centre = centre_of(above);
    seen.balance = difference_of_sides(above, centre, radius_of(by_radius(small, above, centre), 0.5));
    return seen;
}

namespace {

constexpr int measure_count = 17;
using Measures = std::array<double, measure_count>;

// In the order of the sayings below.
Measures measures_of(const Impression& s) {
    Measures measures{s.peak,
                      s.redness,
                      std::sqrt(s.edge),
                      s.sides,
                      s.small,
                      s.stars,
                      s.red,
                      s.blue,
                      s.colours,
                      s.gas,
                      s.size,
                      s.detail,
                      s.roundness,
                      s.dark,
                      s.balance,
                      std::max(0.0, s.gas - 0.35),
                      std::max(0.0, s.sides - 0.35)};
    for (double& m : measures) m = std::clamp(m, -4.0, 4.0);
    return measures;
}

struct Weights {
    SkyObject object;
    Measures measures;
    double bias;
};
using Model = std::array<Weights, 6>;

// Multinomial logistic regression on 572 labelled pictures: 533 of a
// planetarium's catalogue, 23 of telescopes', which weigh four times as much, and 16 painted ones, which
// weigh twice. Each tenth of the real ones judged by a model made of the others: 81 % right in colour, 75 %
// in grey; of those of which it is sure to 90 % or more, 95 %. Remnants count as nebulae.
constexpr Model in_colour{{{SkyObject::galaxy,
                            {0.54, 1.03, 0.78, -2.8, -1.48, -2.26, 0.65, 0.55, -0.16, -2.12, 5.96, 0.84,
                             -6.06, -0.92, 0.09, -2.47, -0.39},
                            7.46},
                           {SkyObject::elliptical,
                            {1.41, 0.16, 1.03, -2.41, -4.11, -2.89, -0.9, -0.27, -4.33, -2.24, -4.53, -2.95,
                             0.35, 4.72, 1.86, -0.78, 1.61},
                            -3.06},
                           {SkyObject::nebula,
                            {-0.13, -0.68, 0.2, 2.39, 0.48, 0.48, 0.75, 0.7, 2.22, 4.65, 3.41, -7.5, -1.49,
                             -4.17, 1.94, -3.01, -2.02},
                            3.46},
                           {SkyObject::planetary,
                            {-0.87, -0.29, 1.62, 2.7, -3.72, -3.45, -0.46, 0.04, 5.82, 0.27, -5.31, 2.59,
                             0.75, 3.29, -3.12, 3.4, 3.08},
                            -2.69},
                           {SkyObject::field,
                            {-0.48, -0.06, -2.7, 1.11, 2.85, 3.86, 0.45, 1.09, 0.73, 1.07, 2.26, 6.09, 1.97,
                             -3.47, 1.08, 3.56, 0.98},
                            -2.89},
                           {SkyObject::cluster,
                            {-0.46, -0.16, -0.92, -0.98, 5.98, 4.26, -0.49, -2.1, -4.28, -1.63, -1.79, 0.94,
                             4.48, 0.56, -1.86, -0.69, -3.26},
                            -2.27}}};
constexpr Model in_grey{
    {{SkyObject::galaxy,
      {0.21, 0, 0.65, -4.58, -1.51, -1.02, 0, 0, 0, 0, 5.31, -0.16, -4.49, -0.42, 0.65, 0, 2.27},
      5.92},
     {SkyObject::elliptical,
      {0.87, 0, 1.42, -3.09, -4.63, -2.22, 0, 0, 0, 0, -4.61, -4.03, 0.44, 5.93, 2, 0, 2.8},
      -4.93},
     {SkyObject::nebula,
      {0.08, 0, -0.01, 5.07, 1.52, -0.17, 0, 0, 0, 0, -1.69, -6.94, -3.81, -5.45, 1.87, 0, -3.58},
      7.26},
     {SkyObject::planetary,
      {-0.32, 0, 1.5, 4.43, -3.94, -2.82, 0, 0, 0, 0, -1.97, 3.66, 0.11, 1.91, -2.87, 0, -0.85},
      -0.27},
     {SkyObject::field,
      {-0.29, 0, -2.95, 0.55, 2.7, 2.69, 0, 0, 0, 0, 3.87, 4.99, 1.71, -4.06, 1.97, 0, 1.19},
      -1.92},
     {SkyObject::cluster,
      {-0.55, 0, -0.61, -2.38, 5.87, 3.54, 0, 0, 0, 0, -0.91, 2.48, 6.03, 2.08, -3.63, 0, -1.83},
      -6.06}}};

// In words, a measure above or below the mean of these pictures.
struct Saying {
    double mean;
    const char *above, *below;
};
constexpr std::array<Saying, measure_count> sayings{
    {{1.37, "its light gathers in the middle", "its light does not gather in a middle"},
     {0.04, "its middle is redder than what is around it", "its middle is no redder than what is around it"},
     {0.30, "its light goes on to the picture's edges", "it stands on a dark sky"},
     {0.38, "it differs from side to side", "it is alike on either side"},
     {0.27, "much of its light is in small things", "little of its light is in small things"},
     {0.17, "it is full of stars", "hardly any of its light is in stars"},
     {0.21, "its light is red", "its light is not red"},
     {0.10, "its light is blue", "its light is not blue"},
     {0.36, "its colours change from place to place", "its colours are the same all over"},
     {0.28, "it has colours of gas", "it has the colours of stars"},
     {0.17, "it is large in the picture", "it is small in the picture"},
     {0.25, "much of its light is in fine detail", "most of its light is spread out"},
     {0.75, "it is round", "it is long"},
     {0.76, "most of the picture is dark", "little of the picture is dark"},
     {0.39, "its halves differ", "its halves are alike"},
     {0.12, "it has colours of gas", "it has the colours of stars"},
     {0.14, "it differs from side to side", "it is alike on either side"}}};

// The two measures that part the likeliest object most from the one after it.
std::string why_of(const Weights& likeliest, const Weights& next, const Measures& measures) {
    std::array<std::pair<double, int>, measure_count> speaking{};
    for (int i = 0; i < measure_count; ++i)
        speaking[i] = {(likeliest.measures[i] - next.measures[i]) * (measures[i] - sayings[i].mean), i};
    std::ranges::sort(speaking, std::ranges::greater());
    const auto say = [&](int i) -> std::string_view {
        return measures[i] > sayings[i].mean ? sayings[i].above : sayings[i].below;
    };
    const std::string_view first = say(speaking[0].second);
    const auto other = std::ranges::find_if(speaking, [&](const auto& s) { return say(s.second) != first; });
    return fmt::format("{}, and {}", first, say(other->second));
}

// Comets, and stars alone: smooth light that gathers, with no like on its other side. No picture that the
// model was made of has it, but for the comet itself; tests/numbers redoes it on painted ones.
bool is_thin(const Impression& s) {
    return s.small < 0.035 && s.detail < 0.06 && s.sides > 0.2 && s.peak > 1.2;
}

// In many small things, here and there: of 58 such pictures 44 are of fields.
bool is_strewn(const Impression& s) { return s.sides > 0.45 && s.small > 0.52; }

constexpr double field_where_strewn = 0.75;
constexpr double thin_where_it_seems_so = 0.8, thin_otherwise = 0.01;
constexpr double remnants = 0.1;  // of what seems to be gas

}  // namespace

Likeness likeness_of(const Impression& seen) {
    Likeness likeness;
    const auto share = [&](SkyObject object) -> double& {
        return likeness.share[static_cast<std::size_t>(object)];
    };
    if (!seen.lit) {
        share(SkyObject::nebula) = 0.5;  // what is least wrong: a sheet
        likeness.why = "it is too small, or too even, to tell";
        return likeness;
    }
    const Model& model = seen.grey ? in_grey : in_colour;
    const Measures measures = measures_of(seen);
    std::array<std::pair<double, const Weights*>, std::tuple_size_v<Model>> scores{};
    for (std::size_t k = 0; k < model.size(); ++k)
        scores[k] = {
            std::inner_product(measures.begin(), measures.end(), model[k].measures.begin(), model[k].bias),
            &model[k]};
    std::ranges::sort(scores, std::ranges::greater());
    double sum = 0.0;
    for (const auto& score : scores) sum += real::exp(score.first - scores[0].first);
    const double thin = is_thin(seen) ? thin_where_it_seems_so : thin_otherwise;
    for (const auto& score : scores)
        share(score.second->object) = (1.0 - thin) * real::exp(score.first - scores[0].first) / sum;
    for (const SkyObject gas : {SkyObject::nebula, SkyObject::planetary}) {
        share(SkyObject::remnant) += remnants * share(gas);
        share(gas) *= 1.0 - remnants;
    }
    share(SkyObject::thin) = thin;
    if (is_strewn(seen) && share(SkyObject::field) < field_where_strewn) {
        const double others = (1.0 - field_where_strewn) / (1.0 - share(SkyObject::field));
        for (double& value : likeness.share) value *= others;
        share(SkyObject::field) = field_where_strewn;
    }
    likeness.why = thin > 0.5 ? "its light is smooth, gathers in the middle and goes to one side"
                              : why_of(*scores[0].second, *scores[1].second, measures);
    return likeness;
}

StructureKind structure_of(SkyObject object, const Impression& seen) {
    // Of the mean light, at the picture's edges; nebulae alone have less, or a glow around them and
    // no bright middle.
    constexpr double dark_edge = 0.3, glowing_edge = 0.45, hollow_peak = 0.79;
    switch (object) {
        case SkyObject::galaxy:
        case SkyObject::elliptical:
        case SkyObject::cluster:
            return StructureKind::disk;
        case SkyObject::planetary:
            return StructureKind::axis;
        case SkyObject::remnant:
            return StructureKind::walls;
        case SkyObject::nebula:
            return seen.lit &&
                           (seen.edge <= dark_edge || (seen.edge <= glowing_edge && seen.peak < hollow_peak))
                       ? StructureKind::walls
                       : StructureKind::sheet;
        default:
            return StructureKind::sheet;
    }
}

double mean_light(const Image& light) {
    const Image brightest = brightest_channel(light);
    double sum = 0.0;
    for (const float value : brightest.pixels) sum += std::clamp(double(value), 0.0, 1.0);
    return sum / double(std::max<std::size_t>(1, brightest.pixels.size()));
}

double lit_share_of_rim(const Image& light) {
    const Image brightest = brightest_channel(light);
    const auto rim = std::int64_t(rim_share * double(light.width));
    std::int64_t lit = 0, all = 0;
    for (std::int64_t y = 0; y < light.height; ++y) {
        const bool whole_row = y <= rim || y >= light.height - 1 - rim;
        for (std::int64_t x = 0; x < light.width; ++x) {
            if (!whole_row && x > rim && x < light.width - 1 - rim) continue;
            lit += *brightest.at(x, y) > dark_rim ? 1 : 0;
            ++all;
        }
    }
    return double(lit) / double(std::max<std::int64_t>(1, all));
}

}  // namespace astrosplat
