// as_exp, as_log, as_pow against long double, at the accuracy maths.glsl states; as_hash as a source of
// numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/shared_maths.h"

namespace astrosplat::shared {
namespace {

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

}  // namespace
}  // namespace astrosplat::shared
