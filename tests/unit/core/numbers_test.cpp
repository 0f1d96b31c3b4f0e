// Elementary functions, colour matrices, sorting and medians.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/color.h"
#include "core/real.h"
#include "core/sorting.h"

namespace astrosplat {
namespace {

// The engine's elementary functions against the C library's 80-bit ones, in units of the last place.

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

// Matrices between primaries against published ones and what must hold for any.

TEST(Primaries, Rec709ToAcescgIsThePublishedMatrix) {
    // As in the ACES configs of OpenColorIO (Bradford), by rows.
    const double published[3][3] = {
        {0.613097, 0.339523, 0.047379}, {0.070194, 0.916354, 0.013452}, {0.020616, 0.109570, 0.869815}};
    const glm::dmat3 matrix = primaries_matrix(rec709_chromaticities, acescg_chromaticities);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(matrix[column][row], published[row][column], 1e-6) << row << " " << column;
}

TEST(Primaries, WhiteStaysWhiteAndTheWayBackIsTheInverse) {
    const glm::dmat3 there = primaries_matrix(rec709_chromaticities, acescg_chromaticities),
                     back = primaries_matrix(acescg_chromaticities, rec709_chromaticities);
    const glm::dvec3 white = there * glm::dvec3(1.0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(white[c], 1.0, 1e-12);
        for (int r = 0; r < 3; ++r) EXPECT_NEAR((back * there)[c][r], c == r ? 1.0 : 0.0, 1e-12);
    }
}

// Radix sort against std::stable_sort, medians, percentiles as numpy defines them, and the Morton curve's
// closed form.

using Pair = std::pair<std::uint64_t, int>;

std::vector<Pair> values(std::size_t count, std::uint64_t mask) {
    std::vector<Pair> all;
    for (std::size_t i = 0; i < count; ++i)
        all.emplace_back((i + 1) * 0x9e3779b97f4a7c15u & mask, static_cast<int>(i));
    return all;
}

std::vector<Pair> sorted_by_bits(std::vector<Pair> all, unsigned begin, unsigned end) {
    std::vector<Pair> scratch(all.size());
    const Pair* const sorted = radix_sort<8>(
        all.data(), scratch.data(), all.size(), begin, end, [](const Pair& p) { return p.first; }, [] {});
    return {sorted, sorted + all.size()};
}

TEST(RadixSort, IsAStableSortByTheBitsAskedFor) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u, 70000u}) {
        for (const std::uint64_t mask : {~std::uint64_t{0}, std::uint64_t{0xffff00ff00}, std::uint64_t{0}}) {
            std::vector<Pair> expected = values(count, mask);
            std::stable_sort(expected.begin(), expected.end(),
                             [](const Pair& a, const Pair& b) { return a.first < b.first; });
            EXPECT_EQ(sorted_by_bits(values(count, mask), 0, 64), expected) << count << " " << mask;
        }
    }
    std::vector<Pair> expected = values(5000, ~std::uint64_t{0});
    std::stable_sort(expected.begin(), expected.end(), [](const Pair& a, const Pair& b) {
        return (a.first >> 20 & 0xffffu) < (b.first >> 20 & 0xffffu);
    });
    EXPECT_EQ(sorted_by_bits(values(5000, ~std::uint64_t{0}), 20, 36), expected);
}

TEST(RadixSort, ACheckStopsIt) {
    std::vector<Pair> all = values(100, ~std::uint64_t{0}), scratch(100);
    const auto stop = [] { throw std::runtime_error("stopped"); };
    EXPECT_THROW(
        radix_sort<8>(
            all.data(), scratch.data(), all.size(), 0, 64, [](const Pair& p) { return p.first; }, stop),
        std::runtime_error);
}

TEST(Median, IsTheUpperOfTheTwoInTheMiddle) {
    EXPECT_EQ(median(std::vector{5.0f, 1.0f, 4.0f}), 4.0f);
    EXPECT_EQ(median(std::vector{5, 1, 4, 2}), 4);
    EXPECT_EQ(median(std::array{7.5}), 7.5);
    std::vector parts{9, 1, 2, 3, 9};
    EXPECT_EQ(median(std::span(parts).subspan(1, 3)), 2);
    EXPECT_EQ(parts.front(), 9);
}

TEST(Percentile, IsLinearBetweenNeighbours) {
    const std::vector<double> values{5.0, 1.0, 4.0, 2.0};
    EXPECT_EQ(percentile(values, 0.0), 1.0);
    EXPECT_EQ(percentile(values, 1.0), 5.0);
    EXPECT_EQ(percentile(values, 0.5), 3.0);
    EXPECT_NEAR(percentile(values, 0.9), 4.7, 1e-12);
    EXPECT_EQ(percentile({7.0}, 0.3), 7.0);
    EXPECT_EQ(percentile({}, 0.5), 0.0);
}

}  // namespace
}  // namespace astrosplat
