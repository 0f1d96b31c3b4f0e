// Bright stars are looked for in the picture and in its halves, quarters and so on, so that rings of a few
// pixels measure any of them. Medians around each ring leave out spikes and neighbours.

#include "bodies/stars.h"
#include "core/parallel.h"
#include "core/real.h"
#include "detect/peaks.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

// Found in a film of NGC 1672: with these its bright stars are points from every side, and no knot is one.
constexpr int ring_places = 16, rings = 13;  // rings: 0 to 12 px
constexpr std::int64_t edge_px = rings;      // of a level's picture, without stars
constexpr std::int64_t bright_reach_px = 3;
constexpr float least_bright = 0.25f;                   // of the displayed white
constexpr float narrowest_px = 1.7f, widest_px = 3.4f;  // half width at half of the peak, of a level's pixels
constexpr std::int64_t usual_width = 1920;              // texels: DEPTH's lengths are for it
constexpr float widest_share = 14.0f / usual_width;     // of the picture's width
constexpr float at_two = 0.25f, at_three = 0.12f;       // of the excess, at most, at such half widths
constexpr float most_uneven = 0.25f;                    // of the excess, between the quartiles of a ring
constexpr float even_within = 1.5f, sky_at = 4.0f;      // half widths, of such rings, and of a star's end
constexpr float apart = 2.0f;                           // half widths between two stars
constexpr std::int64_t middle_reach_px = 4;             // about a peak, of light that tells the middle
constexpr double soft_px = 1.0;                         // blur under which a plateau has one peak

}  // namespace

Ring ring_at(const Image& image, int channel, float x, float y, float r) {
    static const std::array<std::pair<float, float>, ring_places> around = [] {
        std::array<std::pair<float, float>, ring_places> found;
        for (int i = 0; i < ring_places; ++i) {
            const double angle = 2.0 * real::pi * (i + 0.5) / ring_places;  // between spikes
            found[i] = {float(real::cos(angle)), float(real::sin(angle))};
        }
        return found;
    }();
    std::array<float, ring_places> values;
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = bilinear(image, channel, x + r * around[i].first, y + r * around[i].second);
    std::sort(values.begin(), values.end());
    return {0.5f * (values[ring_places / 2 - 1] + values[ring_places / 2]),
            values[3 * ring_places / 4] - values[ring_places / 4 - 1]};
}

namespace {

// As the rings around it tell, in pixels of its level.
std::optional<RoundStar> bright_star_at(const Image& brightest, std::int64_t column, std::int64_t row,
                                        float peak) {
    const auto x0 = float(column) + 0.5f, y0 = float(row) + 0.5f;
    const float far = ring_at(brightest, 0, x0, y0, float(rings - 1)).median;
    if (peak - far < least_bright) return {};
    const PointLight above_half = light_about(brightest, column, row, middle_reach_px, 0.5f * (far + peak));
    RoundStar star{above_half.x, above_half.y};
    std::array<Ring, rings> ring;
    float sky = peak;
    for (std::size_t r = 0; r < ring.size(); ++r) {
        ring[r] = ring_at(brightest, 0, star.x, star.y, float(r));
        sky = std::min(sky, ring[r].median);
    }
    const float excess = ring[0].median - sky;
    if (excess < least_bright) return {};
    const auto share = [&](std::size_t r) { return (ring[r].median - sky) / excess; };
    std::size_t below = 1;
    while (below + 1 < ring.size() && share(below) >= 0.5f) ++below;
    star.half_width = float(below) - (0.5f - share(below)) / std::max(1e-6f, share(below - 1) - share(below));
    if (star.half_width < narrowest_px || star.half_width >= widest_px) return {};
    const auto share_at = [&](float r) {
        return (ring_at(brightest, 0, star.x, star.y, r).median - sky) / excess;
    };
    if (share_at(2.0f * star.half_width) > at_two || share_at(3.0f * star.half_width) > at_three) return {};
    for (std::size_t r = 1; float(r) <= even_within * star.half_width; ++r)
        if (ring[r].quartiles_apart > most_uneven * excess) return {};
    return star;
}

std::vector<RoundStar> stars_of_level(const Image& brightest) {
    const Image soft = gaussian_blur(brightest, soft_px);
    return found_by_rows(brightest, edge_px, [&](std::int64_t x, std::int64_t y) -> std::optional<RoundStar> {
        if (*soft.at(x, y) < least_bright || !is_peak(soft, x, y, bright_reach_px)) return {};
        return bright_star_at(brightest, x, y, *soft.at(x, y));
    });
}

// Whether a star has no details that a coarser level does not show: knots of nebulae have.
bool is_smooth(const Image& brightest, const RoundStar& star) {
    constexpr int samples = 6;
    const float peak = bilinear(brightest, 0, star.x, star.y);
    const float sky = ring_at(brightest, 0, star.x, star.y, sky_at * star.half_width).median;
    for (int i = 1; i <= samples; ++i)
        if (ring_at(brightest, 0, star.x, star.y, even_within * star.half_width * float(i) / samples)
                .quartiles_apart > most_uneven * (peak - sky))
            return false;
    return true;
}

// The widest first, of which each keeps narrower ones away.
std::vector<RoundStar> all_stars(const Image& light) {
    const float widest = widest_share * float(std::max(usual_width, light.width));
    std::vector<std::vector<RoundStar>> levels;
    const Image whole = brightest_channel(light);
    Image brightest = copied(whole);
    for (float scale = 1.0f; scale * narrowest_px < widest; scale *= 2.0f) {
        if (std::min(brightest.width, brightest.height) <= 2 * edge_px) break;
        levels.push_back(stars_of_level(brightest));
        for (RoundStar& star : levels.back())
            star = {scale * star.x, scale * star.y, scale * star.half_width};
        brightest = halved(brightest);
    }
    std::vector<RoundStar> stars;
    for (auto level = levels.rbegin(); level != levels.rend(); ++level)
        for (const RoundStar& star : *level)
            if (is_smooth(whole, star) && std::ranges::none_of(stars, [&](const RoundStar& other) {
                    const float dx = star.x - other.x, dy = star.y - other.y;
                    const float least = apart * other.half_width;
                    return dx * dx + dy * dy < least * least;
                }))
                stars.push_back(star);
    return stars;
}

// Sigmas of a star's Gaussians, in that of the middle one, which is a power of two: as wide as the splats of
// bands, which the front is fitted with.
constexpr int widths = 3;
constexpr float sigmas[widths] = {0.5f, 1.0f, 2.0f};
constexpr float taken_sigmas = 4.0f;    // of the widest: how far a star is taken away
constexpr double most_exponent = 12.0;  // of each, whose rest is 6e-6 of its peak

// The power of two next to the sigma of a Gaussian of that half width.
float middle_sigma(float half_width) {
    constexpr float sigma_share = 0.85f, root_of_two = 1.41421356f;  // the first: 1 / sqrt(2 ln 2)
    float sigma = 2.0f;                                              // the power next to narrowest_px
    while (sigma * root_of_two < sigma_share * half_width) sigma *= 2.0f;
    return sigma;
}

struct Taken {
    RoundStar star;
    std::array<Star, widths> parts;
    glm::vec3 around{0.0f};  // light of its surroundings
    float reach() const { return taken_sigmas * parts[widths - 1].sigma; }
};

// Values of a star's Gaussians of peak 1.
std::array<double, widths> gaussians_at(double r, const std::array<Star, widths>& parts) {
    std::array<double, widths> values;
    for (std::size_t k = 0; k < widths; ++k) {
        const double t = r / double(parts[k].sigma);
        values[k] = real::exp(-0.5 * t * t);
    }
    return values;
}

double sum_of(const std::array<double, widths>& gaussians, const std::array<double, widths>& peak) {
    double sum = 0.0;
    for (std::size_t k = 0; k < widths; ++k) sum += peak[k] * gaussians[k];
    return sum;
}

using Profile = std::vector<std::pair<double, double>>;  // px from the middle, light

// Peaks >= 0 of Gaussians whose sum is nearest to a profile and hardly more anywhere: what is left over finds
// its place in the picture's bands, but what is too much could only be taken off the whole star.
void fit_peaks(const Profile& profile, int channel, std::array<Star, widths>& parts) {
    constexpr int rounds = 12, rounds_within = 20;               // after which peaks stay
    constexpr double too_much_weighs = 20.0, least_scale = 0.5;  // times what is left over; of fitted peaks
    constexpr double negligible = 0.02;  // of the middle's light, where it is too much
    std::array<double, widths> peak{};
    for (int round = 0; round < rounds; ++round) {
        std::array<std::array<double, widths>, widths> both{};
        std::array<double, widths> with{};
        for (const auto& [r, value] : profile) {
            const std::array<double, widths> g = gaussians_at(r, parts);
            const double weight = r * (sum_of(g, peak) > value ? too_much_weighs : 1.0);
            for (std::size_t k = 0; k < widths; ++k) {
                with[k] += weight * value * g[k];
                for (std::size_t l = 0; l < widths; ++l) both[k][l] += weight * g[k] * g[l];
            }
        }
        for (int within = 0; within < rounds_within; ++within)  // one after the other, until they stay
            for (std::size_t k = 0; k < widths; ++k) {
                double rest = with[k];
                for (std::size_t l = 0; l < widths; ++l)
                    if (l != k) rest -= both[k][l] * peak[l];
                peak[k] = std::max(0.0, rest / both[k][k]);
            }
    }
    double scale = 1.0;
    for (const auto& [r, value] : profile)
        scale = std::min(scale, (value + negligible * profile.front().second) /
                                    std::max(sum_of(gaussians_at(r, parts), peak), 1e-12));
    for (std::size_t k = 0; k < widths; ++k)
        parts[k].peak[channel] = float(std::max(scale, least_scale) * peak[k]);
}

// `uneven`: how much of what the quartiles of a ring are apart its light is to be below the median.
Taken taken(const RoundStar& star, const Image& light, float uneven) {
    constexpr int samples = 32;
    Taken out;
    out.star = star;
    const float middle = middle_sigma(star.half_width);
    for (std::size_t k = 0; k < widths; ++k) out.parts[k] = {star.x, star.y, sigmas[k] * middle};
    for (int c = 0; c < 3; ++c) {
        out.around[c] = ring_at(light, c, star.x, star.y, sky_at * star.half_width).median;
        Profile profile;
        for (int i = 0; i < samples; ++i) {
            const float r = sky_at * star.half_width * (float(i) + 0.5f) / samples;
            const Ring ring = ring_at(light, c, star.x, star.y, r);
            const float value = ring.median - uneven * ring.quartiles_apart - out.around[c];
            profile.emplace_back(double(r), double(std::max(0.0f, value)));
        }
        fit_peaks(profile, c, out.parts);
    }
    return out;
}

glm::vec3 light_of(const Taken& star, float x, float y) {
    const float dx = x - star.star.x, dy = y - star.star.y;
    glm::vec3 sum(0.0f);
    for (const Star& part : star.parts) {
        const double t = double(dx * dx + dy * dy) / double(2.0f * part.sigma * part.sigma);
        if (t < most_exponent) sum += part.peak * float(real::exp(-t));
    }
    return sum;
}

// From the pixels of rows [begin, end).
void take_away(const Taken& star, std::int64_t begin, std::int64_t end, Image& light) {
    const auto first = [&](float at) { return std::int64_t(at - star.reach()); };
    const auto last = [&](float at) { return std::int64_t(at + star.reach()); };
    const auto [x, y, half_width] = star.star;
    const auto take = [&](std::int64_t i, std::int64_t j) {
        const glm::vec3 own = light_of(star, float(i) + 0.5f, float(j) + 0.5f);
        float* const pixel = light.at(i, j);
        for (int c = 0; c < 3; ++c)
            pixel[c] = std::max(pixel[c] - own[c], std::min(pixel[c], least_left_in_dust * star.around[c]));
    };
    for_each_between(light, first(x), std::max(begin, first(y)), last(x), std::min(end - 1, last(y)), take);
}

}  // namespace

std::vector<Star> take_bright_stars(Image& light) { return take_bright_stars(light, all_stars(light), 0.0f); }

std::vector<Star> take_bright_stars(Image& light, std::span<const RoundStar> found, float uneven) {
    std::vector<Taken> all(found.size());
    parallel_each(found.size(), 16, [&](std::size_t i) { all[i] = taken(found[i], light, uneven); });
    constexpr std::int64_t strip = 64;
    parallel_chunks(light.height, strip, [&](std::int64_t begin, std::int64_t end, int) {
        for (const Taken& star : all) take_away(star, begin, end, light);
    });
    std::vector<Star> stars;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (Star part : all[i].parts) {
            part.body = std::uint32_t(i);
            if (part.peak != glm::vec3(0.0f)) stars.push_back(part);
        }
    return stars;
}

}  // namespace astrosplat
