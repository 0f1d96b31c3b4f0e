// Stars are fitted in the picture without all others, tile by tile: tiles of one colour are far enough apart
// not to touch the same pixels, so that they can be worked at on all threads and every sum has its order.
// After their subtraction the cores are filled. Tables have six digits: more than any picture tells.
#include "prepare/star_removal.h"

#include <fmt/format.h>

#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"
#include "detect/background.h"
#include "detect/peaks.h"
#include "image/channels.h"
#include "prepare/stages.h"

namespace astrosplat {
namespace {

// Found by painting stars of known light into M101, M42 and clouds: most are found again, few that are none.
constexpr std::int64_t tile_px = 64;     // more than twice the reach of a star
constexpr double kernel_sigma_px = 1.2;  // of the kernel that finds candidates
constexpr double telling = 8.0;          // signal to noise of stars that together tell the field's profile
constexpr std::size_t fewest_telling = 8, most_telling = 1000;
constexpr double wider = 1.5;  // times the field's width: stars from which on may have one of their own
constexpr std::size_t fewest_wider = 200, most_telling_of_wider = 4000;
constexpr double model_error = 0.03;           // of a star's height, by which no profile is to be trusted
constexpr double width_error = 1.3;            // of a width's logarithm, times the signal to noise
constexpr double shaped = 20.0;                // signal to noise of stars that may have a shape of their own
constexpr double clearly_worse = 6.0;          // misfit from which a star has no more to say
constexpr double clearly_better = 2.0;         // by which a shape's misfit must be less than the field's
constexpr double least_share_of_others = 0.1;  // of the light taken away before, that a later find must have
constexpr double least_width_spread = 0.05, most_width_spread = 0.4;  // of widths' logarithms
constexpr double widest_fwhm_px = 5.2, widest_of_field = 1.8;  // px, or times the field's, whichever is more
constexpr double kept_threshold = 0.8;  // times the search's, that a fitted height must have
constexpr double misfit_of_noise = 3.0, misfit_of_height = 0.15;  // that a star's fit may leave
constexpr double saturated_noise = 1e-3;  // of white, in which the wings of the brightest stars are lost
constexpr double least_noise = 1e-4;      // of the brightest lights: black skies without any noise

struct Search {
    Image image;         // less the stars found
    Image before;        // brightness with all of them
    Cells noise;         // of heights
    PixelMask unusable;  // saturated or covered pixels
    PixelMask covered;
    StarWidths widths;                   // of most stars
    std::optional<StarWidths> of_wider;  // of those that are clearly wider, where there are many
    std::vector<PictureStar> stars;
    std::vector<unsigned char> lost;  // 1: not a star
};

// The profile for a star: the one whose width is nearer to its own, as a ratio.
const StarWidths& widths_for(const Search& search, const PictureStar& star) {
    const double width = star.profile.fwhm_px;
    const bool is_wider = search.of_wider && width * width > search.widths.fwhm_px * search.of_wider->fwhm_px;
    return is_wider ? *search.of_wider : search.widths;
}

// Calls visit(star index) for the stars [first, ..) of each tile, the brightest first.
template <class Visit>
void for_each_by_tiles(const Search& search, std::size_t first, const Progress& progress,
                       const Visit& visit) {
    const std::int64_t columns = search.image.width / tile_px + 1, rows = search.image.height / tile_px + 1;
    std::vector<std::vector<std::size_t>> tiles(std::size_t(columns * rows));
    for (std::size_t i = first; i < search.stars.size(); ++i) {
        if (search.lost[i]) continue;
        const auto tile = [](double at, std::int64_t count) {
            return std::clamp<std::int64_t>(std::int64_t(at) / tile_px, 0, count - 1);
        };
        tiles[tile(search.stars[i].y, rows) * columns + tile(search.stars[i].x, columns)].push_back(i);
    }
    const auto brighter = [&](std::size_t a, std::size_t b) {
        const double p = search.stars[a].mean_amplitude(), q = search.stars[b].mean_amplitude();
        return p != q ? p > q : a < b;
    };
    for (std::int64_t color = 0; color < 4; ++color) {
        const std::int64_t across = (columns - color % 2 + 1) / 2, down = (rows - color / 2 + 1) / 2;
        parallel_each(across * down, 1, [&](std::int64_t i) {
            progress.check();
            const std::int64_t x = 2 * (i % across) + color % 2, y = 2 * (i / across) + color / 2;
            std::vector<std::size_t>& tile = tiles[y * columns + x];
            std::sort(tile.begin(), tile.end(), brighter);
            for (const std::size_t star : tile) visit(star);
        });
    }
}

// Fits each star in the picture that has all others taken away, and takes it away. What finds no place at its
// first fit is none; later ones keep what they had.
void fit_all(Search& search, std::size_t first, const Progress& progress) {
    for_each_by_tiles(search, first, progress, [&](std::size_t i) {
        PictureStar& star = search.stars[i];
        add_star(search.image, star, 1.0f);
        const bool before = star.mean_amplitude() > 0.0;
        const bool found = fit_star(search.image, search.unusable, widths_for(search, star), star);
        search.lost[i] = !found && !before;
        if (!search.lost[i]) add_star(search.image, star, -1.0f);
    });
}

// The stars wider than `least_fwhm_px` that tell most about their profile, the strongest first.
std::vector<std::size_t> telling_stars(const Search& search, double least_fwhm_px, std::size_t most) {
    std::vector<std::size_t> best;
    for (std::size_t i = 0; i < search.stars.size(); ++i) {
        const PictureStar& star = search.stars[i];
        if (!search.lost[i] && !star.saturated && star.signal_to_noise() > telling &&
            star.profile.fwhm_px > least_fwhm_px)
            best.push_back(i);
    }
    std::ranges::stable_sort(best, std::greater(),
                             [&](std::size_t i) { return search.stars[i].signal_to_noise(); });
    if (best.size() > most) best.resize(most);
    return best;
}

// The residual of each profile for a star, in squares of what may be left: noise,
// and an error of the profile.
std::vector<double> misfits_of(const Search& search, const PictureStar& star,
                               const std::vector<StarProfile>& profiles) {
    const double trust = model_error * star.signal_to_noise();
    std::vector<double> misfits;
    for (const StarProfile& profile : profiles)
        misfits.push_back(shape_misfit_of_taken(search.image, search.unusable, star, profile) /
                          (1.0 + trust * trust));
    return misfits;
}

// The profile that describes most of these stars. A profile far from a star's best counts no more than one
// that is clearly worse, so that knots and stars of other widths do not outvote those that agree.
StarProfile elected(const Search& search, const std::vector<std::size_t>& stars,
                    const std::vector<StarProfile>& profiles) {
    std::vector<std::vector<double>> misfits(stars.size());
    parallel_each(stars.size(), 8,
                  [&](std::size_t k) { misfits[k] = misfits_of(search, search.stars[stars[k]], profiles); });
    std::vector<double> sums(profiles.size(), 0.0);
    for (const std::vector<double>& misfit : misfits) {
        const double best = *std::min_element(misfit.begin(), misfit.end());
        for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += std::min(misfit[p] - best, clearly_worse);
    }
    return profiles[std::min_element(sums.begin(), sums.end()) - sums.begin()];
}

// How far the widths of these stars scatter beyond what noise does, as logarithms.
double spread_of(const Search& search, const std::vector<std::size_t>& stars, double fwhm_px) {
    std::vector<double> away, errors;
    for (const std::size_t i : stars) {
        away.push_back(std::fabs(real::log(search.stars[i].profile.fwhm_px / fwhm_px)));
        errors.push_back(width_error / search.stars[i].signal_to_noise());
    }
    const double spread = sigma_of_median_distance * percentile(std::move(away), 0.5),
                 error = percentile(std::move(errors), 0.5);
    return std::clamp(std::sqrt(std::max(0.0, spread * spread - error * error)), least_width_spread,
                      most_width_spread);
}

// The shape and width that describe these stars best.
StarWidths widths_of(const Search& search, const std::vector<std::size_t>& stars) {
    std::vector<double> widths;
    for (const std::size_t i : stars) widths.push_back(search.stars[i].profile.fwhm_px);
    const double middle = percentile(std::move(widths), 0.5);
    std::vector<StarProfile> profiles;
    constexpr double width_step = 0.06;  // of the logarithm: from 26 % narrower than the median to 52 % wider
    for (int shape = 0; shape < star_shapes; ++shape)
        for (int step = -5; step <= 7; ++step)
            profiles.push_back({std::max(narrowest_fwhm_px, middle * real::exp(width_step * step)), shape});
    const StarProfile best = elected(search, stars, profiles);
    return {best.shape, best.fwhm_px, spread_of(search, stars, best.fwhm_px)};
}

// The common profile of the stars, and that of those that are clearly wider: in a galaxy that is resolved
// into points as narrow as a pixel, these are many more than the stars before it. A faint star alone does not
// tell its shape, and with the points' it would lose its wings.
void measure_profile(Search& search) {
    const std::vector<std::size_t> stars = telling_stars(search, 0.0, most_telling);
    if (stars.size() < fewest_telling) return;
    search.widths = widths_of(search, stars);
    const std::vector<std::size_t> others =
        telling_stars(search, wider * search.widths.fwhm_px, most_telling_of_wider);
    search.of_wider.reset();
    if (others.size() >= fewest_wider) search.of_wider = widths_of(search, others);
}

// Another shape of the same star, of free width.
PictureStar reshaped(const Search& search, PictureStar star, int shape) {
    star.profile.shape = shape;
    const StarWidths free{shape, star.profile.fwhm_px, 1.0};
    const PictureStar before = star;
    return fit_star(search.image, search.unusable, free, star) ? star : before;
}

// Every star takes the field's shape, unless it is bright and another one describes it clearly better.
void choose_shapes(Search& search, const Progress& progress) {
    for_each_by_tiles(search, 0, progress, [&](std::size_t i) {
        add_star(search.image, search.stars[i], 1.0f);
        const PictureStar first =
            reshaped(search, search.stars[i], widths_for(search, search.stars[i]).shape);
        PictureStar best = first;
        double least = shape_misfit(search.image, search.unusable, first, first.profile) - clearly_better;
        for (int shape = 0; shape < star_shapes && first.signal_to_noise() > shaped; ++shape) {
            if (shape == first.profile.shape) continue;
            const PictureStar other = reshaped(search, first, shape);
            const double misfit = shape_misfit(search.image, search.unusable, other, first.profile);
            if (misfit >= least) continue;
            least = misfit;
            best = other;
        }
        search.stars[i] = best;
        add_star(search.image, best, -1.0f);
    });
}

PictureStar star_of(const StarCandidate& candidate, const StarWidths& widths) {
    PictureStar star;
    star.x = star.seen_x = candidate.x;
    star.y = star.seen_y = candidate.y;
    star.profile = {widths.fwhm_px, widths.shape};
    star.noise = candidate.noise;
    star.pixel_noise = candidate.noise * pixel_noise_over_height_noise(kernel_sigma_px);
    return star;
}

// Adds what stands out of the picture less the stars found so far, and fits it.
void search_once(Search& search, const StarSettings& settings, const Progress& progress) {
    const Image brightness = mean_of_channels(search.image);
    const Image heights = matched_heights(brightness, kernel_sigma_px);
    const std::size_t first = search.stars.size();
    for (const StarCandidate& candidate : find_candidates(heights, search.noise, settings.threshold)) {
        const auto x = std::int64_t(candidate.x), y = std::int64_t(candidate.y);
        if (x < 0 || y < 0 || x >= brightness.width || y >= brightness.height) continue;
        const double taken = double(*search.before.at(x, y) - *brightness.at(x, y));
        if (search.covered.at(x, y) || candidate.height < least_share_of_others * taken) continue;
        search.stars.push_back(star_of(candidate, search.widths));
        search.stars.back().saturated = search.unusable.at(x, y);
    }
    search.lost.resize(search.stars.size(), 0);
    fit_all(search, first, progress);
}

bool is_star(const PictureStar& star, const StarWidths& widths, double threshold) {
    return star.profile.fwhm_px < std::max(widest_fwhm_px, widest_of_field * widths.fwhm_px) &&
           star.signal_to_noise() > kept_threshold * threshold &&
           star.misfit < misfit_of_noise * star.noise + misfit_of_height * star.mean_amplitude();
}

// Ordinary stars are not looked for in what these cover.
std::vector<PictureStar> take_saturated_ones(Search& search) {
    search.covered = make_mask(search.image.width, search.image.height);
    std::vector<PictureStar> stars = take_saturated_stars(search.image, search.unusable, saturated_noise);
    for (const PictureStar& star : stars) mark_core_and_spikes(search.image, star, search.covered);
    for (std::size_t i = 0; i < search.covered.pixels.size(); ++i)
        if (search.covered.pixels[i]) search.unusable.pixels[i] = 1;
    return stars;
}

Search begin_search(const Image& image, const StarSettings& settings) {
    Search search;
    search.image = image;
    search.before = mean_of_channels(image);
    const float brightest = *std::max_element(search.before.pixels.begin(), search.before.pixels.end());
    search.noise =
        noise_of_heights(matched_heights(search.before, kernel_sigma_px), least_noise * double(brightest));
    search.unusable = saturated_pixels(image, settings.saturation);
    return search;
}

// Light that is not like a star goes back into the picture.
void judge(Search& search, double threshold) {
    for (std::size_t i = 0; i < search.stars.size(); ++i) {
        if (search.lost[i] || is_star(search.stars[i], search.widths, threshold)) continue;
        add_star(search.image, search.stars[i], 1.0f);
        search.lost[i] = 1;
    }
}

constexpr double trusted_height = 6.0;  // of a profile over a pixel's noise: above, its pixels are filled
constexpr double least_trusted = 1.0;   // and below, they are what the picture shows
constexpr double too_dark = 2.0;        // times the noise: profiles were wider or higher than the star
constexpr double too_bright = 4.0;      // or narrower, near the star's middle
constexpr std::int64_t cell_px = 24;    // in which the level and noise of what surrounds a star are measured

// A pixel that the star's profile did not leave as its surroundings are.
bool stands_out(const Image& without, const Cells& cells, std::int64_t x, std::int64_t y, bool near) {
    for (int c = 0; c < 3; ++c) {
        const double u = double(x) + 0.5, v = double(y) + 0.5;
        const double level = interpolated(cells.level, cells.cell_px, u, v, c);
        const double noise = interpolated(cells.noise, cells.cell_px, u, v, c);
        const double away = double(without.at(x, y)[c]) - level;
        if (away < -too_dark * noise || (near && away > too_bright * noise)) return true;
    }
    return false;
}

void mark_distrusted(const Image& without, const Cells& cells, const PictureStar& star, PixelMask& mask) {
    const double share = star.pixel_noise / star.mean_amplitude();
    const double core = reach_of(star.profile, trusted_height * share);
    const double whole = std::min(reach_px(star), reach_of(star.profile, least_trusted * share));
    for_each_within(
        mask, star.x, star.y, std::max(core, whole),
        [&](std::int64_t x, std::int64_t y, double dx, double dy) {
            const double squared = dx * dx + dy * dy, width = star.profile.fwhm_px;
            if (squared < core * core || stands_out(without, cells, x, y, squared < width * width))
                mask.at(x, y) = 1;
        });
}

void keep_above_zero(const Image& before, Image& after) {
    for_each_pixel(before, [&](std::int64_t x, std::int64_t y) {
        for (int c = 0; c < 3; ++c)
            after.at(x, y)[c] = std::max(after.at(x, y)[c], std::min(0.0f, before.at(x, y)[c]));
    });
}

double whole_flux(const PictureStar& star) { return star.flux(0) + star.flux(1) + star.flux(2); }

}  // namespace

StarField find_stars(const Image& image, const StarSettings& settings, const Progress& progress) {
    Search search = begin_search(image, settings);
    std::vector<PictureStar> saturated = take_saturated_ones(search);
    search_once(search, settings, progress);
    for (int pass = 0; pass < 2; ++pass) {  // stars of another shape tell another profile
        measure_profile(search);
        choose_shapes(search, progress);
        fit_all(search, 0, progress);
    }
    measure_profile(search);
    progress.at(0.5);
    for (int pass = 0; pass < 2; ++pass) {
        search_once(search, settings, progress);
        fit_all(search, 0, progress);
        judge(search, settings.threshold);
        progress.at(0.7 + 0.2 * pass);
    }
    StarField field{std::move(saturated), search.widths, std::move(search.image), std::move(search.covered)};
    for (std::size_t i = 0; i < search.stars.size(); ++i)
        if (!search.lost[i]) field.stars.push_back(search.stars[i]);
    return field;
}

StarRemoval remove_stars(const Image& image, const StarSettings& settings, const Progress& progress) {
    StarField field = find_stars(image, settings, progress);
    PixelMask& cores = field.covered;
    const Cells cells = measure_cells(field.image, cell_px);
    for (const PictureStar& star : field.stars) mark_distrusted(field.image, cells, star, cores);
    fill(field.image, cores, FillKind::texture, progress);
    keep_above_zero(image, field.image);
    std::ranges::stable_sort(field.stars, std::greater(), whole_flux);
    progress.at(1.0);
    return {std::move(field.image), std::move(field.stars)};
}

std::int64_t star_removal_bytes(const Image& image) {
    const std::int64_t floats = image.channels + 1 + 3 + 1;  // the result, brightness, sums and heights
    return image.width * image.height * (floats * std::int64_t(sizeof(float)) + 3);
}

std::string star_table(std::span<const PictureStar> stars, std::int64_t width, std::int64_t height) {
    std::string text = fmt::format("{}\nx,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n", star_table_mark);
    for (const PictureStar& star : stars) {
        text += fmt::format("{:.3f},{:.3f},{:.7f},{:.7f},{:.6g},{:.6g},{:.6g},{:.4f},{}\n", star.x, star.y,
                            star.x / double(width), 1.0 - star.y / double(height), star.flux(0), star.flux(1),
                            star.flux(2), star.sigma_px(), star.saturated ? 1 : 0);
    }
    return text;
}

}  // namespace astrosplat
