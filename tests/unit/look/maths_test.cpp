// Mathematics that C++ and GLSL share: functions, hashes, noise.
#include "look/shared_look.h"
#include "support/test.h"
#include "unit/look/sets.h"

namespace astrosplat::shared {
namespace {

// as_exp, as_log, as_pow against long double, at the accuracy maths.glsl states;
// as_hash as a source of numbers.

double relative_error(float got, long double wanted) {
    return double(std::fabs((static_cast<long double>(got) - wanted) / wanted));
}

TEST(SharedMaths, ExpIsWithinTwoTenMillionths) {
    double worst = 0.0;
    for (int i = -870000; i <= 880000; ++i) {
        const float x = float(i) * 1e-4f;
        if (x < -87.0f || x > 88.0f) continue;
        worst = std::max(worst, relative_error(as_exp(x), std::exp(static_cast<long double>(x))));
    }
    EXPECT_LT(worst, 2e-7);
    EXPECT_EQ(as_exp(0.0f), 1.0f);
    EXPECT_EQ(as_exp(-1e9f), 0.0f);
    EXPECT_EQ(as_exp(1e9f), std::numeric_limits<float>::infinity());
}

TEST(SharedMaths, LogIsWithinTwoTenMillionths) {
    double worst = 0.0;
    for (int e = -126; e < 127; ++e)
        for (int i = 0; i < 4096; ++i) {
            const float x = std::ldexp(1.0f + float(i) / 4096.0f, e);
            if (x != 1.0f)
                worst = std::max(worst, relative_error(as_log(x), std::log(static_cast<long double>(x))));
        }
    EXPECT_LT(worst, 2e-7);
    EXPECT_EQ(as_log(1.0f), 0.0f);
    EXPECT_EQ(as_log(0.0f), -1e30f);
}

// The exponent y ln x carries a rounding of half a unit in its last place, which exp multiplies by its size.
TEST(SharedMaths, PowErrorGrowsWithItsExponentOnly) {
    for (float y : {0.25f, 0.5f, 0.8f, 1.7f, 2.0f, 3.0f, 6.0f})
        for (int i = 1; i <= 4000; ++i) {
            const float x = float(i) / 2000.0f;
            const long double wanted = std::pow(static_cast<long double>(x), static_cast<long double>(y));
            const double size = std::fabs(double(y) * std::log(double(x)));
            ASSERT_LT(relative_error(as_pow(x, y), wanted), 3e-7 + 3e-7 * size) << x << " ^ " << y;
        }
}

TEST(SharedMaths, PowAtItsEnds) {
    EXPECT_EQ(as_pow(0.0f, 2.0f), 0.0f);
    EXPECT_EQ(as_pow(0.0f, 0.0f), 1.0f);
    EXPECT_EQ(as_pow(1.0f, 7.3f), 1.0f);
    for (float x : {0.0f, 1e-30f, 0.123f, 0.99999994f, 3.0f}) EXPECT_EQ(as_pow(x, 1.0f), x);
}

// Chi-squared over 256 bins of 2^20 numbers: mean 255, standard deviation 22.6.
TEST(SharedMaths, HashesOfCountersAreUniformForEveryPurpose) {
    for (uint purpose : {PURPOSE_DENSITY, PURPOSE_RADIUS, PURPOSE_JITTER_X}) {
        std::int64_t bins[256] = {};
        constexpr int count = 1 << 20;
        for (int i = 0; i < count; ++i) ++bins[int(as_uniform(as_hash(1u, uint(i), 0u, purpose)) * 256.0f)];
        double chi = 0.0;
        for (std::int64_t bin : bins)
            chi += double((bin - count / 256) * (bin - count / 256)) / (count / 256.0);
        EXPECT_NEAR(chi, 255.0, 5.0 * 22.6);
    }
}

TEST(SharedMaths, HashesOfTwoPurposesAreIndependent) {
    constexpr int count = 1 << 20;
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
        sum += (double(as_uniform(as_hash(5u, uint(i), 1u, PURPOSE_DENSITY))) - 0.5) *
               (double(as_uniform(as_hash(5u, uint(i), 1u, PURPOSE_RADIUS))) - 0.5);
    EXPECT_NEAR(sum / count * 12.0, 0.0, 5.0 / std::sqrt(double(count)));
}

// Gradient noise and fBm: bounds, mean, spectrum and seeds.

struct Point {
    float x, y, z;
};

// Points scattered over a cube of 2000 cells, so that they are independent.
Point scattered(std::int64_t i) {
    return {2000.0f * test::uniform(i, 20) - 1000.0f, 2000.0f * test::uniform(i, 21) - 1000.0f,
            2000.0f * test::uniform(i, 22) - 1000.0f};
}

// The most eight gradients can add up to at a place in the cell: each corner takes its two largest offsets.
double largest_sum(double x, double y, double z) {
    const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const double dx = corner & 1 ? 1.0 - x : x, dy = corner & 2 ? 1.0 - y : y,
                     dz = corner & 4 ? 1.0 - z : z;
        const double wx = corner & 1 ? fade(x) : 1.0 - fade(x), wy = corner & 2 ? fade(y) : 1.0 - fade(y),
                     wz = corner & 4 ? fade(z) : 1.0 - fade(z);
        sum += wx * wy * wz * (dx + dy + dz - std::min(dx, std::min(dy, dz)));
    }
    return sum;
}

TEST(Noise, ScaleIsTheReciprocalOfTheLargestPossibleSum) {
    double largest = 0.0;
    for (int k = 0; k <= 100; ++k)
        for (int j = 0; j <= 100; ++j)
            for (int i = 0; i <= 100; ++i)
                largest = std::max(largest, largest_sum(i / 100.0, j / 100.0, k / 100.0));
    EXPECT_NEAR(largest, 1.0364, 1e-4);
    EXPECT_LT(largest * double(AS_NOISE_SCALE), 1.0);
    EXPECT_GT(largest * double(AS_NOISE_SCALE), 0.999);
}

TEST(Noise, IsZeroOnTheLatticeAndWithinOneBetween) {
    for (int i = -20; i <= 20; ++i) EXPECT_EQ(as_noise(float(i), float(3 * i), float(-i), 9u), 0.0f);
    float low = 0.0f, high = 0.0f;
    for (std::int64_t i = 0; i < 400000; ++i) {
        const Point p = scattered(i);
        const float n = as_noise(p.x, p.y, p.z, 3u);
        low = std::min(low, n);
        high = std::max(high, n);
    }
    EXPECT_GE(low, -1.0f);
    EXPECT_LE(high, 1.0f);
    EXPECT_LT(low, -0.75f);
    EXPECT_GT(high, 0.75f);
}

TEST(Noise, HasMeanZeroAndTheSameSpreadAlongEveryAxis) {
    constexpr std::int64_t count = 400000;
    double sum = 0.0, squares = 0.0, slope[3] = {};
    for (std::int64_t i = 0; i < count; ++i) {
        const Point p = scattered(i);
        const double n = double(as_noise(p.x, p.y, p.z, 3u));
        sum += n;
        squares += n * n;
        const double h = 0.25;
        const double d[3] = {double(as_noise(p.x + 0.25f, p.y, p.z, 3u)) - n,
                             double(as_noise(p.x, p.y + 0.25f, p.z, 3u)) - n,
                             double(as_noise(p.x, p.y, p.z + 0.25f, 3u)) - n};
        for (int axis = 0; axis < 3; ++axis) slope[axis] += d[axis] * d[axis] / (h * h);
    }
    const double deviation = std::sqrt(squares / count);
    EXPECT_NEAR(sum / count, 0.0, 5.0 * deviation / std::sqrt(double(count)));
    EXPECT_NEAR(deviation, 0.27, 0.02);
    EXPECT_NEAR(slope[1] / slope[0], 1.0, 0.02);
    EXPECT_NEAR(slope[2] / slope[0], 1.0, 0.02);
}

// Cells a step apart share no gradient, so their centres must not correlate, whatever the step.
TEST(Noise, CellsAreIndependent) {
    for (int step : {2, 3, 16, 64, 256}) {
        double product = 0.0, squares = 0.0;
        constexpr int side = 60;
        for (int k = 0; k < side; ++k)
            for (int j = 0; j < side; ++j)
                for (int i = 0; i < side; ++i) {
                    const auto at = [&](int dx, int dy, int dz) {
                        return double(as_noise(float(2 * i + dx) + 0.5f, float(2 * j + dy) + 0.5f,
                                               float(2 * k + dz) + 0.5f, 1u));
                    };
                    const double n = at(0, 0, 0);
                    squares += n * n;
                    product += n * at(step, step, 0) + n * at(0, step, step) + n * at(step, 0, 0);
                }
        EXPECT_NEAR(product / (3.0 * squares), 0.0, 5.0 / std::sqrt(3.0 * side * side * side)) << step;
    }
}

float fbm(Point p, int octaves, float lacunarity, float gain, uint seed) {
    float sum = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < octaves; ++i) {
        sum += amplitude;
        amplitude *= gain;
    }
    return as_fbm(p.x, p.y, p.z, 0.7f, octaves, lacunarity, gain, 1.0f / sum, seed);
}

TEST(Fbm, IsTheWeightedMeanOfItsOctaves) {
    for (std::int64_t i = 0; i < 1000; ++i) {
        const Point p = scattered(i);
        double sum = 0.0, amplitudes = 0.0, amplitude = 1.0;
        float frequency = 0.7f;
        for (int octave = 0; octave < 5; ++octave) {
            sum += amplitude * double(as_noise_octave(p.x, p.y, p.z, frequency, 4u, octave));
            amplitudes += amplitude;
            amplitude *= 0.6;
            frequency *= 2.5f;
        }
        ASSERT_NEAR(double(fbm(p, 5, 2.5f, 0.6f, 4u)), sum / amplitudes, 1e-6);
    }
}

TEST(Fbm, GainZeroLeavesTheFirstOctave) {
    for (std::int64_t i = 0; i < 1000; ++i) {
        const Point p = scattered(i);
        ASSERT_EQ(fbm(p, 6, 2.0f, 0.0f, 4u), as_noise_octave(p.x, p.y, p.z, 0.7f, 4u, 0));
    }
}

TEST(Fbm, HasMeanZeroAndStaysWithinOne) {
    constexpr std::int64_t count = 200000;
    double sum = 0.0, squares = 0.0;
    for (std::int64_t i = 0; i < count; ++i) {
        const double n = double(fbm(scattered(i), 4, 2.0f, 0.5f, 1u));
        ASSERT_LE(std::fabs(n), 1.0);
        sum += n;
        squares += n * n;
    }
    EXPECT_NEAR(sum / count, 0.0, 5.0 * std::sqrt(squares / count / count));
}

// Octaves are independent, so the variance of the sum is the sum of the variances.
TEST(Fbm, OctavesAndSeedsAreIndependent) {
    constexpr std::int64_t count = 200000;
    double first = 0.0, second = 0.0, both = 0.0, seeds = 0.0;
    for (std::int64_t i = 0; i < count; ++i) {
        const Point p = scattered(i);
        const double a = double(as_noise_octave(p.x, p.y, p.z, 1.0f, 1u, 0));
        const double b = double(as_noise_octave(p.x, p.y, p.z, 1.0f, 1u, 1));
        const double c = double(as_noise_octave(p.x, p.y, p.z, 1.0f, 2u, 0));
        first += a * a;
        second += b * b;
        both += a * b;
        seeds += a * c;
    }
    EXPECT_NEAR(both / std::sqrt(first * second), 0.0, 5.0 / std::sqrt(double(count)));
    EXPECT_NEAR(seeds / first, 0.0, 5.0 / std::sqrt(double(count)));
    EXPECT_NEAR(second / first, 1.0, 0.03);
}

// Thin layers lie in the plane through the origin; noise must be as strong there as elsewhere.
TEST(Fbm, DoesNotFadeInThePlaneThroughTheOrigin) {
    constexpr std::int64_t count = 100000;
    double plane = 0.0, space = 0.0;
    for (std::int64_t i = 0; i < count; ++i) {
        const Point p = scattered(i);
        const double a = double(fbm({p.x, 0.0f, p.z}, 4, 2.0f, 0.5f, 1u)),
                     b = double(fbm(p, 4, 2.0f, 0.5f, 1u));
        plane += a * a;
        space += b * b;
    }
    EXPECT_NEAR(plane / space, 1.0, 0.25);
}

}  // namespace
}  // namespace astrosplat::shared
