// Stars found again: painted ones in a painted nebula, and in real pictures where these are present.
#include "image/channels.h"
#include "prepare/star_removal.h"
#include "source/texture.h"
#include "support/test.h"
#include "support/test_data.h"
#include "unit/prepare/painted.h"

namespace astrosplat {
namespace {

const StarProfile gaussian{3.0, 0}, moffat{3.0, 3};
constexpr double pixel_noise = 0.01;

PictureStar grey_star(double x, double y, const StarProfile& profile, double height) {
    PictureStar star;
    star.x = x;
    star.y = y;
    star.profile = profile;
    star.amplitude = {height, height, height};
    return star;
}

// Clouds without anything as small as a star.
Image clouds() {
    return painted(720, 480, 3, [](double x, double y, int c) {
        return 0.2 + 0.1 * std::sin(x / 90.0 + c) * std::cos(y / 70.0) +
               0.05 * std::sin((x + 2.0 * y) / 31.0);
    });
}

// Of the height of a star of 3 px in white noise, in the mean of three channels.
constexpr double height_noise = pixel_noise / 1.7320508 / (1.7724539 * 3.0 / fwhm_of_sigma);

std::vector<PictureStar> stars_in_clouds(std::vector<StarProfile> profiles, double faintest, double brightest,
                                         int count = 300) {
    return random_stars(clouds(), {count, std::move(profiles), faintest, brightest, 6.0, 1},
                        [](double, double) { return height_noise; });
}

struct Found {
    Score score;
    StarRemoval removal;
};

Found search_clouds(const std::vector<PictureStar>& truth, const StarSettings& settings = {}) {
    const Image noisy = add_noise(clouds(), pixel_noise, 3);
    Found found;
    found.removal = remove_stars(with_stars(noisy, truth), settings);
    found.score = score(truth, found.removal.stars);
    return found;
}

TEST(Profiles, HaveTheirWidthAndTheirSum) {
    for (int shape = 0; shape < star_shapes; ++shape) {
        const StarProfile profile{4.0, shape};
        EXPECT_NEAR(profile_at(shape, unit_of(profile) * 4.0).value, 0.5, 1e-12) << shape;
        EXPECT_EQ(profile_at(shape, 0.0).value, 1.0);
        const double u = 0.7,
                     slope = (profile_at(shape, u + 1e-6).value - profile_at(shape, u - 1e-6).value) / 2e-6;
        EXPECT_NEAR(profile_at(shape, u).slope, slope, 1e-8) << shape;
        EXPECT_NEAR(profile_at(shape, unit_of(profile) * std::pow(reach_of(profile, 0.01), 2.0)).value, 0.01,
                    1e-12);
        double sum = 0.0;  // in rings to far out in the wings
        for (double r = 0.005; r < 4000.0; r += r < 100.0 ? 0.01 : 1.0)
            sum += 2.0 * real::pi * r * (r < 100.0 ? 0.01 : 1.0) *
                   profile_at(shape, unit_of(profile) * r * r).value;
        EXPECT_NEAR(sum / integral_of(profile), 1.0, 2e-3) << shape;
    }
}

TEST(StarFit, FindsAPaintedStarExactly) {
    for (int shape = 0; shape < star_shapes; ++shape) {
        PictureStar truth = grey_star(20.3, 17.8, {2.6, shape}, 0.3);
        truth.amplitude = {0.3, 0.2, 0.1};
        truth.noise = truth.pixel_noise = 1e-6;
        Image image =
            painted(40, 36, 3, [](double x, double y, int c) { return 0.1 * c + 0.002 * x - 0.001 * y; });
        add_star(image, truth, 1.0f);
        PictureStar found = truth;
        found.x = found.seen_x = 20.5;
        found.y = found.seen_y = 17.5;
        found.profile.fwhm_px = 2.0;
        ASSERT_TRUE(fit_star(image, make_mask(40, 36), {shape, 2.0, 1.0}, found)) << shape;
        EXPECT_NEAR(found.x, truth.x, 0.01);
        EXPECT_NEAR(found.y, truth.y, 0.01);
        EXPECT_NEAR(found.profile.fwhm_px, 2.6, 0.02) << shape;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.flux(c) / truth.flux(c), 1.0, 0.01) << shape;
    }
}

TEST(Stars, AreFoundInClouds) {
    for (const StarProfile& profile : {gaussian, moffat}) {
        const Score s = search_clouds(stars_in_clouds({profile}, 10.0, 300.0)).score;
        EXPECT_GE(s.completeness, 0.98) << profile.shape;
        EXPECT_GE(s.purity, 0.98) << profile.shape;
        EXPECT_LT(std::fabs(s.flux_bias), 0.01) << profile.shape;
        EXPECT_LT(s.flux_error, 0.04) << profile.shape;
        EXPECT_LT(s.place_px, 0.08) << profile.shape;
    }
}

/// Faint stars among other points, which have a profile of their own and are so many times as bright.
struct Crowd {
    int faint, all;
    StarProfile profile, of_others;
    double signal_to_noise, brighter, completeness, flux_error, place_px;
};
// Alone in white noise the median errors of a best fit are 6.7 % and .21 px at a signal to noise of ten.
const Crowd crowds[] = {
    // Brighter ones tell the profile, many of them near.
    {300, 600, gaussian, gaussian, 10.0, 10.0, 0.95, 0.12, 0.23},
    // As faint ones in a picture with other points, which are fewer, brighter and narrower.
    {450, 600, gaussian, {1.6, 4}, 10.0, 15.0, 0.95, 0.25, 0.23},
    // As those before a galaxy that is resolved into points: these are narrower, brighter and more. Without
    // wings, the stars would have 16 % less light.
    {300, 900, moffat, {1.2, 0}, 16.0, 4.0, 0.98, 0.12, 0.2}};

TEST(Stars, FaintOnesAreFoundAndMeasuredAmongOtherPoints) {
    for (const Crowd& crowd : crowds) {
        SCOPED_TRACE(testing::Message() << crowd.faint << " of " << crowd.all);
        std::vector<PictureStar> all =
            stars_in_clouds({crowd.profile}, crowd.signal_to_noise, crowd.signal_to_noise, crowd.all);
        const std::vector<PictureStar> faint(all.begin(), all.begin() + crowd.faint);
        for (PictureStar& star : std::span(all).subspan(std::size_t(crowd.faint))) {
            star.profile = crowd.of_others;
            for (double& amplitude : star.amplitude) amplitude *= crowd.brighter;
        }
        const StarRemoval removal = search_clouds(all).removal;
        const Score s = score(faint, removal.stars);
        EXPECT_GE(s.completeness, crowd.completeness);
        EXPECT_LT(std::fabs(s.flux_bias), 0.05);
        EXPECT_LT(s.flux_error, crowd.flux_error);
        EXPECT_LT(s.place_px, crowd.place_px);
        if (crowd.of_others.shape == crowd.profile.shape) {
            EXPECT_GE(score(all, removal.stars).purity, 0.95);
        }
    }
}

TEST(Stars, OfTwoProfilesAreToldApart) {
    const Score s = search_clouds(stars_in_clouds({gaussian, moffat}, 30.0, 300.0)).score;
    EXPECT_GE(s.completeness, 0.98);
    EXPECT_LT(s.flux_error, 0.05);
}

TEST(Stars, LeaveTheNoiseAndTheLightOfTheClouds) {
    const StarRemoval removal = search_clouds(stars_in_clouds({gaussian, moffat}, 10.0, 300.0)).removal;
    const Image truth = clouds();
    double squares = 0.0, sum = 0.0, light = 0.0, far = 0.0;
    const auto count = double(truth.pixels.size());
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const double away = double(removal.starless.pixels[i] - truth.pixels[i]);
        squares += away * away;
        far += std::fabs(away) > 5.0 * pixel_noise ? 1.0 : 0.0;
        sum += double(removal.starless.pixels[i]);
        light += double(truth.pixels[i]);
    }
    EXPECT_NEAR(std::sqrt(squares / count) / pixel_noise, 1.0, 0.02);
    EXPECT_LT(far / count, 2e-4);
    EXPECT_NEAR(sum / light, 1.0, 0.002);
}

TEST(Stars, CloseTogetherAreSeparated) {
    std::vector<PictureStar> pairs, all = stars_in_clouds({gaussian}, 30.0, 300.0);
    for (int i = 0; i < 20; ++i)
        for (const double side : {-2.0, 2.0})
            pairs.push_back(grey_star(40.3 + 30.0 * i + side, 60.6 + 18.0 * i, gaussian, 0.5));
    std::erase_if(all, [&](const PictureStar& star) { return Neighbours(pairs).nearest(star, 9.0); });
    all.insert(all.end(), pairs.begin(), pairs.end());
    const Score s = score(pairs, search_clouds(all).removal.stars);
    EXPECT_EQ(s.completeness, 1.0);
    EXPECT_LT(s.flux_error, 0.05);
}

TEST(Stars, SoftKnotsAndEdgesAreNone) {
    const Image knots =
        add_noise(painted(400, 300, 3,
                          [](double x, double y, int) {
                              const double u = std::fmod(x, 60.0) - 30.0, v = std::fmod(y, 60.0) - 30.0;
                              return 0.2 + (x > 200.0 ? 0.3 : 0.0) + 0.3 * std::exp(-(u * u + v * v) / 90.0);
                          }),
                  pixel_noise, 5);
    EXPECT_LE(remove_stars(knots, {}).stars.size(), 2u);
}

// A star whose peak is cut off, and a bar as bright, which has no wings.
TEST(Stars, OfSaturatedPatchesRoundOnesThatFallOffAreStars) {
    const PictureStar star = grey_star(40.4, 33.7, {6.0, 2}, 8.0);
    Image image = with_stars(painted(140, 70, 3, [](double, double, int) { return 0.05; }), {star});
    for (std::int64_t x = 95; x < 125; ++x)
        for (std::int64_t y = 30; y < 36; ++y) std::fill_n(image.at(x, y), 3, 1.0f);
    for (float& value : image.pixels) value = std::min(value, 1.0f);
    const PixelMask saturated = saturated_pixels(image, 1.0);
    EXPECT_EQ(connected_parts(saturated).size(), 2u);
    const std::vector<PictureStar> found = take_saturated_stars(image, saturated, 1e-3);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].x, star.x, 0.1);
    EXPECT_NEAR(found[0].y, star.y, 0.1);
    EXPECT_NEAR(found[0].amplitude[1], 8.0, 2.0);
    EXPECT_NEAR(image.at(52, 33)[1], 0.05f, 0.02f) << "its wings went with it";
    PixelMask distrusted = make_mask(140, 70);
    mark_core_and_spikes(image, found[0], distrusted);
    EXPECT_TRUE(distrusted.at(40, 33));
    EXPECT_FALSE(distrusted.at(100, 33));
}

// Ten stars whose cores are cut off, with a cross of spikes.
TEST(Stars, SaturatedOnesAreFittedFromTheirWings) {
    std::vector<PictureStar> truth;
    for (int i = 0; i < 10; ++i)
        truth.push_back(grey_star(60.2 + 66.0 * i, 60.7 + 80.0 * (i % 5), {3.5, 3}, 20.0));
    Image image = with_stars(clouds(), truth);
    for (const PictureStar& star : truth)
        for (std::int64_t i = -25; i <= 25; ++i)
            for (int c = 0; c < 3; ++c) {
                image.at(std::int64_t(star.x) + i, std::int64_t(star.y))[c] += 0.3f;
                image.at(std::int64_t(star.x), std::int64_t(star.y) + i)[c] += 0.3f;
            }
    image = add_noise(std::move(image), pixel_noise, 9);
    for (float& value : image.pixels) value = std::min(value, 1.0f);
    const StarRemoval removal = remove_stars(image, {5.0, 0.98});
    const Score s = score(truth, removal.stars);
    EXPECT_EQ(s.completeness, 1.0);
    EXPECT_LT(s.flux_error, 0.3) << "what is seen of them is far from the middle";
    EXPECT_LT(s.place_px, 0.2);
    for (const PictureStar& star : removal.stars)
        EXPECT_TRUE(star.saturated || total_flux(star) < 100.0) << star.x;
    const Image clean = clouds();
    for (const PictureStar& star : truth)
        for (std::int64_t i = -22; i <= 22; ++i) {
            const auto x = std::int64_t(star.x), y = std::int64_t(star.y);
            EXPECT_NEAR(removal.starless.at(x + i, y)[1], clean.at(x + i, y)[1], 0.12) << star.x << " " << i;
            EXPECT_NEAR(removal.starless.at(x, y + i)[1], clean.at(x, y + i)[1], 0.12) << star.x << " " << i;
        }
}

TEST(Stars, OfAPictureWithoutAnyAreNone) {
    for (const float value : {0.0f, 0.5f}) {
        const StarRemoval removal = remove_stars(make_image(64, 40, 4, value), {5.0, 0.98});
        EXPECT_TRUE(removal.stars.empty());
        for (const float left : removal.starless.pixels) ASSERT_EQ(left, value);
    }
    EXPECT_TRUE(remove_stars(make_image(1, 1, 3, 0.5f), {}).stars.empty());
    EXPECT_TRUE(remove_stars(make_image(3, 2, 3, 1.0f), {5.0, 0.98}).stars.empty());
}

TEST(Stars, AreATable) {
    PictureStar star = grey_star(10.25, 25.0, {fwhm_of_sigma, 0}, 0.5);
    star.amplitude = {0.5, 0.25, 0.125};
    star.saturated = true;
    EXPECT_EQ(star_table(std::vector{star}, 40, 100),
              "# stars that astrosplat prepare took out of a picture\n"
              "x,y,u,v,flux_r,flux_g,flux_b,sigma_px,saturated\n"
              "10.250,25.000,0.2562500,0.7500000,3.14159,1.5708,0.785398,1.0000,1\n");
}

// Median over the stars of what is left of them: root mean square over the pixels nearer than the width at
// half height, in units of the local noise.
double residual(const Image& left, const Image& truth, const std::vector<PictureStar>& stars) {
    const Cells cells = measure_cells(truth, 24);
    std::vector<double> residuals;
    for (const PictureStar& star : stars) {
        const double reach = star.profile.fwhm_px;
        double squares = 0.0, count = 0.0;
        for (double y = star.y - reach; y <= star.y + reach; ++y)
            for (double x = star.x - reach; x <= star.x + reach; ++x) {
                if (std::hypot(x - star.x, y - star.y) > reach) continue;
                const auto i = std::int64_t(x), j = std::int64_t(y);
                for (int c = 0; c < 3; ++c) {
                    const double noise = std::max(1e-3, interpolated(cells.noise, cells.cell_px, x, y, c));
                    const double away = double(left.at(i, j)[c] - truth.at(i, j)[c]) / noise;
                    squares += away * away;
                    count += 1.0;
                }
            }
        residuals.push_back(std::sqrt(squares / count));
    }
    return percentile(std::move(residuals), 0.5);
}

struct RealSearch {
    Score score;
    double diffuse_ratio = 0.0;  // light without stars, over what it was before any were painted
    double residual = 0.0;
};

// 2,000 stars painted into a real picture, in which its own were found before.
RealSearch search_real(const fs::path& file, const StarProfile& profile, double brightest) {
    const Image image = load_linear_image(file);
    const StarSettings settings{5.0, 0.98};
    const Cells noise = noise_of_heights(matched_heights(mean_of_channels(image), 1.3), 1e-4);
    const auto truth =
        random_stars(image, {2000, {profile}, 10.0, brightest, 6.0, 1},
                     [&](double x, double y) { return interpolated(noise.noise, noise.cell_px, x, y, 0); });
    Image painted_on = with_stars(image, truth);
    for (float& value : painted_on.pixels) value = std::min(value, 1.0f);
    const StarRemoval before = remove_stars(image, settings), after = remove_stars(painted_on, settings);
    const auto sum = [](const Image& of) { return std::accumulate(of.pixels.begin(), of.pixels.end(), 0.0); };
    return {score(truth, after.stars, before.stars), sum(after.starless) / sum(before.starless),
            residual(after.starless, before.starless, truth)};
}

struct InARealPicture {
    const char *name, *file;
    StarProfile profile;
};

void PrintTo(const InARealPicture& one, std::ostream* out) { *out << one.name; }

class StarsNightly : public testing::TestWithParam<InARealPicture> {};

// Signal to noise from 10 to 300, and 10 of all of them.
TEST_P(StarsNightly, AreFoundAgain) {
    ASTROSPLAT_TEST_DATA_OR_SKIP(file, GetParam().file);
    for (const double brightest : {300.0, 10.0}) {
        const auto [s, diffuse_ratio, residual] = search_real(file, GetParam().profile, brightest);
        EXPECT_GE(s.completeness, 0.95);
        EXPECT_GE(s.purity, 0.90);
        EXPECT_LT(std::fabs(s.flux_bias), 0.05);
        EXPECT_LT(s.place_px, 0.2);
        EXPECT_NEAR(diffuse_ratio, 1.0, 0.01);
        EXPECT_LE(residual, 2.0);
        std::printf(
            "%s to %.0f: complete %.4f pure %.4f flux %+.4f (median error %.4f) place %.3f px diffuse "
            "%.5f residual %.2f\n",
            GetParam().name, brightest, s.completeness, s.purity, s.flux_bias, s.flux_error, s.place_px,
            diffuse_ratio, residual);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Painted, StarsNightly,
    testing::Values(InARealPicture{"GaussianInAGalaxy", "images/m101_heic0602a.jpg", gaussian},
                    InARealPicture{"MoffatInAGalaxy", "images/m101_heic0602a.jpg", moffat},
                    InARealPicture{"GaussianInANebula", "images/m42.png", gaussian},
                    InARealPicture{"MoffatInANebula", "images/m42.png", moffat}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace astrosplat
