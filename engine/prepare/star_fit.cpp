// Profiles are exp(-u), and (1 + u)^-beta with u = (r / a)^2 (Moffat 1969, A&A 3, 455). A fit has seven
// numbers a star: height, place, logarithm of the width, and a plane as background.
#include "prepare/star_fit.h"

#include "core/real.h"
#include "image/channels.h"
#include "prepare/least_squares.h"

namespace astrosplat {
namespace {

// Exponents; the first stands for the Gaussian.
constexpr std::array<double, star_shapes> betas{0.0, 6.0, 4.0, 3.0, 2.5};

double inverse_power(int shape, double q) {
    const double squared = 1.0 / (q * q);
    switch (shape) {
        case 1:
            return squared * squared * squared;
        case 2:
            return squared * squared;
        case 3:
            return squared / q;
        default:
            return squared / std::sqrt(q);
    }
}

// u at half of the peak.
double half_unit(int shape) {
    static const std::array<double, star_shapes> units = [] {
        std::array<double, star_shapes> u{real::log(2.0)};
        for (std::size_t i = 1; i < u.size(); ++i) u[i] = real::pow(2.0, 1.0 / betas[i]) - 1.0;
        return u;
    }();
    return units[shape];
}

}  // namespace

double unit_of(const StarProfile& profile) {
    return 4.0 * half_unit(profile.shape) / (profile.fwhm_px * profile.fwhm_px);
}

ProfileValue profile_at(int shape, double u) {
    assert(shape >= 0 && shape < star_shapes);
    if (shape == 0) {
        const double value = real::exp(-u);
        return {value, -value};
    }
    const double q = 1.0 + u, value = inverse_power(shape, q);
    return {value, -betas[shape] * value / q};
}

double integral_of(const StarProfile& profile) {
    const double gaussian = real::pi / unit_of(profile);
    return profile.shape == 0 ? gaussian : gaussian / (betas[profile.shape] - 1.0);
}

double reach_of(const StarProfile& profile, double share) {
    if (!(share < 1.0)) return 0.0;
    const double beta = betas[profile.shape];
    const double u = profile.shape == 0 ? -real::log(share) : real::pow(share, -1.0 / beta) - 1.0;
    return std::sqrt(u / unit_of(profile));
}

namespace {

constexpr int most_steps = 12;
constexpr double damping = 1e-3;          // of the diagonal
constexpr double farthest_step_px = 0.5;  // in one step
constexpr double most_widened = 0.3;      // of the width's logarithm, in one step
constexpr std::size_t fewest_samples = 12;
constexpr double farthest_move_px = 1.2, move_of_core = 0.5;  // from where the star was seen; core radii more
constexpr double widest_over_usual = 4.0;  // times the field's width and the core, beyond which a fit is none
constexpr double fit_widths = 2.0, fit_more_px = 1.0, fit_least_px = 4.0,
                 fit_most_px = 12.0;    // of its radius
constexpr double fit_cores = 2.0;       // radii, that a saturated star's fit reaches out more, and is wider
constexpr double reach_cores = 8.0;     // radii, that it is taken away out to beyond the widest reach
constexpr double small_step = 1e-4;     // px and width's logarithm, that end a fit
constexpr double no_fit = 1e30;         // squares left where nothing fits: finite, for two are subtracted
constexpr double other_width = 3.0;     // times the spread: the field's width counts ever less beyond
constexpr double faintest_share = 0.1;  // of the noise: add_star ends there

// A usable pixel near a star: its place and the light of r, g, b.
struct Sample {
    double x, y;
    std::array<double, 3> light;

    double mean() const { return (light[0] + light[1] + light[2]) / 3.0; }
};

std::vector<Sample> samples_near(const Image& image, const PixelMask& unusable, double x, double y,
                                 double radius) {
    std::vector<Sample> samples;
    for_each_within(image, x, y, radius, [&](std::int64_t i, std::int64_t j, double, double) {
        const float* const p = image.at(i, j);
        if (!unusable.at(i, j)) samples.push_back({double(i) + 0.5, double(j) + 0.5, {p[0], p[1], p[2]}});
    });
    return samples;
}

double fit_radius(const StarProfile& profile, double core) {
    return std::clamp(fit_widths * profile.fwhm_px + fit_more_px, fit_least_px, fit_most_px) +
           fit_cores * core;
}

// The star's shape as the fit moves it, with the background under it.
struct Trial {
    PictureStar star;
    double height = 0.0;
    Vector<3> plane{};  // light at the star, and its slopes in x and y
};

struct Row {
    Vector<7> design;  // by height, x, y, log width, plane
    double model;
};

Row row_at(const Trial& trial, double unit, const Sample& sample) {
    const double dx = sample.x - trial.star.x, dy = sample.y - trial.star.y;
    const double u = unit * (dx * dx + dy * dy);
    const ProfileValue p = profile_at(trial.star.profile.shape, u);
    const double moved = -2.0 * unit * trial.height * p.slope;
    return {{p.value, moved * dx, moved * dy, -2.0 * u * trial.height * p.slope, 1.0, dx, dy},
            trial.height * p.value + trial.plane[0] + trial.plane[1] * dx + trial.plane[2] * dy};
}

std::optional<Vector<7>> next_step(const Trial& trial, const std::vector<Sample>& samples,
                                   const StarWidths& widths, double pixel_noise) {
    LeastSquares<7> sums;
    const double unit = unit_of(trial.star.profile);
    for (const Sample& sample : samples) {
        const Row row = row_at(trial, unit, sample);
        sums.add(row.design, sample.mean() - row.model);
    }
    const double away = real::log(trial.star.profile.fwhm_px / widths.fwhm_px);
    const double too_far = away / (other_width * widths.log_spread);
    const double weight = pixel_noise / (widths.log_spread * (1.0 + too_far * too_far));
    sums.add({0.0, 0.0, 0.0, weight, 0.0, 0.0, 0.0}, -weight * away);
    for (std::size_t i = 0; i < 7; ++i) sums.squares[i][i] *= 1.0 + damping;
    return solved(sums.squares, sums.products);
}

// Applies a step, held to what is sensible; returns whether it was small.
bool take_step(Trial& trial, const Vector<7>& step) {
    const double dx = std::clamp(step[1], -farthest_step_px, farthest_step_px);
    const double dy = std::clamp(step[2], -farthest_step_px, farthest_step_px);
    const double wider = std::clamp(step[3], -most_widened, most_widened);
    trial.height += step[0];
    trial.star.x += dx;
    trial.star.y += dy;
    trial.star.profile.fwhm_px = std::max(narrowest_fwhm_px, trial.star.profile.fwhm_px * real::exp(wider));
    for (std::size_t i = 0; i < 3; ++i) trial.plane[i] += step[4 + i];
    return std::fabs(dx) + std::fabs(dy) + std::fabs(wider) < small_step;
}

// By height and plane: of a star whose place and width are known.
Vector<4> height_row(const PictureStar& star, double unit, const Sample& sample) {
    const double dx = sample.x - star.x, dy = sample.y - star.y;
    return {profile_at(star.profile.shape, unit * (dx * dx + dy * dy)).value, 1.0, dx, dy};
}

// The height in each channel, and the misfit of their mean.
bool fit_heights(PictureStar& star, const std::vector<Sample>& samples) {
    std::array<LeastSquares<4>, 3> sums;
    std::vector<Vector<4>> rows;
    const double unit = unit_of(star.profile);
    for (const Sample& sample : samples) {
        rows.push_back(height_row(star, unit, sample));
        for (std::size_t c = 0; c < 3; ++c) sums[c].add(rows.back(), sample.light[c]);
    }
    Vector<4> mean{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto solution = solved(sums[c].squares, sums[c].products);
        if (!solution) return false;
        star.amplitude[c] = (*solution)[0];
        for (std::size_t i = 0; i < 4; ++i) mean[i] += (*solution)[i] / 3.0;
    }
    double squares = 0.0, count = 0.0;
    const double near = star.profile.fwhm_px + star.core_px;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double dx = rows[k][2], dy = rows[k][3];
        if (dx * dx + dy * dy > near * near) continue;
        const double d = samples[k].mean() - (rows[k][0] * mean[0] + mean[1] + dx * mean[2] + dy * mean[3]);
        squares += d * d;
        count += 1.0;
    }
    star.misfit = count > 0.0 ? std::sqrt(squares / count) : 0.0;
    return true;
}

// Height and background by themselves, to begin with.
bool start_trial(Trial& trial, const std::vector<Sample>& samples) {
    LeastSquares<4> sums;
    const double unit = unit_of(trial.star.profile);
    for (const Sample& sample : samples) sums.add(height_row(trial.star, unit, sample), sample.mean());
    const auto solution = solved(sums.squares, sums.products);
    if (!solution || !((*solution)[0] > 0.0)) return false;
    trial.height = (*solution)[0];
    trial.plane = {(*solution)[1], (*solution)[2], (*solution)[3]};
    return true;
}

double squares_left(const std::vector<Sample>& samples, const PictureStar& star) {
    Trial trial{star};
    if (!start_trial(trial, samples)) return no_fit;
    double squares = 0.0;
    const double unit = unit_of(star.profile);
    for (const Sample& sample : samples) {
        const double d = sample.mean() - row_at(trial, unit, sample).model;
        squares += d * d;
    }
    return squares / (star.pixel_noise * star.pixel_noise);
}

}  // namespace

bool fit_star(const Image& image, const PixelMask& unusable, const StarWidths& widths, PictureStar& star) {
    assert(image.channels >= 3);
    Trial trial{star};
    const double radius = fit_radius(star.profile, star.core_px);
    const std::vector<Sample> samples = samples_near(image, unusable, star.x, star.y, radius);
    if (samples.size() < fewest_samples || !start_trial(trial, samples)) return false;
    const double widest = widest_over_usual * (widths.fwhm_px + fit_cores * star.core_px);
    for (int step = 0; step < most_steps; ++step) {
        const auto found = next_step(trial, samples, widths, star.pixel_noise);
        if (!found) return false;
        const bool done = take_step(trial, *found);
        const double moved = std::hypot(trial.star.x - star.seen_x, trial.star.y - star.seen_y);
        if (moved > farthest_move_px + move_of_core * star.core_px || trial.star.profile.fwhm_px > widest)
            return false;
        if (done) break;
    }
    if (!(trial.height > 0.0) || !fit_heights(trial.star, samples)) return false;
    if (!(trial.star.mean_amplitude() > 0.0)) return false;
    star = trial.star;
    return true;
}

double shape_misfit(const Image& image, const PixelMask& unusable, const PictureStar& star,
                    const StarProfile& window) {
    const double radius = fit_radius(window, star.core_px);
    return squares_left(samples_near(image, unusable, star.x, star.y, radius), star);
}

double shape_misfit_of_taken(const Image& image, const PixelMask& unusable, const PictureStar& star,
                             const StarProfile& profile) {
    std::vector<Sample> samples =
        samples_near(image, unusable, star.x, star.y, fit_radius(star.profile, star.core_px));
    const double unit = unit_of(star.profile);
    for (Sample& sample : samples) {
        const double dx = sample.x - star.x, dy = sample.y - star.y;
        const double value = profile_at(star.profile.shape, unit * (dx * dx + dy * dy)).value;
        for (std::size_t c = 0; c < 3; ++c) sample.light[c] += star.amplitude[c] * value;
    }
    PictureStar other = star;
    other.profile = profile;
    return squares_left(samples, other);
}

double reach_px(const PictureStar& star) {
    const double height = *std::max_element(star.amplitude.begin(), star.amplitude.end());
    if (!(height > 0.0)) return 0.0;
    const double reach = reach_of(star.profile, faintest_share * star.noise / height);
    return std::min(reach, widest_reach_px + reach_cores * star.core_px);
}

void add_star(Image& image, const PictureStar& star, float sign) {
    const double unit = unit_of(star.profile);
    for_each_within(image, star.x, star.y, reach_px(star),
                    [&](std::int64_t i, std::int64_t j, double dx, double dy) {
                        const double value = profile_at(star.profile.shape, unit * (dx * dx + dy * dy)).value;
                        float* const p = image.at(i, j);
                        for (std::size_t c = 0; c < 3; ++c) p[c] += sign * float(star.amplitude[c] * value);
                    });
}

}  // namespace astrosplat
