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
    std::vector<Star> stars;
};
Copies copies_of(const Image& light) {
    Image whole = light.width > 2 * small_width ? of_width(light, 2 * small_width) : light;
    Image rest = copied(whole);
    std::vector<Star> stars = take_stars(rest);
    return {std::move(whole), std::move(rest), std::move(stars)};
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

// ln of the second moment of the brightest fifth of the light over that of all (M20: Lotz et al. 2004).
double togetherness_of(const Image& above, Place centre) {
    constexpr double brightest = 0.2;
    std::vector<std::pair<double, double>> pixels;  // light, its moment
    double all = 0.0, moment = nothing, sum = 0.0, own = nothing;
    for_each_in_order(above, [&](std::int64_t x, std::int64_t y) {
        const auto dx = double(x - centre.x), dy = double(y - centre.y), light = double(*above.at(x, y));
        pixels.emplace_back(light, light * (dx * dx + dy * dy));
        all += light;
        moment += pixels.back().second;
    });
    std::ranges::stable_sort(pixels, std::ranges::greater(), &std::pair<double, double>::first);
    for (const auto& [light, of_it] : pixels) {
        if (sum >= brightest * all) break;
        sum += light;
        own += of_it;
    }
    return real::log(own / moment);
}

// How alike red and blue are from place to place: their correlation.
double likeness_of_colors(const std::vector<Pixel>& pixels) {
    glm::dvec2 mean(0.0);
    for (const Pixel& p : pixels) mean += glm::dvec2(p.color.r, p.color.b) / double(pixels.size());
    glm::dvec3 products(nothing, nothing, 0.0);
    for (const Pixel& p : pixels) {
        const double r = p.color.r - mean.x, b = p.color.b - mean.y;
        products += glm::dvec3(r * r, b * b, r * b);
    }
    return products.z / std::sqrt(products.x * products.y);
}

// ln of the brightest twentieth of the stars over their median.
double spread_of_stars(const std::vector<Star>& stars) {
    std::vector<double> peaks;
    for (const Star& star : stars) peaks.push_back(double(std::max({star.peak.r, star.peak.g, star.peak.b})));
    if (peaks.empty()) return 0.0;
    return real::log(std::max(nothing, percentile(peaks, 0.95)) / std::max(nothing, percentile(peaks, 0.5)));
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
    seen.together = togetherness_of(above, centre);
    seen.like_colors = likeness_of_colors(pixels);
    seen.star_spread = spread_of_stars(copies.stars);
    seen.balance = difference_of_sides(above, centre, radius_of(by_radius(small, above, centre), 0.5));
    return seen;
}

namespace {

constexpr int measure_count = 20;
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
                      std::max(0.0, s.sides - 0.35),
                      s.together,
                      s.like_colors,
                      s.star_spread};
    for (double& m : measures) m = std::clamp(m, -4.0, 4.0);
    return measures;
}

struct Weights {
    SkyObject object;
    Measures measures;
    double bias;
};
using Model = std::array<Weights, 6>;

// Multinomial logistic regression on 558 labelled pictures: 522 of a
// planetarium's catalogue, 22 of telescopes', which weigh four times as much, and 14 painted ones, which
// weigh six times, in grey twice. Each tenth of the catalogue's judged by a model made of all others: 83 %
// right in colour, 79 % in grey. Remnants count as nebulae.
constexpr Model in_colour{{{SkyObject::galaxy,
                            {0.46, 1.29, 1.39,  -2.86, -1.67, -2.42, 0.28,  0.18, 0.16, -2.09,
                             5.09, 1.34, -5.64, -2.3,  -0.54, -2.12, -0.43, 0.07, 3.5,  0.96},
                            3.9},
                           {SkyObject::elliptical,
                            {0.9,   0.14,  1.08, -1.2, -2.52, -2.15, -0.37, -0.42, -2.57, -1.47,
                             -3.13, -1.77, 0.45, 3.25, 1.87,  -0.79, 0.07,  -0.16, 1.83,  1.81},
                            -8.49},
                           {SkyObject::nebula,
                            {0.17, -0.69, -0.73, 1.45,  0.36, -0.47, 1.19,  0.98, -0.63, 3.63,
                             3.18, -5.75, -0.78, -3.88, 1.53, -1.55, -0.78, 0.04, -7.26, -0.43},
                            11.19},
                           {SkyObject::planetary,
                            {-0.44, -0.47, 1.79, 2.25, -3.98, -3.84, -0.25, -0.09, 5.09,  0.32,
                             -5.24, 1.21,  0.93, 3.69, -2.85, 3.73,  2.59,  0.54,  -1.49, -1.23},
                            1.63},
                           {SkyObject::field,
                            {-0.5, -0.14, -2.6, 0.94,  2.71, 4.71, -0.36, 1.23,  1.11,  0.9,
                             1.79, 4.18,  0.97, -1.76, 1.46, 1.29, 1.21,  -0.19, -1.01, -0.78},
                            -1.37},
                           {SkyObject::cluster,
                            {-0.59, -0.13, -0.94, -0.58, 5.11,  4.16,  -0.48, -1.88, -3.16, -1.29,
                             -1.68, 0.8,   4.08,  1,     -1.46, -0.56, -2.66, -0.3,  4.43,  -0.33},
                            -6.86}}};
constexpr Model in_grey{
    {{SkyObject::galaxy,
      {0.28, 0, 1.38, -4.84, -2.3, -1.27, 0, 0, 0, 0, 4.97, 0.08, -4.64, -0.8, -0.46, 0, 1.82, 0.28, 0, 0.91},
      6.26},
     {SkyObject::elliptical,
      {0.6, 0, 1.28, -1.72, -2.93, -2.15, 0, 0, 0, 0, -3.12, -2.15, 1.17, 3.58, 2.02, 0, 0.5, -0.12, 0, 1.83},
      -8.2},
     {SkyObject::nebula,
      {-0.06, 0,     -0.35, 4.22,  1.47, -0.67, 0,     0,   0, 0,
       -0.38, -6.13, -2.27, -5.27, 2.28, 0,     -3.59, 0.1, 0, -0.32},
      7.01},
     {SkyObject::planetary,
      {0.01, 0, 0.99, 2.55, -3.51, -2.92, 0, 0, 0, 0, -3.79, 1.74, 0.1, 2.66, -2.97, 0, 1.33, 0.7, 0, -1.2},
      3.79},
     {SkyObject::field,
      {-0.3, 0, -2.98, 0.49, 2.25, 4.23, 0, 0, 0, 0, 3.53, 4.6, 1.01, -2.48, 2.45, 0, 1, -0.41, 0, -0.61},
      -3.21},
     {SkyObject::cluster,
      {-0.54, 0,    -0.33, -0.69, 5.02,  2.77, 0,     0,     0, 0,
       -1.21, 1.86, 4.64,  2.32,  -3.32, 0,    -1.05, -0.55, 0, -0.6},
      -5.65}}};

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
     {0.14, "it differs from side to side", "it is alike on either side"},
     {-2.66, "its brightest parts lie apart", "its brightest parts lie together"},
     {0.91, "red and blue light lie together", "red and blue light lie apart"},
     {1.62, "its stars are bright and faint", "its stars are alike"}}};

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
