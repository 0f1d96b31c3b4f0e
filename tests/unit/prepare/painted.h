// Pictures painted from formulas, with noise that is the same on every run; stars painted into them, and what
// a search made of them.
#pragma once

#include "core/image.h"
#include "core/sorting.h"
#include "detect/peaks.h"
#include "prepare/star_removal.h"

namespace astrosplat {

/// value(x, y, channel) at every pixel's centre; places in px from the top left corner.
template <class Value>
Image painted(std::int64_t width, std::int64_t height, int channels, const Value& value) {
    Image image = make_image(width, height, channels);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y)[c] = float(value(double(x) + 0.5, double(y) + 0.5, c));
    return image;
}

/// Uniform in [0, 1), one number a call.
struct Random {
    std::uint64_t state;

    double operator()() {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return double(state >> 11) / 9007199254740992.0;
    }
    /// Of mean 0 and standard deviation 1 (the sum of twelve).
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) sum += (*this)();
        return sum;
    }
};

inline Image add_noise(Image image, double deviation, std::uint64_t seed) {
    Random random{seed};
    for (float& value : image.pixels) value += float(deviation * random.normal());
    return image;
}

struct Injection {
    int count = 500;
    std::vector<StarProfile> profiles;         // one a star, in turn
    double faintest = 10.0, brightest = 10.0;  // signal to noise of the height; logarithms spread evenly
    double apart_px = 6.0;
    std::uint64_t seed = 1;
};

/// Stars of random places and colours. `noise(x, y)`: that of the height of a star there.
template <class Noise>
std::vector<PictureStar> random_stars(const Image& image, const Injection& wanted, const Noise& noise) {
    Random random{wanted.seed};
    std::vector<PictureStar> stars;
    while (int(stars.size()) < wanted.count) {
        PictureStar star;
        star.x = 8.0 + random() * double(image.width - 16);
        star.y = 8.0 + random() * double(image.height - 16);
        star.profile = wanted.profiles[stars.size() % wanted.profiles.size()];
        const double exponent = random(), red = 0.7 + 0.6 * random();
        const bool near = std::any_of(stars.begin(), stars.end(), [&](const PictureStar& other) {
            return std::hypot(star.x - other.x, star.y - other.y) < wanted.apart_px;
        });
        if (near) continue;
        star.noise = noise(star.x, star.y);
        const double height =
            star.noise * wanted.faintest * std::pow(wanted.brightest / wanted.faintest, exponent);
        star.amplitude = {height * red, height, height * (2.0 - red)};
        stars.push_back(star);
    }
    return stars;
}

/// Paints each star to where it is a ten-thousandth of its height.
inline Image with_stars(Image image, const std::vector<PictureStar>& stars) {
    for (const PictureStar& star : stars) {
        PictureStar whole = star;
        whole.noise = 1e-3 * star.mean_amplitude();
        add_star(image, whole, 1.0f);
    }
    return image;
}

struct Score {
    double completeness = 0.0;  // share of the stars that have a find within 1 px
    double purity = 0.0;        // share of the finds that have a star, or a find known before, within 1.5 px
    double flux_bias = 0.0;     // median of found over true flux, less 1
    double flux_error = 0.0;    // median distance of that ratio from 1
    double place_px = 0.0;      // median distance
    std::size_t found = 0;
};

inline double distance_px(const PictureStar& a, const PictureStar& b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// Stars in order of y, to be asked for neighbours.
class Neighbours {
  public:
    explicit Neighbours(std::vector<PictureStar> stars) : stars_(std::move(stars)) {
        std::sort(stars_.begin(), stars_.end(),
                  [](const PictureStar& a, const PictureStar& b) { return a.y < b.y; });
    }
    /// The nearest within `reach`, or nullptr.
    const PictureStar* nearest(const PictureStar& to, double reach) const {
        const PictureStar* best = nullptr;
        auto star = std::lower_bound(stars_.begin(), stars_.end(), to.y - reach,
                                     [](const PictureStar& s, double y) { return s.y < y; });
        for (; star != stars_.end() && star->y <= to.y + reach; ++star)
            if (distance_px(*star, to) <= reach && (!best || distance_px(*star, to) < distance_px(*best, to)))
                best = &*star;
        return best;
    }

  private:
    std::vector<PictureStar> stars_;
};

inline double total_flux(const PictureStar& star) { return star.flux(0) + star.flux(1) + star.flux(2); }

inline Score score(const std::vector<PictureStar>& truth, const std::vector<PictureStar>& found,
                   const std::vector<PictureStar>& before = {}) {
    Score result;
    const Neighbours finds(found), known(truth), old(before);
    std::vector<double> ratios, errors, places;
    for (const PictureStar& star : truth) {
        const PictureStar* const match = finds.nearest(star, 1.0);
        if (!match) continue;
        ratios.push_back(total_flux(*match) / total_flux(star) - 1.0);
        errors.push_back(std::fabs(ratios.back()));
        places.push_back(distance_px(*match, star));
    }
    std::size_t real = 0;
    for (const PictureStar& star : found) real += known.nearest(star, 1.5) || old.nearest(star, 1.5);
    result.completeness = double(ratios.size()) / double(truth.size());
    result.purity = double(real) / double(std::max<std::size_t>(1, found.size()));
    result.flux_bias = percentile(ratios, 0.5);
    result.flux_error = percentile(errors, 0.5);
    result.place_px = percentile(places, 0.5);
    result.found = found.size();
    return result;
}

}  // namespace astrosplat
