// Sorting by some bits of each value, on one thread: stable, in linear time. In: values, scratch of the same
// size and which bits count. Out: where the sorted values lie.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

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

}  // namespace astrosplat
