// Candidates are the peaks above a running median; what is left of them after the tests of width, wings and
// roundness is a star.
#include "bodies/stars.h"

#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "detect/background.h"
#include "detect/peaks.h"
#include "image/blur.h"
#include "image/channels.h"

namespace astrosplat {
namespace {

// As DEPTH 1 has them, but for a least excess of .04 there: faint stars in dark parts are points, too.
constexpr std::int64_t star_reach_px = 2;  // 5x5
constexpr std::int64_t margin = 6;         // px without stars at the picture's edges
constexpr std::int64_t noise_step = 6;     // px between the places where the noise is measured
constexpr double noise_blur_px = 12.0;
constexpr float least_excess = 0.012f;  // of the displayed white
constexpr float noise_factor = 4.5f;
constexpr double widest_sigma = 2.2, narrowest_sigma = 0.45;
constexpr double least_moment_sigma = 0.6;        // of light over peak
constexpr double wing_radii[] = {2.0, 2.5, 3.0};  // px, where a star's wings are measured
constexpr float wing_share = 0.5f;                // of the peak, that the light at 2 to 3 px must stay below
constexpr float most_left = 1.15f;          // times the background, of what is beside a star's Gaussian,
constexpr float least_level = 0.01f;        // and so much of the displayed white
constexpr std::int64_t star_window_px = 8;  // that a star is taken out of
constexpr float uneven_share = 0.3f;        // of the peak, that this light may differ by around the star
// In enlarged pictures: share of a star's light that the picture may not have; and that a Gaussian may be off
// by within a sigma where it is all of the star: painted ones are .10 off, real ones .17.
constexpr double explained_sigmas = 2.5, most_unseen = 0.1, most_off = 0.12;

// Mean excess over the background around each place, on the grid of noise_step.
Image local_noise(const Image& brightest) {
    Image noise = make_image((brightest.width + noise_step - 1) / noise_step,
                             (brightest.height + noise_step - 1) / noise_step, 1);
    for_each_pixel(noise, [&](std::int64_t x, std::int64_t y) {
        *noise.at(x, y) = std::fabs(*brightest.at(x * noise_step, y * noise_step) -
                                    median_about(brightest, x * noise_step, y * noise_step));
    });
    return gaussian_blur(noise, noise_blur_px / double(noise_step));
}

// Directions all around.
struct Direction {
    double x, y;
};
const std::array<Direction, 8>& directions() {
    static const std::array<Direction, 8> all = [] {
        std::array<Direction, 8> found;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double angle = double(i) * real::pi / 4.0;
            found[i] = {real::cos(angle), real::sin(angle)};
        }
        return found;
    }();
    return all;
}

// Its wings are below half of its peak, and even all around. A flat top has its peak on one side: the middle
// of its light counts.
bool is_round(const Image& brightest, float x, float y, float sky, float excess) {
    float lo = 1e30f, hi = -1e30f;
    for (const Direction& direction : directions()) {
        float wing = 0.0f;
        for (const double r : wing_radii)
            wing += bilinear(brightest, 0, x + float(r * direction.x), y + float(r * direction.y)) / 3.0f;
        lo = std::min(lo, wing - sky);
        hi = std::max(hi, wing - sky);
    }
    return hi <= wing_share * excess && hi - lo <= uneven_share * excess;
}

// Median of a channel on the ring of 3.5 to 4.5 px around the star.
float ring_median(const Image& light, std::int64_t x, std::int64_t y, int channel) {
    std::array<float, 64> values;
    std::size_t count = 0;
    for (std::int64_t j = -4; j <= 4; ++j)
        for (std::int64_t i = -4; i <= 4; ++i)
            if (i * i + j * j >= 12 && i * i + j * j <= 20) values[count++] = light.at(x + i, y + j)[channel];
    return median(std::span(values).first(count));
}

// A star and the light on the ring around it.
struct StarInSky : Star {
    glm::vec3 around{0.0f};
    bool has_rest = true;  // beside its Gaussian
};

// Of a star's light within so many sigmas, the share that the picture does not have; with the sky, what the
// picture's differs by, too.
double share_off(const Image& light, const StarInSky& star, double sigmas, bool with_sky) {
    const auto sigma = double(star.sigma);
    double own = 1e-12, off = 0.0;
    for_each_within(
        light, star.x, star.y, sigmas * sigma, [&](std::int64_t x, std::int64_t y, double dx, double dy) {
            const double g = real::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
            for (int c = 0; c < 3; ++c) {
                const double here = g * double(star.peak[c]), lacks = here - double(light.at(x, y)[c]);
                own += here;
                off += with_sky ? std::fabs(lacks + double(star.around[c])) : std::max(0.0, lacks);
            }
        });
    return off / own;
}

std::optional<StarInSky> star_at(const Image& light, const Image& brightest, std::int64_t x, std::int64_t y,
                                 float noise) {
    const float least = std::max(least_excess, noise_factor * noise);
    if (*brightest.at(x, y) < least || !is_peak(brightest, x, y, star_reach_px)) return {};
    const float sky = median_about(brightest, x, y);
    const float excess = *brightest.at(x, y) - sky;
    if (excess < least) return {};
    PointLight point = light_about(brightest, x, y, star_reach_px, sky);
    if (const auto column = std::int64_t(point.x), row = std::int64_t(point.y); column != x || row != y)
        point = light_about(brightest, column, row, star_reach_px, sky);
    const double sigma = std::sqrt(point.sum / (2.0 * real::pi * double(excess)));
    if (sigma > widest_sigma || !is_round(brightest, point.x, point.y, sky, excess)) return {};
    StarInSky star;
    star.x = point.x;
    star.y = point.y;
    star.sigma = float(std::max(sigma, least_moment_sigma));
    for (int c = 0; c < 3; ++c) {
        star.around[c] = ring_median(light, x, y, c);
        star.peak[c] = std::max(0.0f, light.at(x, y)[c] - star.around[c]);
    }
    return star;
}

struct FittedPeak {
    double peak = 0.0, error = 0.0;
};

// The peak at which a Gaussian is nearest to the light over the sky and hardly more anywhere: what is left
// over is drawn beside it, but what is too much could only be taken off the whole star.
FittedPeak fitted(const Image& image, int channel, float sky, const Star& star, double sigma) {
    constexpr std::int64_t side = 2 * star_reach_px + 1;
    constexpr int rounds = 6;                 // after which it stays
    constexpr double too_much_weighs = 20.0;  // times what is left over, as of bright stars
    std::array<double, side * side> light, shape;
    for (std::int64_t i = 0; i < side * side; ++i) {
        const std::int64_t x = std::int64_t(star.x) + i % side - star_reach_px,
                           y = std::int64_t(star.y) + i / side - star_reach_px;
        const double dx = double(x) + 0.5 - double(star.x), dy = double(y) + 0.5 - double(star.y);
        light[i] = double(image.at(x, y)[channel] - sky);
        shape[i] = real::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
    }
    FittedPeak fit;
    for (int round = 0; round < rounds; ++round) {
        double with = 0.0, both = 0.0;
        fit.error = 0.0;
        for (std::size_t i = 0; i < shape.size(); ++i) {
            const double more = light[i] - fit.peak * shape[i], weight = more < 0.0 ? too_much_weighs : 1.0;
            with += weight * light[i] * shape[i];
            both += weight * shape[i] * shape[i];
            fit.error += weight * more * more;
        }
        if (round + 1 < rounds) fit.peak = std::max(0.0, with / both);
    }
    return fit;
}

// Measures a star in what brighter ones left.
void measure(const Image& light, const Image& brightest, StarInSky& star) {
    constexpr double step = 1.19;  // of sigmas: a fourth of an octave
    const auto x = std::int64_t(star.x), y = std::int64_t(star.y);
    const float sky = median_about(brightest, x, y);
    double least = std::numeric_limits<double>::max();
    for (double sigma = narrowest_sigma; sigma < step * widest_sigma; sigma *= step) {
        const double error = fitted(brightest, 0, sky, star, sigma).error;
        if (error >= least) continue;
        least = error;
        star.sigma = float(sigma);
    }
    for (int c = 0; c < 3; ++c) {
        star.around[c] = ring_median(light, x, y, c);
        star.peak[c] = float(fitted(light, c, star.around[c], star, double(star.sigma)).peak);
    }
}

// Calls visit(pixel, x, y) for the pixels of rows [begin, end) within `reach` px of the star.
template <class Visit>
void for_each_of_star(Image& image, const Star& star, std::int64_t reach, std::int64_t begin,
                      std::int64_t end, const Visit& visit) {
    const auto cx = std::int64_t(star.x), cy = std::int64_t(star.y);
    for_each_between(image, cx - reach, std::max(begin, cy - reach), cx + reach,
                     std::min(end - 1, cy + reach),
                     [&](std::int64_t x, std::int64_t y) { visit(image.at(x, y), x, y); });
}

void subtract(Image& light, const StarInSky& star, float least_left, Image& brightest) {
    for_each_of_star(
        light, star, star_window_px, 0, light.height, [&](float* pixel, std::int64_t x, std::int64_t y) {
            const double dx = double(x) + 0.5 - double(star.x);
            const double dy = double(y) + 0.5 - double(star.y);
            const double width = 2.0 * double(star.sigma) * double(star.sigma);
            const auto g = float(real::exp(-(dx * dx + dy * dy) / width));
            for (int c = 0; c < 3; ++c)
                pixel[c] =
                    std::max(pixel[c] - star.peak[c] * g, std::min(pixel[c], least_left * star.around[c]));
            *brightest.at(x, y) = std::max({pixel[0], pixel[1], pixel[2]});
        });
}

// The rest of a star beside its Gaussian, wings and diffraction, is cut to a little above the background.
void level(Image& light, const Image& before, const StarInSky& star, std::int64_t begin, std::int64_t end) {
    const auto reach = std::int64_t(3.0f * star.sigma + 1.0f);
    const float sky = median_about(before, std::int64_t(star.x), std::int64_t(star.y));
    const float most = most_left * sky + least_level;
    for_each_of_star(light, star, reach, begin, end, [&](float* pixel, std::int64_t, std::int64_t) {
        const float brightest = std::max({pixel[0], pixel[1], pixel[2]});
        if (brightest <= most) return;
        for (int c = 0; c < 3; ++c) pixel[c] *= most / brightest;
    });
}

// change(star, first row, end row) for the stars near every strip of rows, in their order.
template <class Stars, class Change>
void for_each_strip(const Image& light, const Stars& stars, const Change& change) {
    constexpr std::int64_t rows = 64;
    constexpr auto farthest = float(star_window_px + 1);
    parallel_chunks(light.height, rows, [&](std::int64_t begin, std::int64_t end, int) {
        for (const auto& star : stars)
            if (star.y > float(begin) - farthest && star.y < float(end) + farthest) change(star, begin, end);
    });
}

// What the Gaussians of stars do not show of what was taken out with them.
std::vector<SpikeLight> rest_of(Image before, const std::vector<StarInSky>& stars, Image& light) {
    parallel_each(before.pixels.size(), 65536, [&](std::size_t i) { before.pixels[i] -= light.pixels[i]; });
    Image nearest = make_image(light.width, light.height, 1, 1e30f);
    Buffer<std::int32_t> owner(nearest.pixels.size(), -1);
    for_each_strip(light, stars, [&](const StarInSky& star, std::int64_t begin, std::int64_t end) {
        for_each_of_star(before, star, star_window_px, begin, end,
                         [&](float* pixel, std::int64_t x, std::int64_t y) {
                             const float dx = float(x) + 0.5f - star.x, dy = float(y) + 0.5f - star.y;
                             const float sigmas = (dx * dx + dy * dy) / (star.sigma * star.sigma);
                             const auto g = float(real::exp(-0.5 * double(sigmas)));
                             for (int c = 0; c < 3; ++c) pixel[c] -= g * star.peak[c];
                             if (sigmas >= *nearest.at(x, y)) return;
                             *nearest.at(x, y) = sigmas;
                             owner[std::size_t(y * light.width + x)] =
                                 star.has_rest ? std::int32_t(&star - stars.data()) : -1;
                         });
    });
    return by_squares(1, before, owner, light);
}

std::vector<StarInSky> found_stars(Image& light, float least_left, bool enlarged) {
    Image brightest = brightest_channel(light);
    const Image noise = local_noise(brightest);
    std::vector<StarInSky> found = found_by_rows(light, margin, [&](std::int64_t x, std::int64_t y) {
        return star_at(light, brightest, x, y, *noise.at(x / noise_step, y / noise_step));
    });
    if (enlarged)
        std::erase_if(found, [&](const StarInSky& each) {
            return share_off(light, each, explained_sigmas, false) > most_unseen;
        });
    std::ranges::stable_sort(found, std::ranges::greater(), [](const StarInSky& each) {
        return std::max({each.peak.x, each.peak.y, each.peak.z});
    });
    for (StarInSky& each : found) {
        each.has_rest = !enlarged || share_off(light, each, 1.0, true) > most_off;
        if (each.has_rest) measure(light, brightest, each);
        subtract(light, each, least_left, brightest);
    }
    for_each_strip(light, found, [&](const StarInSky& star, std::int64_t begin, std::int64_t end) {
        level(light, brightest, star, begin, end);
    });
    for (std::size_t i = 0; i < found.size(); ++i) found[i].body = std::uint32_t(i);
    return found;
}

}  // namespace

std::vector<Star> take_stars(Image& light, float least_left) {
    const std::vector<StarInSky> found = found_stars(light, least_left, false);
    return {found.begin(), found.end()};
}

PictureStars take_picture_stars(Image& light, const StructureParams& params, bool enlarged,
                                std::vector<Star> spiked) {
    PictureStars stars;
    if (params.stars == StructureParams::Stars::no) return stars;
    std::vector<Star> bright = std::move(spiked), left;
    const auto add = [&](std::vector<Star> more, std::vector<Star>& to) {
        const std::uint32_t first = bright.empty() ? 0 : std::ranges::max(bright, {}, &Star::body).body + 1;
        for (Star& star : more) star.body += first;
        to.insert(to.end(), more.begin(), more.end());
    };
    const bool disk = params.kind == StructureKind::disk;
    if (disk) add(take_bright_stars(light), bright);
    if (params.kind == StructureKind::axis) {
        Image without = copied(light);
        add(take_bright_stars(without), left);
    }
    const float least_left = disk ? least_left_in_dust : 0.0f;  // without dust a hole is nearer the front
    Image before = copied(light);
    std::vector<StarInSky> found = found_stars(light, least_left, enlarged);
    std::ranges::stable_sort(found, {}, &Star::sigma);
    stars.rest = rest_of(std::move(before), found, light);
    stars.all.assign(found.begin(), found.end());
    stars.ordinary = stars.all.size();
    stars.count = std::int64_t(stars.ordinary);
    stars.taken = stars.ordinary + bright.size();
    for (std::vector<Star>* const part : {&bright, &left}) {
        for (Star& star : *part) {
            star.body += std::uint32_t(stars.ordinary);
            stars.count = std::max(stars.count, std::int64_t(star.body) + 1);
        }
        std::ranges::stable_sort(*part, {}, &Star::sigma);
        stars.all.insert(stars.all.end(), part->begin(), part->end());
    }
    return stars;
}

}  // namespace astrosplat
