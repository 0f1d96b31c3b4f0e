// Radix sort against std::stable_sort, medians, percentiles as numpy defines them, and the Morton curve's
// closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/sorting.h"

namespace astrosplat {
namespace {

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
