// Two steps. The search correlates the images at about 32 px, for every turn and scale with all shifts at
// once by Fourier transforms, each shift normalised over what overlaps there (Padfield, IEEE CVPR 2010). The
// best places are then refined from level to level of a pyramid by Gauss-Newton steps on shift, turn, scale,
// gain and offset.
#include "prepare/registration.h"

#include "core/parallel.h"
#include "core/real.h"
#include "core/rotation.h"
#include "image/blur.h"
#include "image/channels.h"
#include "prepare/least_squares.h"

namespace astrosplat {
namespace {

// ---- The discrete Fourier transform of small square grids, by radix 2, in place.

/// side x side complex numbers, row by row; side is a power of 2.
struct ComplexGrid {
    explicit ComplexGrid(int side_)
        : side(side_), re(std::size_t(side_) * std::size_t(side_)), im(re.size()) {}
    int side;
    std::vector<float> re, im;

    std::size_t row(int y) const { return std::size_t(y) * std::size_t(side); }
};

void swap_rows(ComplexGrid& grid, int a, int b) {
    for (std::vector<float>* part : {&grid.re, &grid.im})
        std::swap_ranges(part->begin() + grid.row(a), part->begin() + grid.row(a + 1),
                         part->begin() + grid.row(b));
}

void reverse_bits_of_rows(ComplexGrid& grid) {
    for (int i = 1, reversed = 0; i < grid.side; ++i) {
        int bit = grid.side >> 1;
        for (; reversed & bit; bit >>= 1) reversed ^= bit;
        reversed ^= bit;
        if (i < reversed) swap_rows(grid, i, reversed);
    }
}

/// Row a becomes a + w b, row b a - w b.
void butterfly(ComplexGrid& grid, int a, int b, float w_re, float w_im) {
    const std::size_t side = std::size_t(grid.side);
    float *const a_re = &grid.re[grid.row(a)], *const a_im = &grid.im[grid.row(a)];
    float *const b_re = &grid.re[grid.row(b)], *const b_im = &grid.im[grid.row(b)];
    for (std::size_t x = 0; x < side; ++x) {
        const float re = w_re * b_re[x] - w_im * b_im[x], im = w_re * b_im[x] + w_im * b_re[x];
        b_re[x] = a_re[x] - re;
        b_im[x] = a_im[x] - im;
        a_re[x] += re;
        a_im[x] += im;
    }
}

/// `sign` of the exponent.
void transform_columns(ComplexGrid& grid, double sign) {
    reverse_bits_of_rows(grid);
    for (int half = 1; half < grid.side; half *= 2)
        for (int k = 0; k < half; ++k) {
            const double angle = sign * real::pi * k / half;
            const auto w_re = float(real::cos(angle)), w_im = float(real::sin(angle));
            for (int block = 0; block < grid.side; block += 2 * half)
                butterfly(grid, block + k, block + k + half, w_re, w_im);
        }
}

void transpose(std::vector<float>& values, std::size_t side) {
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < y; ++x) std::swap(values[y * side + x], values[x * side + y]);
}

/// To the spectrum with its two axes exchanged.
void transform(ComplexGrid& grid, double sign = -1.0) {
    transform_columns(grid, sign);
    transpose(grid.re, std::size_t(grid.side));
    transpose(grid.im, std::size_t(grid.side));
    transform_columns(grid, sign);
}

/// From such a spectrum back, scaled by 1 / side^2.
void transform_back(ComplexGrid& grid) {
    transform(grid, 1.0);
    const auto scale = float(1.0 / (double(grid.side) * double(grid.side)));
    for (std::size_t i = 0; i < grid.re.size(); ++i) {
        grid.re[i] *= scale;
        grid.im[i] *= scale;
    }
}

constexpr std::int64_t searched_px = 32, refined_px = 512;  // longest sides of the levels that are compared
constexpr std::int64_t smallest_px = 8;                     // of the moving image's pyramid
constexpr double noticeable = 0.002;         // likeness by which another place must be better than the first
constexpr double least_likeness = 0.5;       // correlation, without which there is no answer
constexpr double least_overlap = 1.0 / 3.0;  // of the smaller image
constexpr float least_spread = 2e-3f;        // standard deviation of display values; below, an image is flat

using Pyramid = std::vector<Image>;  // from large to small

std::int64_t longest_side(const Image& image) { return std::max(image.width, image.height); }

Pyramid pyramid_of(const Image& image, std::int64_t least_px) {
    Pyramid levels{image};
    while (longest_side(levels.back()) > least_px) levels.push_back(halved(levels.back()));
    return levels;
}

glm::dvec2 size_of(const Image& image) { return {double(image.width), double(image.height)}; }

/// The same place where `fixed` is `factor` times as large.
ImageOnImage zoomed(ImageOnImage place, double factor) {
    place.middle *= factor;
    place.scale *= factor;
    return place;
}

/// `moving` as it lies on a grid of width x height px, and where it is: 1 inside, 0 outside.
struct Laid {
    Image values, mask;
};

/// Of the pyramid the level is read whose pixels are about as large as the grid's.
Laid laid(const Pyramid& moving, const ImageOnImage& place, std::int64_t width, std::int64_t height) {
    const double reduction = std::max(0.0, real::log(1.0 / place.scale) / real::log(2.0));
    const auto level = std::min(std::size_t(std::lround(reduction)), moving.size() - 1);
    const Image& image = moving[level];
    const double reduced = std::ldexp(1.0, -int(level)),
                 texels = reduced / place.scale;  // per px
    const glm::dvec2 middle = 0.5 * reduced * size_of(moving[0]);
    const double angle = real::radians(place.turn_deg), c = real::cos(angle) * texels,
                 s = real::sin(angle) * texels;
    Laid result{make_image(width, height, 1), make_image(width, height, 1)};
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            const double dx = double(x) + 0.5 - place.middle.x, dy = double(y) + 0.5 - place.middle.y;
            const double u = middle.x + c * dx - s * dy, v = middle.y + s * dx + c * dy;
            if (u < 0.0 || v < 0.0 || u > size_of(image).x || v > size_of(image).y) continue;
            *result.values.at(x, y) = bilinear(image, 0, float(u), float(v));
            *result.mask.at(x, y) = 1.0f;
        }
    return result;
}

/// Sums over the pixels that two images share.
struct Sums {
    double count = 0.0, f = 0.0, t = 0.0, ff = 0.0, tt = 0.0, ft = 0.0;
    void add(double here, double there) {
        count += 1.0;
        f += here;
        t += there;
        ff += here * here;
        tt += there * there;
        ft += here * there;
    }
    double correlation() const {
        const double spread_f = ff - f * f / count, spread_t = tt - t * t / count;
        const double least = count * double(least_spread) * double(least_spread);
        return count > 0.0 && spread_f > least && spread_t > least
                   ? (ft - f * t / count) / std::sqrt(spread_f * spread_t)
                   : -1.0;
    }
};

double likeness_of(const Image& fixed, const Laid& moving) {
    Sums sums;
    for (std::size_t i = 0; i < fixed.pixels.size(); ++i) {
        if (moving.mask.pixels[i] != 0.0f) sums.add(fixed.pixels[i], moving.values.pixels[i]);
    }
    return sums.correlation();
}

// ---- The search.

struct Found {
    ImageOnImage place;
    double score = -std::numeric_limits<double>::infinity();
};

/// The spectra of what is correlated with every template: the image, its square, and where it is.
class FixedSpectra {
  public:
    explicit FixedSpectra(const Image& fixed) : width(fixed.width), height(fixed.height) {
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const std::size_t i = std::size_t(y * side + x);
                value.re[i] = *fixed.at(x, y);
                square.re[i] = value.re[i] * value.re[i];
                place.re[i] = 1.0f;
            }
        for (ComplexGrid* grid : {&value, &square, &place}) transform(*grid);
    }
    static constexpr int side = 128;  // of images of at most 32 px and templates of at most 96 px
    std::int64_t width, height;
    ComplexGrid value{side}, square{side}, place{side};
};

/// Two correlations a * conj(b) and c * conj(d), as the real and the imaginary part.
ComplexGrid correlated(const ComplexGrid& a, const ComplexGrid& b, const ComplexGrid& c,
                       const ComplexGrid& d) {
    ComplexGrid sum(a.side);
    for (std::size_t i = 0; i < sum.re.size(); ++i) {
        const float re = a.re[i] * b.re[i] + a.im[i] * b.im[i], im = a.im[i] * b.re[i] - a.re[i] * b.im[i];
        const float re2 = c.re[i] * d.re[i] + c.im[i] * d.im[i], im2 = c.im[i] * d.re[i] - c.re[i] * d.im[i];
        sum.re[i] = re - im2;
        sum.im[i] = im + re2;
    }
    transform_back(sum);
    return sum;
}

/// The best shift of the moving image with this turn and scale; `place.middle` is not looked at.
Found best_shift(const FixedSpectra& fixed, const Pyramid& moving, ImageOnImage place) {
    constexpr int side = FixedSpectra::side, most = 96;
    place.middle = {0.5 * most, 0.5 * most};
    const Laid laid_out = laid(moving, place, most, most);
    ComplexGrid value(side), square(side), mask(side);
    double area = 0.0;
    for (int y = 0; y < most; ++y)
        for (int x = 0; x < most; ++x) {
            const std::size_t i = std::size_t(y) * side + std::size_t(x);
            value.re[i] = *laid_out.values.at(x, y);
            square.re[i] = value.re[i] * value.re[i];
            mask.re[i] = *laid_out.mask.at(x, y);
            area += mask.re[i];
        }
    for (ComplexGrid* grid : {&value, &square, &mask}) transform(*grid);
    const ComplexGrid counts = correlated(fixed.place, mask, fixed.value, mask);
    const ComplexGrid squares = correlated(fixed.square, mask, fixed.place, square);
    const ComplexGrid products = correlated(fixed.value, value, fixed.place, value);
    const double smaller = std::min(area, double(fixed.width * fixed.height));
    Found best;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::size_t i = std::size_t(y) * side + std::size_t(x);
            const Sums sums{counts.re[i],  counts.im[i],  products.im[i],
                            squares.re[i], squares.im[i], products.re[i]};
            if (sums.count < least_overlap * smaller) continue;
            const double score = sums.correlation() * std::sqrt(sums.count / smaller);
            if (score <= best.score) continue;
            // The template's corner lies at (x, y); beyond the image it is left of it or above.
            const double left = x < fixed.width ? x : x - side, top = y < fixed.height ? y : y - side;
            best = {place, score};
            best.place.middle = {left + 0.5 * most, top + 0.5 * most};
        }
    return best;
}

std::vector<Found> searched(const Image& fixed, const Pyramid& moving, const ImageOnImage& start,
                            const Progress& progress) {
    // Every 10 degrees, and from 1 / 2.2 to 2.2 times the scale of the start.
    constexpr int turns = 36, scales = 13;
    constexpr double scale_step = 1.14;
    const FixedSpectra spectra(fixed);
    std::vector<Found> found(turns * scales);
    parallel_for(turns * scales, [&](std::int64_t i, int) {
        progress.check();
        ImageOnImage place = start;
        place.turn_deg += double(i % turns) * (360.0 / turns);
        place.scale *= real::pow(scale_step, double(i / turns - scales / 2));
        found[i] = best_shift(spectra, moving, place);
    });
    std::ranges::stable_sort(found, std::greater{}, &Found::score);
    return found;
}

// ---- Refinement.

/// The unknowns of a step: shift x, shift y, log of the scale, turn (radians), gain less 1, offset.
constexpr std::size_t unknowns = 6;

/// The normal equations of `fixed` = gain * moving, moved + offset. Every pixel says how the values there
/// change as the image moves under it.
LeastSquares<unknowns> equations_of(const Image& fixed, const Laid& moving, const ImageOnImage& place) {
    LeastSquares<unknowns> system;
    const Image &t = moving.values, &m = moving.mask;
    for (std::int64_t y = 1; y + 1 < fixed.height; ++y)
        for (std::int64_t x = 1; x + 1 < fixed.width; ++x) {
            const bool inside =
                *m.at(x, y) * *m.at(x - 1, y) * *m.at(x + 1, y) * *m.at(x, y - 1) * *m.at(x, y + 1) > 0.0f;
            if (!inside) continue;
            const double gx = 0.5 * (double(*t.at(x + 1, y)) - double(*t.at(x - 1, y)));
            const double gy = 0.5 * (double(*t.at(x, y + 1)) - double(*t.at(x, y - 1)));
            const double dx = double(x) + 0.5 - place.middle.x, dy = double(y) + 0.5 - place.middle.y;
            const Vector<unknowns> row{
                -gx, -gy, -(gx * dx + gy * dy), -(gx * dy - gy * dx), double(*t.at(x, y)), 1.0};
            system.add(row, double(*fixed.at(x, y)));
        }
    return system;
}

/// The place after one step; empty where the images say nothing.
std::optional<ImageOnImage> stepped(const Image& fixed, const Laid& moving, ImageOnImage place) {
    LeastSquares<unknowns> system = equations_of(fixed, moving, place);
    // A turn of something round, or a shift along an edge, stays: each costs a little.
    constexpr double damping = 1e-3;
    const double shifts = damping * (system.squares[0][0] + system.squares[1][1]);
    const double quarter = 0.25 * double(longest_side(fixed));
    for (std::size_t i = 0; i < 4; ++i) system.squares[i][i] += i < 2 ? shifts : shifts * quarter * quarter;
    const std::optional<Vector<unknowns>> solution = solved(system.squares, system.products);
    constexpr double least_gain = 1e-3;  // below, or negative: not the same light
    if (!solution || !((*solution)[4] > least_gain)) return std::nullopt;
    const auto change = [&](std::size_t i, double most) {
        return std::clamp((*solution)[i] / (*solution)[4], -most, most);
    };
    constexpr double most_px = 3.0, most_scaled = 0.1, most_turned = 0.1;  // in one step; logarithm, radians
    place.middle += glm::dvec2(change(0, most_px), change(1, most_px));
    place.scale *= real::exp(change(2, most_scaled));
    place.turn_deg += real::degrees(change(3, most_turned));
    return place;
}

/// From `place`, in px of `fixed`; the score is the likeness.
Found refined(const Image& fixed, const Pyramid& moving, ImageOnImage place) {
    constexpr int steps = 15;
    constexpr double still = 1e-4, still_scale = 1e-5;  // px, share: what moves less has arrived
    Found best;
    for (int step = 0; step < steps; ++step) {
        const Laid now = laid(moving, place, fixed.width, fixed.height);
        if (const double likeness = likeness_of(fixed, now); likeness > best.score) best = {place, likeness};
        const std::optional<ImageOnImage> next = stepped(fixed, now, place);
        if (!next) break;
        const double moved =
            std::fabs(next->middle.x - place.middle.x) + std::fabs(next->middle.y - place.middle.y);
        place = *next;
        if (moved < still && std::fabs(place.scale / best.place.scale - 1.0) < still_scale) break;
    }
    return best;
}

double overlap_of(const Image& fixed, const Pyramid& moving, const ImageOnImage& place) {
    const Laid now = laid(moving, place, fixed.width, fixed.height);
    double shared = 0.0;
    for (const float inside : now.mask.pixels) shared += inside;
    const double area = size_of(moving[0]).x * size_of(moving[0]).y * place.scale * place.scale;
    return shared / std::min(area, double(fixed.width * fixed.height));
}

bool is_flat(const Image& image) {
    Sums sums;
    for (const float value : image.pixels) sums.add(value, value);
    return sums.ff / sums.count - sums.f * sums.f / (sums.count * sums.count) <
           double(least_spread) * double(least_spread);
}

}  // namespace

std::optional<Registration> registered(const Image& fixed, const Image& moving, const ImageOnImage& start,
                                       const Progress& progress) {
    if (is_flat(fixed) || is_flat(moving)) return std::nullopt;
    const Pyramid views = pyramid_of(fixed, searched_px), images = pyramid_of(moving, smallest_px);
    std::size_t level = views.size() - 1, kept = 12;  // places; of them a third goes on at each level
    const ImageOnImage small_start = zoomed(start, std::ldexp(1.0, -int(level)));
    std::vector<Found> found = searched(views[level], images, small_start, progress);
    found.resize(std::min(found.size(), kept));
    found.insert(found.begin(), {small_start});
    for (;; --level) {
        for (Found& each : found) {
            progress.check();
            each = refined(views[level], images, each.place);
        }
        std::ranges::stable_sort(found.begin() + 1, found.end(), std::greater(), &Found::score);
        kept = std::max<std::size_t>(1, kept / 3);
        found.resize(std::min(found.size(), kept + 1));
        if (level == 0 || longest_side(views[level]) * 2 > refined_px) break;
        for (Found& each : found) each.place = zoomed(each.place, 2.0);
    }
    const Found& best = found[1].score > found[0].score + noticeable ? found[1] : found[0];
    if (best.score < least_likeness || overlap_of(views[level], images, best.place) < least_overlap)
        return std::nullopt;
    Registration result{zoomed(best.place, std::ldexp(1.0, int(level))), best.score};
    result.place.turn_deg = within_half_turn(result.place.turn_deg);
    return result;
}

}  // namespace astrosplat
