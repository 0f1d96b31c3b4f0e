// The engine's elementary functions against the C library's 80-bit ones, in units of the last place.
#include "core/real.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/color.h"

namespace astrosplat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double ulps(double value, long double truth) {
    const double nearest = static_cast<double>(truth);
    const double unit = std::nextafter(std::fabs(nearest), infinity) - std::fabs(nearest);
    return static_cast<double>(std::fabs((static_cast<long double>(value) - truth) / unit));
}

// The largest error over a dense, irrational walk through [lo, hi].
double worst(double lo, double hi, const std::function<double(double)>& ours,
             const std::function<long double(long double)>& truth) {
    double most = 0.0;
    for (int i = 0; i < 200000; ++i) {
        const double part = std::fmod(i * 0.6180339887498949, 1.0);
        const double x = lo + (hi - lo) * part;
        most = std::max(most, ulps(ours(x), truth(x)));
    }
    return most;
}

using L = long double;

TEST(Real, SinCosTanWithinTwoUlps) {
    for (const double range : {0.8, 10.0, 1000.0, 1e6}) {
        EXPECT_LE(worst(-range, range, real::sin, [](L x) { return std::sin(x); }), 1.0) << range;
        EXPECT_LE(worst(-range, range, real::cos, [](L x) { return std::cos(x); }), 1.0) << range;
        EXPECT_LE(worst(-range, range, real::tan, [](L x) { return std::tan(x); }), 2.0) << range;
    }
}

TEST(Real, SinAndCosNextToMultiplesOfHalfPi) {
    for (int k = 1; k < 600000; k += 997) {
        const double x = k * (real::pi / 2.0);
        EXPECT_LE(ulps(real::sin(x), std::sin(static_cast<L>(x))), 1.0) << k;
        EXPECT_LE(ulps(real::cos(x), std::cos(static_cast<L>(x))), 1.0) << k;
    }
}

// Every value there is: what children of splats look like hangs on the bits.
TEST(Real, OnACircleTheBitsAreThoseOfCosAndSin) {
    constexpr int turn = 1 << 24;
    for (int i = 0; i < turn; ++i) {
        const float turns = static_cast<float>(i) / turn;
        const real::OnCircle at = real::on_circle(turns);
        if (i % (turn / 4) == 0) continue;  // exact: see below
        const double angle = 2.0 * real::pi * static_cast<double>(turns);
        ASSERT_EQ(at.cosine, static_cast<float>(real::cos(angle))) << i;
        ASSERT_EQ(at.sine, static_cast<float>(real::sin(angle))) << i;
    }
    for (int quarter = 0; quarter < 4; ++quarter) {
        const real::OnCircle at = real::on_circle(0.25f * static_cast<float>(quarter));
        EXPECT_EQ(at.cosine, quarter == 0 ? 1.0f : quarter == 2 ? -1.0f : 0.0f) << quarter;
        EXPECT_EQ(at.sine, quarter == 1 ? 1.0f : quarter == 3 ? -1.0f : 0.0f) << quarter;
    }
}

TEST(Real, InverseFunctionsWithinTwoUlps) {
    EXPECT_LE(worst(-1.0, 1.0, real::asin, [](L x) { return std::asin(x); }), 2.0);
    EXPECT_LE(worst(-1.0, 1.0, real::acos, [](L x) { return std::acos(x); }), 2.0);
    EXPECT_LE(worst(-3.0, 3.0, real::atan, [](L x) { return std::atan(x); }), 2.0);
    EXPECT_LE(worst(-1e5, 1e5, real::atan, [](L x) { return std::atan(x); }), 2.0);
    for (const double y : {-2.0, -1e-9, 0.3, 5.0})
        EXPECT_LE(worst(
                      -7.0, 7.0, [y](double x) { return real::atan2(y, x); },
                      [y](L x) { return std::atan2(static_cast<L>(y), x); }),
                  2.0)
            << y;
}

TEST(Real, ExpAndLogWithinOneUlp) {
    EXPECT_LE(worst(-700.0, 709.0, real::exp, [](L x) { return std::exp(x); }), 1.0);
    EXPECT_LE(worst(-1.0, 1.0, real::exp, [](L x) { return std::exp(x); }), 1.0);
    EXPECT_LE(worst(1e-300, 1e300, real::log, [](L x) { return std::log(x); }), 1.0);
    EXPECT_LE(worst(0.5, 2.0, real::log, [](L x) { return std::log(x); }), 1.0);
    EXPECT_LE(worst(5e-324, 1e-308, real::log, [](L x) { return std::log(x); }), 1.0);
}

TEST(Real, PowWithinTwoUlpsWhereCurvesUseIt) {
    for (const double y : {2.4, 1.0 / 2.4, -0.7, 0.5, 3.0, 7.0})
        EXPECT_LE(worst(
                      1e-6, 4.0, [y](double x) { return real::pow(x, y); },
                      [y](L x) { return std::pow(x, static_cast<L>(y)); }),
                  2.0)
            << y;
}

TEST(Real, PowOfExtremesStaysWithinTenToTheMinusThirteen) {
    for (const double x : {1e-300, 1e-10, 0.999, 1.001, 1e10, 1e300})
        for (const double y : {-1.01, -0.3, 0.9, 1.02}) {
            const L truth = std::pow(static_cast<L>(x), static_cast<L>(y));
            EXPECT_LE(std::fabs(static_cast<double>((real::pow(x, y) - truth) / truth)), 1e-13)
                << x << "^" << y;
        }
}

TEST(Real, AsinhWithinThreeUlps) {
    for (const double range : {1e-3, 1.0, 100.0, 1e12})
        EXPECT_LE(worst(-range, range, real::asinh, [](L x) { return std::asinh(x); }), 3.0) << range;
}

TEST(Real, ExactValues) {
    EXPECT_EQ(real::sin(0.0), 0.0);
    EXPECT_EQ(real::cos(0.0), 1.0);
    EXPECT_EQ(real::exp(0.0), 1.0);
    EXPECT_EQ(real::log(1.0), 0.0);
    EXPECT_EQ(real::pow(3.5, 1.0), 3.5);
    EXPECT_EQ(real::pow(2.0, 10.0), 1024.0);
    EXPECT_EQ(real::pow(0.0, 0.0), 1.0);
    EXPECT_EQ(real::pow(0.0, 2.0), 0.0);
    EXPECT_EQ(real::asin(1.0), real::pi / 2.0);
    EXPECT_EQ(real::acos(-1.0), real::pi);
    EXPECT_EQ(real::acos(2.0), 0.0);
    EXPECT_EQ(real::atan2(0.0, 0.0), 0.0);
    EXPECT_EQ(real::atan2(1.0, 0.0), real::pi / 2.0);
    EXPECT_EQ(real::atan2(0.0, -1.0), real::pi);
    EXPECT_EQ(real::asinh(0.0), 0.0);
    EXPECT_EQ(real::atan2(1e308, 1e308), real::pi / 4.0);
}

TEST(Real, EndsOfTheRange) {
    EXPECT_EQ(real::exp(710.0), infinity);
    EXPECT_EQ(real::exp(-746.0), 0.0);
    EXPECT_EQ(real::exp(-745.0), 5e-324);
    EXPECT_EQ(real::exp(infinity), infinity);
    EXPECT_EQ(real::log(0.0), -infinity);
    EXPECT_TRUE(std::isnan(real::log(-1.0)));
    EXPECT_TRUE(std::isnan(real::pow(-1.0, 2.0)));
    EXPECT_TRUE(std::isnan(real::sin(infinity)));
    EXPECT_EQ(real::pow(1e200, 2.0), infinity);
    EXPECT_EQ(real::pow(1e-200, 2.0), 0.0);
    EXPECT_EQ(real::pow(infinity, -1.0), 0.0);
}

TEST(Color, SrgbCurveAtKnownValues) {
    EXPECT_EQ(real::srgb_to_linear(0.0), 0.0);
    EXPECT_EQ(real::srgb_to_linear(1.0), 1.0);
    EXPECT_NEAR(real::srgb_to_linear(0.5), 0.21404114048223255, 1e-16);
    EXPECT_DOUBLE_EQ(real::srgb_to_linear(0.04), 0.04 / 12.92);
    EXPECT_EQ(real::srgb_to_linear(-0.5), -real::srgb_to_linear(0.5));
}

TEST(Color, SrgbRoundTripOfAll16BitValues) {
    for (int i = 0; i <= 65535; ++i) {
        const double encoded = i / 65535.0;
        ASSERT_NEAR(real::linear_to_srgb(real::srgb_to_linear(encoded)), encoded, 1e-15) << i;
    }
}

}  // namespace
}  // namespace astrosplat
