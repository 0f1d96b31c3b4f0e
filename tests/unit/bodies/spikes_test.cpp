// Diffraction spikes: painted on nebulae, at known angles and of known lengths, found and taken out.
#include "bodies/spikes.h"
#include "bodies/bodies.h"
#include "bodies/picture_splats.h"
#include "core/color.h"
#include "core/parallel.h"
#include "core/real.h"
#include "image/channels.h"
#include "image/resample.h"
#include "support/painted_picture.h"
#include "support/test.h"

#include <set>

namespace astrosplat {
namespace {

constexpr std::int64_t width = 720, height = 480;

double uniform(std::uint32_t i, std::uint32_t purpose, double from, double to) {
    return from + (to - from) * painted::random(i, purpose);
}

// Clouds with filaments, of a brightness that changes from .01 to about .5, and faint stars.
Image nebula(std::uint32_t seed) {
    Image image = painted::of_colors(width, height, [&](double u, double v) {
        const double cloud = std::max(0.0, 0.5 + double(painted::fbm(u, v, 5.0, seed)));
        const double ridge = 1.0 - std::fabs(double(painted::fbm(u, v, 9.0, seed + 1)));
        const double light =
            0.01 + 0.22 * cloud * cloud + 0.25 * cloud * std::pow(std::max(0.0, ridge), 12.0);
        const double warm = 0.5 + 0.4 * double(painted::fbm(u, v, 3.0, seed + 2));
        return std::array{light * (0.4 + 0.8 * warm), 0.7 * light, light * (1.1 - 0.7 * warm)};
    });
    for (std::uint32_t i = 0; i < 200; ++i) {
        const double light = uniform(i, 4 + seed, 0.1, 1.5);
        painted::add_point(image, uniform(i, 1 + seed, 8.0, width - 8.0),
                           uniform(i, 2 + seed, 8.0, height - 8.0), uniform(i, 3 + seed, 0.8, 2.0), light,
                           light, light);
    }
    return image;
}

struct SpikedStar {
    double x, y, sigma;    // px
    double length;         // px, of each ray, from the middle, where it has faded away
    bool in_glow = false;  // of its own, that is burnt out in red
};

std::vector<SpikedStar> stars_of(std::uint32_t seed, int count) {
    std::vector<SpikedStar> stars;
    for (std::uint32_t i = 0; stars.size() < std::size_t(count); ++i) {
        const SpikedStar star{uniform(i, 11 + seed, 60.0, width - 60.0),
                              uniform(i, 12 + seed, 60.0, height - 60.0), uniform(i, 13 + seed, 1.2, 5.0),
                              0.0, stars.size() == 0};
        if (std::ranges::any_of(
                stars, [&](const SpikedStar& s) { return std::hypot(s.x - star.x, s.y - star.y) < 90.0; }))
            continue;
        stars.push_back(star);
        stars.back().length = star.sigma * 5.0 + uniform(i, 14 + seed, 25.0, 45.0) * star.sigma;
    }
    return stars;
}

// Light of a star's rays at a place.
double spikes_at(const SpikedStar& star, int arms, double angle, double x, double y) {
    double sum = 0.0;
    for (int i = 0; i < arms; ++i) {
        const double turn = angle + 2.0 * real::pi * i / arms;
        const double along = (x - star.x) * std::cos(turn) + (y - star.y) * std::sin(turn);
        const double across = (y - star.y) * std::cos(turn) - (x - star.x) * std::sin(turn);
        if (along <= 0.0 || along >= star.length) continue;
        const double fade = 1.0 - along / star.length, wide = 0.9 + 0.15 * star.sigma;
        sum += 0.6 * fade * fade * fade * std::exp(-across * across / (2.0 * wide * wide));
    }
    return sum;
}

// As a file holds it: burnt out above white, with noise, in 8 bits.
Image as_recorded(Image image, std::uint32_t seed) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const double noise = 0.012 * (painted::random(std::uint32_t(i), 91 + seed) - 0.5);
        const double shown = double(display_srgb(std::clamp(image.pixels[i], 0.0f, 1.0f))) + noise;
        image.pixels[i] =
            float(real::srgb_to_linear(std::round(std::clamp(shown, 0.0, 1.0) * 255.0) / 255.0));
    }
    return image;
}

Image with_spikes(Image image, const std::vector<SpikedStar>& stars, int arms, double angle) {
    for (const SpikedStar& star : stars) {
        painted::add_point(image, star.x, star.y, star.sigma, 6.0, 7.0, 9.0);
        painted::add_point(image, star.x, star.y, 3.0 * star.sigma, 0.1, 0.15, 0.4);
        if (star.in_glow) painted::add_point(image, star.x, star.y, 35.0, 1.1, 0.05, 0.05);
        for_each_within(image, star.x, star.y, star.length,
                        [&](std::int64_t x, std::int64_t y, double dx, double dy) {
                            const double light = spikes_at(star, arms, angle, star.x + dx, star.y + dy);
                            for (int c = 0; c < 3; ++c) image.at(x, y)[c] += float(light * (0.7 + 0.15 * c));
                        });
    }
    return image;
}

struct Found {
    int rays = 0, taken = 0;
    std::int64_t nebula = 0, changed = 0;  // pixels
};

// A ray is taken where three quarters of its light are, beyond what is the star's.
Found compared(const Image& without, const Image& before, const Image& after,
               const std::vector<SpikedStar>& stars, int arms, double angle) {
    Found found;
    for (const SpikedStar& star : stars)
        for (int i = 0; i < arms; ++i) {
            const double turn = angle + 2.0 * real::pi * i / arms, begin = 4.5 * star.sigma + 3.0;
            double whole = 0.0, left = 0.0, end = begin;
            for (double r = begin; r < star.length; r += 1.0) {
                const auto x = float(star.x + r * std::cos(turn)), y = float(star.y + r * std::sin(turn));
                if (x < 1.0f || y < 1.0f || x > float(width) - 1.0f || y > float(height) - 1.0f) break;
                whole += double(bilinear(before, 1, x, y) - bilinear(without, 1, x, y));
                left += double(bilinear(after, 1, x, y) - bilinear(without, 1, x, y));
                end = r;
            }
            if (end - begin < 20.0) continue;
            ++found.rays;
            found.taken += left < 0.25 * whole;
        }
    for_each_between(before, 0, 0, width - 1, height - 1, [&](std::int64_t x, std::int64_t y) {
        for (const SpikedStar& star : stars) {
            const double dx = double(x) + 0.5 - star.x, dy = double(y) + 0.5 - star.y;
            if (std::hypot(dx, dy) < 12.0 * star.sigma) return;
            if (spikes_at(star, arms, angle, star.x + dx, star.y + dy) > 0.002) return;
        }
        ++found.nebula;
        float most = 0.0f;
        for (int c = 0; c < 3; ++c)
            most = std::max(most, display_srgb(before.at(x, y)[c]) - display_srgb(after.at(x, y)[c]));
        found.changed += most > 0.02f;
    });
    return found;
}

TEST(Spikes, OfNebulaeAreTakenAndLittleElse) {
    for (const int arms : {4, 6}) {
        Found all;
        for (std::uint32_t seed = 1; seed < 3; ++seed) {
            const double angle = uniform(seed, 21, 0.0, 2.0 * real::pi / arms);
            const std::vector<SpikedStar> stars = stars_of(100 * seed, 8);
            const Image sky = nebula(100 * seed);
            const Image before = as_recorded(with_spikes(sky, stars, arms, angle), seed);
            const std::vector<SpikedStar> smooth = [&] {
                std::vector<SpikedStar> none = stars;
                for (SpikedStar& star : none) star.length = 0.0;
                return none;
            }();
            const Image without = as_recorded(with_spikes(sky, smooth, arms, angle), seed);
            Image after = before;
            const Spikes spikes = take_spikes(after);
            ASSERT_EQ(spikes.arms, arms) << seed;
            EXPECT_NEAR(spikes.angle, angle, 0.02);
            const Found found = compared(without, before, after, stars, arms, angle);
            all.rays += found.rays;
            all.taken += found.taken;
            all.nebula += found.nebula;
            all.changed += found.changed;
        }
        EXPECT_GE(double(all.taken), 0.9 * double(all.rays)) << arms;
        EXPECT_LE(double(all.changed), 0.005 * double(all.nebula)) << arms;
    }
}

TEST(Spikes, NebulaeAndRoundStarsHaveNone) {
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
        std::vector<SpikedStar> stars = stars_of(100 * seed, 12);
        for (SpikedStar& star : stars) star.length = 0.0;
        Image light = as_recorded(with_spikes(nebula(100 * seed), stars, 4, 0.0), seed);
        const Image before = light;
        const Spikes spikes = take_spikes(light);
        EXPECT_EQ(spikes.arms, 0) << seed;
        EXPECT_EQ(light.pixels, before.pixels);
    }
}

// What the light of a picture loses is what its splats have, and they lie in one plane each star.
TEST(Spikes, AreSplatsInThePlaneOfTheirStar) {
    const std::vector<SpikedStar> stars = stars_of(100, 6);
    const Image before = as_recorded(with_spikes(nebula(100), stars, 4, 0.6), 1);
    Image light = before;
    const Spikes spikes = take_spikes(light);
    ASSERT_GE(spikes.stars.size(), 5u);
    StructureParams params;
    params.kind = StructureKind::sheet;
    const Placement placement = placement_without_fields(width, height, params, 100.0);
    PictureSplats set;
    add_spikes(spikes.light, places_of(spikes.stars), 0, 1, placement, {}, set);
    ASSERT_EQ(set.splats.size(), std::ssize(spikes.light));
    std::vector<float> plane(spikes.stars.size(), 1e9f);
    std::set<std::uint64_t> ids(set.splats.id.begin(), set.splats.id.end());
    EXPECT_EQ(std::ssize(ids), set.splats.size());
    double lost = 0.0, shown = 0.0;
    for (std::size_t i = 0; i < spikes.light.size(); ++i) {
        float& z = plane[std::size_t(spikes.light[i].star)];
        if (z == 1e9f) z = set.splats.position[i].z;
        ASSERT_EQ(set.splats.position[i].z, z);
        const double area = 2.0 * real::pi * std::pow(double(set.splats.radius[i] / radius_sigmas), 2.0);
        shown += double(set.splats.color[i].y * set.splats.alpha[i] * footprint_share) * area;
    }
    for (const Star& star : spikes.gaussians)
        shown += 2.0 * real::pi * double(star.sigma * star.sigma * star.peak.y);
    for (std::size_t i = 1; i < light.pixels.size(); i += 3)
        lost += double(before.pixels[i] - light.pixels[i]);
    EXPECT_NEAR(shown / lost, 1.0, 0.05);
    EXPECT_NE(plane[0], plane[1]);
}

TEST(Spikes, AreTheSameWithAnyNumberOfThreads) {
    const Image before = as_recorded(with_spikes(nebula(200), stars_of(200, 6), 4, 0.3), 1);
    Image one = before, many = before;
    set_thread_count(1);
    take_spikes(one);
    set_thread_count(4);
    take_spikes(many);
    set_thread_count(0);
    EXPECT_EQ(one.pixels, many.pixels);
    EXPECT_NE(one.pixels, before.pixels);
}

// An enlarged picture has the spikes of its own texels.
TEST(Spikes, OfEnlargedPicturesAreFoundByTheirTexels) {
    Image light = enlarged(as_recorded(with_spikes(nebula(100), stars_of(100, 6), 4, 0.6), 1), 2);
    const Spikes spikes = take_spikes(light, 2);
    EXPECT_GE(spikes.stars.size(), 5u);
    EXPECT_NEAR(spikes.angle, 0.6, 0.02);
}

}  // namespace
}  // namespace astrosplat
