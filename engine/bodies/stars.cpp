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
constexpr double widest_sigma = 2.2, narrowest_sigma = 0.6;
constexpr double wing_radii[] = {2.0, 2.5, 3.0};  // px, where a star's wings are measured
constexpr float wing_share = 0.5f;                // of the peak, that the light at 2 to 3 px must stay below
constexpr float most_left = 1.15f;    // times the background, of what is beside a star's Gaussian,
constexpr float least_level = 0.01f;  // and so much of the displayed white
constexpr std::int64_t star_window_px = 6;
constexpr float uneven_share = 0.3f;  // of the peak, that this light may differ by around the star
constexpr double explained_sigmas = 2.5;
constexpr double most_unseen = 0.1;  // share of a star's light that the picture may not have

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

// Whether the picture has the light that the star's Gaussian gives it. Among crowded stars a Gaussian may be
// brighter beside its middle than all that is there: no fit of colours mends that.
bool is_explained(const Image& light, const Star& star) {
    const auto sigma = double(star.sigma);
    double own = 0.0, unseen = 0.0;
    for_each_within(light, star.x, star.y, explained_sigmas * sigma,
                    [&](std::int64_t x, std::int64_t y, double dx, double dy) {
                        const double g = real::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
                        for (int c = 0; c < 3; ++c) {
                            const double here = g * double(star.peak[c]);
                            own += here;
                            unseen += std::max(0.0, here - double(light.at(x, y)[c]));
                        }
                    });
    return unseen <= most_unseen * own;
}

// A star and the light on the ring around it.
struct StarInSky {
    Star star;
    glm::vec3 around{0.0f};
};

std::optional<StarInSky> star_at(const Image& light, const Image& brightest, std::int64_t x, std::int64_t y,
                                 float noise) {
    const float least = std::max(least_excess, noise_factor * noise);
    if (*brightest.at(x, y) < least || !is_peak(brightest, x, y, star_reach_px)) return {};
    const float sky = median_about(brightest, x, y);
    const float excess = *brightest.at(x, y) - sky;
    if (excess < least) return {};
    constexpr std::int64_t reach = 2;
    PointLight point = light_about(brightest, x, y, reach, sky);
    if (const auto column = std::int64_t(point.x), row = std::int64_t(point.y); column != x || row != y)
        point = light_about(brightest, column, row, reach, sky);
    const double sigma = std::sqrt(point.sum / (2.0 * real::pi * double(excess)));
    if (sigma > widest_sigma || !is_round(brightest, point.x, point.y, sky, excess)) return {};
    StarInSky found;
    Star& star = found.star;
    star.x = point.x;
    star.y = point.y;
    star.sigma = float(std::max(sigma, narrowest_sigma));
    for (int c = 0; c < 3; ++c) {
        found.around[c] = ring_median(light, x, y, c);
        star.peak[c] = std::max(0.0f, light.at(x, y)[c] - found.around[c]);
    }
    return found;
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

void subtract(Image& light, const StarInSky& found, float least_left, std::int64_t begin, std::int64_t end) {
    const Star& star = found.star;
    for_each_of_star(
        light, star, star_window_px, begin, end, [&](float* pixel, std::int64_t x, std::int64_t y) {
            const double dx = double(x) + 0.5 - double(star.x);
            const double dy = double(y) + 0.5 - double(star.y);
            const double width = 2.0 * double(star.sigma) * double(star.sigma);
            const auto g = float(real::exp(-(dx * dx + dy * dy) / width));
            for (int c = 0; c < 3; ++c)
                pixel[c] =
                    std::max(pixel[c] - star.peak[c] * g, std::min(pixel[c], least_left * found.around[c]));
        });
}

// The rest of a star beside its Gaussian, wings and diffraction, is cut to a little above the background.
void level(Image& light, const Image& before, const StarInSky& found, std::int64_t begin, std::int64_t end) {
    const Star& star = found.star;
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
template <class Change>
void for_each_strip(const Image& light, const std::vector<StarInSky>& stars, const Change& change) {
    constexpr std::int64_t rows = 64;
    constexpr float farthest = 12.0f;  // px that a change reaches
    parallel_chunks(light.height, rows, [&](std::int64_t begin, std::int64_t end, int) {
        for (const StarInSky& found : stars)
            if (found.star.y > float(begin) - farthest && found.star.y < float(end) + farthest)
                change(found, begin, end);
    });
}

}  // namespace

std::vector<Star> take_stars(Image& light, float least_left, StarsTaken taken) {
    const Image brightest = brightest_channel(light);
    const Image noise = local_noise(brightest);
    std::vector<StarInSky> found = found_by_rows(light, margin, [&](std::int64_t x, std::int64_t y) {
        return star_at(light, brightest, x, y, *noise.at(x / noise_step, y / noise_step));
    });
    if (taken == StarsTaken::explained)
        std::erase_if(found, [&](const StarInSky& each) { return !is_explained(light, each.star); });
    for_each_strip(light, found, [&](const StarInSky& star, std::int64_t begin, std::int64_t end) {
        subtract(light, star, least_left, begin, end);
    });
    const Image without = brightest_channel(light);
    for_each_strip(light, found, [&](const StarInSky& star, std::int64_t begin, std::int64_t end) {
        level(light, without, star, begin, end);
    });
    std::vector<Star> stars;
    for (const StarInSky& each : found) {
        stars.push_back(each.star);
        stars.back().body = std::uint32_t(stars.size() - 1);
    }
    return stars;
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
    stars.all = take_stars(light, least_left, enlarged ? StarsTaken::explained : StarsTaken::round);
    std::ranges::stable_sort(stars.all, {}, &Star::sigma);
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
