#include "fidelity/side.h"

#include <numeric>

#include "core/color.h"
#include "core/sorting.h"
#include "detect/parts.h"
#include "detect/peaks.h"
#include "fidelity/display.h"
#include "image/blur.h"
#include "image/channels.h"
#include "image/resample.h"

namespace astrosplat {
namespace {

// Blurs that take away single splats and stars and leave what is measured.
constexpr double lane_blur_px = 0.8, center_blur_px = 1.5, body_blur_px = 6.0;
constexpr float least_of_body = 0.3f;  // of the brightest place: what is brighter belongs to the body

using Profile = std::vector<double>;

struct Profiles {
    Profile rows, columns;  // mean light of each
};

Profiles mean_profiles(const Image& light) {
    Profiles p{Profile(std::size_t(light.height)), Profile(std::size_t(light.width))};
    for (std::int64_t y = 0; y < light.height; ++y)
        for (std::int64_t x = 0; x < light.width; ++x) {
            p.rows[y] += *light.at(x, y) / double(light.width);
            p.columns[x] += *light.at(x, y) / double(light.height);
        }
    return p;
}

// First and last index whose value is above a threshold that the greatest exceeds.
struct Span {
    std::int64_t first, last;
    std::int64_t length() const { return last - first + 1; }
};

Span span_above(const Profile& p, double threshold) {
    const auto above = [&](double v) { return v > threshold; };
    const auto first = std::find_if(p.begin(), p.end(), above) - p.begin();
    const auto last = std::find_if(p.rbegin(), p.rend(), above) - p.rbegin();
    return {first, std::int64_t(p.size()) - 1 - last};
}

Profile blurred(const Profile& profile, double sigma_px) {
    Image line = make_image(std::int64_t(profile.size()), 1, 1);
    std::copy(profile.begin(), profile.end(), line.pixels.begin());
    line = convolved_with_gaussian(line, sigma_px);
    return {line.pixels.begin(), line.pixels.end()};
}

// The least of the middle half of the profile between its half maxima, below their greatest.
double depth_of_lane(const Profile& rows, const Span& half) {
    if (half.length() <= 6) return 0.0;
    const Profile all = blurred(rows, lane_blur_px);
    const Profile inside(all.begin() + half.first, all.begin() + half.last + 1);
    const std::int64_t quarter = half.length() / 4;
    return 1.0 -
           *std::min_element(inside.begin() + quarter, inside.end() - quarter) / std::ranges::max(inside);
}

// Values [begin, end) as far as they exist; one at least.
Profile part(const Profile& p, std::int64_t begin, std::int64_t end) {
    const auto size = std::int64_t(p.size());
    const std::int64_t from = std::clamp<std::int64_t>(begin, 0, size - 1);
    return {p.begin() + from, p.begin() + std::clamp(end, from + 1, size)};
}

double mean(const Profile& p) { return std::accumulate(p.begin(), p.end(), 0.0) / double(p.size()); }

double center_over_half_radius(const Image& light, const Profile& columns, const Span& disk) {
    const Image smooth = convolved_with_gaussian(light, center_blur_px);
    Profile peak(columns.size());
    for (std::int64_t y = 0; y < smooth.height; ++y)
        for (std::size_t x = 0; x < peak.size(); ++x)
            peak[x] = std::max(peak[x], double(*smooth.at(std::int64_t(x), y)));
    const std::int64_t length = disk.length(), middle = (disk.first + disk.last) / 2,
                       reach = std::max<std::int64_t>(2, length / 40);
    const Profile wide = blurred(columns, double(length) / 30.0);
    const std::int64_t brightest = std::max_element(wide.begin(), wide.end()) - wide.begin();
    const std::int64_t begin = std::max<std::int64_t>(0, brightest - reach);
    const double center = percentile(part(peak, begin, begin + 2 * reach), 0.5);
    const auto at = [&](std::int64_t x) { return mean(part(peak, x - reach, x + reach)); };
    const double half = 0.5 * (at(middle - length / 4) + at(middle + length / 4));
    return center / std::max(half, 1e-6);
}

double body_brightness(const Image& light) {
    const Image smooth = convolved_with_gaussian(light, body_blur_px);
    const float threshold = least_of_body * *std::max_element(smooth.pixels.begin(), smooth.pixels.end());
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        if (!(smooth.pixels[i] > threshold)) continue;
        sum += double(light.pixels[i]);
        count += 1.0;
    }
    return double(display_srgb(float(sum / count)));
}

}  // namespace

EdgeOnProfile edge_on_profile(const Image& edge_view) {
    const Image light = brightest_channel(edge_view);
    const auto [rows, columns] = mean_profiles(light);
    if (rows.empty() || columns.empty() || !(std::ranges::max(rows) > 0.0)) return {};
    const Span half = span_above(rows, 0.5 * std::ranges::max(rows)),
               disk = span_above(columns, 0.15 * std::ranges::max(columns));
    EdgeOnProfile result;
    result.fwhm_over_length = double(half.length()) / double(disk.length());
    result.dust_dip = depth_of_lane(rows, half);
    result.center_over_half = center_over_half_radius(light, columns, disk);
    result.body_srgb = body_brightness(light);
    return result;
}

namespace {

constexpr std::size_t most_points = 400;
constexpr std::int64_t edge_px = 12, peak_reach_px = 4;
constexpr std::int64_t reach_px = 9, side_px = 2 * reach_px + 1;  // of the square around a point
constexpr float least_height = 1e-4f;  // of white: below, peaks are those of rounding
constexpr double needle_elongation = 1.6;
constexpr double pixel_variance = 0.08;  // px^2, so that a single pixel has a width (about 1/12)
constexpr float background_share = 0.35f;

struct Peak {
    std::int64_t x, y;
    float height;
};

// The strongest first; of equal ones the first from the top left.
std::vector<Peak> strongest_peaks(const Image& image) {
    std::vector<Peak> peaks =
        found_by_rows(image, edge_px, [&](std::int64_t x, std::int64_t y) -> std::optional<Peak> {
            const float height = *image.at(x, y);
            if (height < least_height || !is_peak(image, x, y, peak_reach_px)) return {};
            return Peak{x, y, height};
        });
    std::stable_sort(peaks.begin(), peaks.end(),
                     [](const Peak& a, const Peak& b) { return a.height > b.height; });
    if (peaks.size() > most_points) peaks.resize(most_points);
    return peaks;
}

using Square = std::array<float, std::size_t(side_px* side_px)>;

// Light above the surroundings of a point, 0 elsewhere.
Square standing_out(const Image& brightness, const Peak& peak) {
    Square square;
    for (std::int64_t j = 0; j < side_px; ++j)
        std::copy_n(brightness.at(peak.x - reach_px, peak.y + j - reach_px), side_px,
                    square.data() + j * side_px);
    const float middle = median(Square(square));
    const float center = *brightness.at(peak.x, peak.y);
    const float floor = middle + background_share * (center - middle);
    for (float& value : square) value = std::max(value - floor, 0.0f);
    return square;
}

// Keeps what is connected with the middle, side by side; false where there is nothing.
bool keep_connected(Square& square) {
    PixelMask mask = make_mask(side_px, side_px);
    for (std::size_t i = 0; i < square.size(); ++i) mask.pixels[i] = square[i] > 0.0f;
    const PixelPart part = take_part(mask, reach_px * side_px + reach_px, Touching::sides);
    for (std::size_t i = 0; i < square.size(); ++i)
        if (mask.pixels[i]) square[i] = 0.0f;
    return !part.pixels.empty();
}

// Length from top to bottom over width; nothing where the point does not stand out.
std::optional<double> elongation(const Image& brightness, const Peak& peak) {
    Square square = standing_out(brightness, peak);
    if (!keep_connected(square)) return std::nullopt;
    double sum = 0.0, x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
    for (std::int64_t i = 0; i < side_px * side_px; ++i) {
        const double w = square[i];
        const auto x = double(i % side_px - reach_px), y = double(i / side_px - reach_px);
        sum += w;
        x1 += w * x;
        y1 += w * y;
        x2 += w * x * x;
        y2 += w * y * y;
    }
    const double vx = x2 / sum - (x1 / sum) * (x1 / sum), vy = y2 / sum - (y1 / sum) * (y1 / sum);
    return std::sqrt((vy + pixel_variance) / (vx + pixel_variance));
}

}  // namespace

Needles needles(const Image& side_view) {
    const Image brightness = display_max(side_view);
    Image detail = convolved_with_gaussian(brightness, 1.0);
    const Image surroundings = convolved_with_gaussian(brightness, 7.0);
    for (std::size_t i = 0; i < detail.pixels.size(); ++i) detail.pixels[i] -= surroundings.pixels[i];
    Needles result;
    int long_ones = 0;
    for (const Peak& peak : strongest_peaks(detail)) {
        const std::optional<double> e = elongation(brightness, peak);
        if (!e) continue;
        ++result.points;
        long_ones += *e > needle_elongation;
    }
    if (result.points > 0) result.share = double(long_ones) / result.points;
    return result;
}

Needles flat_needles(const Image& picture) {
    const PixelMap half_as_high{{}, {1.0, 0.0, 0.0, 2.0}};
    return needles(resampled(picture, half_as_high, picture.width, picture.height / 2, 0.5));
}

namespace {

Image blurred_along_x(const Image& light, double sigma_px) {
    Image out = unfilled_image(light.width, light.height, 1);
    Image row = unfilled_image(light.width, 1, 1);
    for (std::int64_t y = 0; y < light.height; ++y) {
        std::copy_n(light.at(0, y), light.width, row.pixels.data());
        std::ranges::copy(convolved_with_gaussian(row, sigma_px).pixels, out.at(0, y));
    }
    return out;
}

// Of an octave: the median of what the band is of the local mean, where that is not dark.
double local_contrast(const Image& light, double octave_px) {
    constexpr double half_octave = 1.4, lit_share = 0.15, lit_percentile = 0.99;
    constexpr float least_mean = 1e-4f;
    const Image fine = blurred_along_x(light, octave_px / half_octave),
                coarse = blurred_along_x(light, octave_px * half_octave),
                mean = gaussian_blur(light, 2.0 * octave_px);
    const auto lit = float(lit_share * percentile({mean.pixels.begin(), mean.pixels.end()}, lit_percentile));
    std::vector<float> contrast;
    for (std::size_t i = 0; i < light.pixels.size(); ++i)
        if (mean.pixels[i] > lit)
            contrast.push_back(std::fabs(fine.pixels[i] - coarse.pixels[i]) / (mean.pixels[i] + least_mean));
    return contrast.empty() ? 0.0 : double(median(contrast));
}

// Minor over major axis of the part above a level that holds the brightest place.
std::optional<double> isophote_roundness(const Image& light, std::size_t brightest, float level) {
    constexpr std::size_t fewest = 50;  // pixels
    PixelMask mask = make_mask(light.width, light.height);
    for (std::size_t i = 0; i < light.pixels.size(); ++i) mask.pixels[i] = light.pixels[i] > level;
    const PixelPart part = take_part(mask, std::int64_t(brightest), Touching::sides);
    if (part.pixels.size() < fewest) return {};
    double x1 = 0.0, y1 = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    for (const auto pixel : part.pixels) {
        const auto x = double(std::int64_t(pixel) % light.width),
                   y = double(std::int64_t(pixel) / light.width);
        x1 += x, y1 += y, xx += x * x, yy += y * y, xy += x * y;
    }
    const auto n = double(part.pixels.size());
    xx = xx / n - x1 * x1 / (n * n), yy = yy / n - y1 * y1 / (n * n), xy = xy / n - x1 * y1 / (n * n);
    const double half = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy), mean = 0.5 * (xx + yy);
    return std::sqrt(std::max(0.0, mean - half) / (mean + half));
}

double roundness_of(const Image& above) {
    constexpr double blur_px = 8.0, dark_percentile = 0.05;
    Image light = gaussian_blur(brightest_channel(above), blur_px);
    const auto dark = float(percentile({light.pixels.begin(), light.pixels.end()}, dark_percentile));
    for (float& value : light.pixels) value -= dark;
    const auto brightest = std::size_t(std::ranges::max_element(light.pixels) - light.pixels.begin());
    double sum = 0.0, count = 0.0;
    for (const float share : {0.35f, 0.5f, 0.7f}) {
        const std::optional<double> found =
            isophote_roundness(light, brightest, share * light.pixels[brightest]);
        if (found) sum += *found, count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

double grain_of(const Image& above) {
    constexpr double least_blur_px = 0.8, around_px = 8.0, detail_px = 4.0;
    constexpr float lit = 0.06f;  // of white, as displayed
    const Image shown = made_by_pixel(above, 3, [](const float* from, float* to) {
        for (int c = 0; c < 3; ++c) to[c] = display_srgb(from[c]);
    });
    const Image light = convolved_with_gaussian(mean_of_channels(shown), least_blur_px),
                around = gaussian_blur(light, around_px), detail = gaussian_blur(light, detail_px);
    double along_x = 0.0, along_y = 0.0;
    for (std::int64_t y = 1; y + 1 < light.height; ++y)
        for (std::int64_t x = 1; x + 1 < light.width; ++x) {
            if (!(*around.at(x, y) > lit)) continue;
            const auto dx = double(*detail.at(x + 1, y) - *detail.at(x - 1, y)),
                       dy = double(*detail.at(x, y + 1) - *detail.at(x, y - 1));
            along_x += dx * dx, along_y += dy * dy;
        }
    return along_y > 0.0 ? along_x / along_y : 0.0;
}

}  // namespace

double mottle(const Image& front, const Image& tilted) {
    const Image flat = mean_of_channels(front), aside = mean_of_channels(tilted);
    double most = 0.0;
    for (const double octave_px : {2.0, 4.0, 8.0, 16.0, 32.0}) {
        const double before = local_contrast(flat, octave_px);
        if (before > 0.0) most = std::max(most, local_contrast(aside, octave_px) / before);
    }
    return most;
}

DiskFromAbove disk_from_above(const Image& above) {
    if (above.pixels.empty() || !(std::ranges::max(above.pixels) > 0.0f)) return {};
    return {roundness_of(above), grain_of(above)};
}

}  // namespace astrosplat
