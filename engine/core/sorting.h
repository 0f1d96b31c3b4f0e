// Values in order, on one thread: a stable radix sort in linear time, medians and percentiles.
#pragma once

#include <ranges>

#include "core/standard.h"

namespace astrosplat {

/// Sorts `count` values, fewer than 2^32, by bits begin_bit .. end_bit-1 of bits_of(value), lowest digit
/// first; where the last digit reaches beyond end_bit, bits are to be 0 there. A digit that all values share
/// costs no pass. Returns `values` or `scratch`, whichever holds the result. `check()` is called now and then
/// and may throw.
template <unsigned digit_bits, class T, class BitsOf, class Check>
T* radix_sort(T* values, T* scratch, std::size_t count, unsigned begin_bit, unsigned end_bit, BitsOf bits_of,
              Check check) {
    constexpr std::uint32_t digits = 1u << digit_bits;
    constexpr std::size_t check_every = 65536;  // values
    assert(count <= std::numeric_limits<std::uint32_t>::max());
    for (unsigned shift = begin_bit; shift < end_bit && count > 0; shift += digit_bits) {
        const auto digit = [&](const T& value) { return bits_of(value) >> shift & (digits - 1u); };
        std::array<std::uint32_t, digits> next{};
        for (std::size_t i = 0; i < count; ++i) ++next[digit(values[i])];
        if (next[digit(values[0])] == count) continue;
        std::uint32_t sum = 0;
        for (std::uint32_t& n : next) sum += std::exchange(n, sum);
        for (std::size_t i = 0; i < count; ++i) {
            if (i % check_every == 0) check();
            scratch[next[digit(values[i])]++] = values[i];
        }
        std::swap(values, scratch);
    }
    return values;
}

/// The value with half of the others below it, the upper one of two: one that occurs, never a mean of two.
/// The values are left in another order; there is to be at least one, and no NaN.
template <std::ranges::random_access_range Values>
auto median(Values&& values) {
    assert(!std::ranges::empty(values));
    const auto middle = std::ranges::begin(values) + std::ranges::ssize(values) / 2;
    std::ranges::nth_element(values, middle);
    return std::ranges::range_value_t<Values>(*middle);
}

/// The value below which the given share (0..1) of the numbers lies, linear between neighbours: 0 gives the
/// least, 1 the greatest, 1/2 the mean of the two in the middle. 0 for an empty list; NaN must not occur.
inline double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const double rank = share * double(values.size() - 1), below = std::floor(rank);
    const auto at = values.begin() + std::ptrdiff_t(below);
    std::nth_element(values.begin(), at, values.end());
    if (rank == below) return *at;
    return *at + (*std::min_element(at + 1, values.end()) - *at) * (rank - below);
}

}  // namespace astrosplat
