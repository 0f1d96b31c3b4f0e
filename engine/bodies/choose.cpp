// A picture's kind, by measures of a small copy without its stars, above the darkest tenth: how the light
// falls off from its brightest place, how red it is there, whether it has the colours of stars, whether it is
// alike on either side, and how much of it reaches the picture's edges. The limits are from pictures of
// galaxies, clusters and nebulae.
#include "bodies/choose.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bodies/picture_light.h"
#include "bodies/stars.h"
#include "core/sorting.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

// Found on 344 pictures (126 of nebulae, 135 of galaxies, 29 of fields): what takes fewest for another kind.
constexpr std::int64_t small_width = 256;  // px
constexpr double small_things = 0.012;     // of the width: what stands out of a blur so wide is small
constexpr double mostly_small = 0.52;      // share of the light in small things: fields have .5 to .8
constexpr double scattered = 0.45;         // difference between opposite sides
constexpr double edge_share = 0.06;        // of the width, that counts as the picture's edge
constexpr double bright_middle = 2.5;      // times the light at the half-light radius
constexpr double soft_middle = 1.5;        // the same, of an even disk with a redder middle
constexpr double even_middle = 2.2;        // of what is hollow, at most
constexpr double dark_edge = 0.3;          // of the mean light
constexpr double alone_edge = 0.45;  // of the same, for what has a glow around it, or is alike on all sides
// Red over blue, of the middle against its surroundings; a round middle may be burnt out to white.
constexpr double as_red = 0.8, redder = 1.25, burnt_out = 0.45;
// Differences between opposite sides: galaxies have .02 to .5, clouds .2 to .9. Grey ones have but these.
constexpr double round = 0.1, even_sides = 0.25, lopsided = 0.56, lopsided_grey = 0.4;

// Likewise. Parts, by distance from the brightest place, in half-light radii; and what is
// compared with the opposite side of that place, which in the middle is itself.
struct Zone {
    double from, to;
};
constexpr Zone middle_zone{0.0, 0.35}, half_light_zone{0.8, 1.2}, outer_zone{0.9, 1.6}, object_zone{0.0, 1.6},
    compared_zone{0.35, 1.5};
constexpr double place_blur = 0.02;   // of the width: over how wide an area a place is bright
constexpr double side_blur_px = 2.0;  // of what is compared: its details do not count
constexpr double sky_share = 0.1;     // of a channel, that is its sky
constexpr double grey_share = 0.01, grey_light = 1e-4;  // by which red and blue of a grey pixel differ

// Red and blue over green, of stars' light; red of what has hardly any blue, behind dust; and their product.
constexpr double least_red = 0.58, most_red = 1.66, most_red_in_dust = 2.1, least_blue_without_dust = 0.9;
constexpr double least_pink = 0.42, most_pink = 2.3;

constexpr double rim_share = 0.02;  // of the width
constexpr float dark_rim = 0.001f;  // from aslant it shows several times as bright

struct Pixel {
    double radius, light, red, blue;
    glm::dvec3 above_sky;
    bool edge;
};

Image of_width(const Image& image, std::int64_t width) {
    const std::int64_t height = std::max<std::int64_t>(1, image.height * width / image.width);
    return resampled(image, map_to_width(image, width, height), width, height, 0.5);
}

Image small_copy(const Image& light) {
    Image copy = light.width > 2 * small_width ? of_width(light, 2 * small_width) : light;
    take_stars(copy);
    return gaussian_blur(of_width(copy, small_width), 1.0);
}

struct Place {
    std::int64_t x, y;
};
Place brightest_place(const Image& light) {
    const Image smooth = gaussian_blur(brightest_channel(light), place_blur * double(light.width));
    const auto top = std::ranges::max_element(smooth.pixels) - smooth.pixels.begin();
    return {top % light.width, top / light.width};
}

double sky_of(const Image& channel) {
    return percentile({channel.pixels.begin(), channel.pixels.end()}, sky_share);
}

// The pixels by their distance from the brightest place, px.
std::vector<Pixel> by_radius(const Image& light) {
    const Image brightest = brightest_channel(light);
    const Place middle = brightest_place(light);
    const auto cx = double(middle.x), cy = double(middle.y);
    const double sky = sky_of(brightest);
    const glm::dvec3 skies(sky_of(channel_of(light, 0)), sky_of(channel_of(light, 1)),
                           sky_of(channel_of(light, 2)));
    const auto edge = std::int64_t(edge_share * double(light.width));
    std::vector<Pixel> pixels;
    for (std::int64_t y = 0; y < light.height; ++y) {
        for (std::int64_t x = 0; x < light.width; ++x) {
            const float* const p = light.at(x, y);
            const bool at_edge = x < edge || y < edge || x >= light.width - edge || y >= light.height - edge;
            pixels.push_back({std::hypot(double(x) - cx, double(y) - cy),
                              std::max(0.0, double(*brightest.at(x, y)) - sky), double(p[0]), double(p[2]),
                              glm::max(glm::dvec3(p[0], p[1], p[2]) - skies, 0.0), at_edge});
        }
    }
    std::ranges::stable_sort(pixels, {}, &Pixel::radius);
    return pixels;
}

double half_light_radius(const std::vector<Pixel>& pixels) {
    double all = 0.0, sum = 0.0;
    for (const Pixel& p : pixels) all += p.light;
    for (const Pixel& p : pixels)
        if ((sum += p.light) >= 0.5 * all) return p.radius;
    return 0.0;
}

bool is_grey(const std::vector<Pixel>& pixels) {
    return std::ranges::all_of(pixels, [](const Pixel& p) {
        return std::fabs(p.red - p.blue) <= grey_light + grey_share * std::max(p.red, p.blue);
    });
}

// How far the light around the brightest place differs from that on the opposite side of it: 0 alike .. 1.
double lopsidedness(const Image& light, double half) {
    const Image brightest = gaussian_blur(brightest_channel(light), side_blur_px);
    const Place middle = brightest_place(light);
    const double sky = sky_of(brightest);
    const auto above_sky = [&](std::int64_t x, std::int64_t y) {
        return std::max(0.0, double(*brightest.at(x, y)) - sky);
    };
    double difference = 0.0, sum = 0.0;
    for (std::int64_t y = 0; y < light.height; ++y) {
        for (std::int64_t x = 0; x < light.width; ++x) {
            const std::int64_t u = 2 * middle.x - x, v = 2 * middle.y - y;
            const double radius = std::hypot(double(x - middle.x), double(y - middle.y));
            const bool seen = u >= 0 && v >= 0 && u < light.width && v < light.height;
            if (!seen || radius < compared_zone.from * half || radius > compared_zone.to * half) continue;
            difference += std::fabs(above_sky(x, y) - above_sky(u, v));
            sum += above_sky(x, y) + above_sky(u, v);
        }
    }
    return sum > 0.0 ? difference / sum : 1.0;
}

// Share of the light above the sky that is in small things, stars among them.
double small_share(const Image& light) {
    const std::int64_t width = std::min(light.width, 2 * small_width);
    Image above = brightest_channel(of_width(light, width));
    const auto sky = float(sky_of(above));
    for (float& value : above.pixels) value = std::max(0.0f, value - sky);
    const Image wide = gaussian_blur(above, small_things * double(width));
    double small = 0.0, all = 0.0;
    for (std::size_t i = 0; i < above.pixels.size(); ++i) {
        small += double(std::max(0.0f, above.pixels[i] - wide.pixels[i]));
        all += double(above.pixels[i]);
    }
    return all > 0.0 ? small / all : 0.0;
}

// Means over the pixels for which `wanted` holds.
struct Part {
    double light = 0.0, redness = 1.0;
    glm::dvec3 above_sky{0.0};
};
template <class Wanted>
Part part_of(const std::vector<Pixel>& pixels, Wanted wanted) {
    double light = 0.0, red = 0.0, blue = 0.0, count = 0.0;
    glm::dvec3 above_sky(0.0);
    for (const Pixel& p : pixels) {
        if (!wanted(p)) continue;
        light += p.light;
        above_sky += p.above_sky;
        red += p.red;
        blue += p.blue;
        count += 1.0;
    }
    return {light / std::max(1.0, count), red / std::max(1e-12, blue), above_sky / std::max(1.0, count)};
}

// Light of stars lies near the colours of glowing bodies, where red grows as blue falls; glowing gas is
// redder, or pink or green. Behind dust, stars are redder and have hardly any blue.
bool of_stars(const glm::dvec3& color) {
    const double red = color.r / std::max(1e-12, color.g), blue = color.b / std::max(1e-12, color.g);
    const double reddest = blue > least_blue_without_dust ? most_red : most_red_in_dust, pink = red * blue;
    return red >= least_red && red <= reddest && pink >= least_pink && pink <= most_pink;
}

bool is_too_small(const Image& light) { return light.width < 16 || light.height < 16; }

// Measures of a picture by which its kind is chosen.
struct Impression {
    bool lit = false;                  // anywhere above its sky
    double peak = 0.0;                 // light in the middle over that at the half-light radius
    double redness = 1.0;              // red over blue, of the middle against its surroundings
    double edge = 0.0;                 // light at the picture's edges over the mean
    double sides = 1.0;                // difference between opposite sides, 0 alike .. 1
    bool grey = false, stars = false;  // has no colours; has those of stars
};
Impression impression_of(const Image& light) {
    const Image small = small_copy(light);
    const std::vector<Pixel> pixels = by_radius(small);
    const double half = half_light_radius(pixels);
    const auto within = [&](const Zone& zone) {
        return part_of(pixels, [&](const Pixel& p) {
            return p.radius >= zone.from * half && p.radius <= zone.to * half;
        });
    };
    const Part all = part_of(pixels, [](const Pixel&) { return true; });
    const Part edge = part_of(pixels, [](const Pixel& p) { return p.edge; });
    const Part middle = within(middle_zone), ring = within(half_light_zone), outside = within(outer_zone);
    Impression seen;
    seen.lit = all.light > 0.0;
    if (!seen.lit) return seen;
    seen.peak = middle.light / std::max(1e-12, ring.light);
    seen.redness = middle.redness / std::max(1e-12, outside.redness);
    seen.edge = edge.light / all.light;
    seen.sides = lopsidedness(small, half);
    seen.grey = is_grey(pixels);
    seen.stars = of_stars(within(object_zone).above_sky);
    return seen;
}

bool is_one_sided(const Impression& seen) { return seen.sides > (seen.grey ? lopsided_grey : lopsided); }

bool is_galaxy(const Impression& seen) {
    const bool even = seen.sides < even_sides;
    const bool gathers = seen.peak >= (even && seen.redness >= redder ? soft_middle : bright_middle);
    const bool red = seen.redness >= (seen.sides < round ? burnt_out : as_red);
    const bool ends = seen.edge <= (even ? alone_edge : dark_edge);
    return gathers && red && ends && seen.stars && !is_one_sided(seen);
}

StructureChoice by_looking(const Image& light) {
    if (is_too_small(light)) return {StructureKind::sheet, SkyObject::nebula, "it is too small to tell"};
    const Impression seen = impression_of(light);
    if (!seen.lit) return {StructureKind::sheet, SkyObject::nebula, "it is even up to its edges"};
    if (seen.sides > scattered && small_share(light) > mostly_small)
        return {StructureKind::sheet, SkyObject::field, "its light is in many small things, here and there"};
    if (is_galaxy(seen))
        return {StructureKind::disk, SkyObject::galaxy,
                seen.grey ? "its light gathers in its middle and is alike on either side"
                          : "its light has the colours of stars and gathers in a middle that is as red as "
                            "what is around it, or redder"};
    if (seen.peak < even_middle && seen.edge <= alone_edge)
        return {StructureKind::walls, SkyObject::remnant,
                "it stands alone on a dark sky and is not much brighter in the middle"};
    if (seen.edge > dark_edge)
        return {StructureKind::sheet, SkyObject::nebula, "its light goes on to the picture's edges"};
    const char* why = "it stands on a dark sky, and its light does not gather in its middle";
    if (!seen.stars)
        why = "it stands on a dark sky and has the colours of gas, not of stars";
    else if (is_one_sided(seen))
        why = "it stands on a dark sky, and its middle has different light on either side";
    else if (seen.redness < as_red)
        why = "it stands on a dark sky, and its bright middle is bluer than what is around it";
    return {StructureKind::walls, SkyObject::nebula, why};
}

StructureKind of_nebula(const Image& light) {
    if (is_too_small(light)) return StructureKind::sheet;
    const Impression seen = impression_of(light);
    return seen.lit && seen.edge <= dark_edge ? StructureKind::walls : StructureKind::sheet;
}

}  // namespace

StructureChoice choose_structure(const Image& light, std::optional<SkyObject> shown) {
    if (!shown) return by_looking(light);
    if (*shown == SkyObject::galaxy) return {StructureKind::disk, *shown, ""};
    if (*shown == SkyObject::remnant) return {StructureKind::walls, *shown, ""};
    if (*shown == SkyObject::field) return {StructureKind::sheet, *shown, ""};
    return {of_nebula(light), *shown, ""};
}

glm::dvec2 subject_of(const Image& light) {
    const glm::dvec2 middle(0.5);
    if (is_too_small(light)) return middle;
    const Image small = small_copy(light);
    const Image brightest = brightest_channel(small);
    if (!(std::ranges::max(brightest.pixels) > 0.0f)) return middle;
    const Place place = brightest_place(small);
    return {(double(place.x) + 0.5) / double(small.width), (double(place.y) + 0.5) / double(small.height)};
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
