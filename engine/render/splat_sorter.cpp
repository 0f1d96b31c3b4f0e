#include "render/splat_sorter.h"

#include <algorithm>

namespace astrosplat {
namespace {

constexpr int digit_bits = 11;
constexpr std::uint32_t digits = 1u << digit_bits;
constexpr std::size_t check_every = 65536;  // splats between looks at whether to stop

/// One stable pass by the digit of the key that begins at bit `shift`.
void sort_by_digit(const std::vector<std::uint64_t>& from, std::vector<std::uint64_t>& to, int shift,
                   const Progress& progress) {
    std::uint32_t start[digits + 1] = {};
    const auto digit = [shift](std::uint64_t key) { return key >> shift & (digits - 1u); };
    for (const std::uint64_t key : from) ++start[digit(key) + 1];
    for (std::uint32_t d = 0; d < digits; ++d) start[d + 1] += start[d];
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (i % check_every == 0) progress.check();
        to[start[digit(from[i])]++] = from[i];
    }
}

/// Runs of equal depth, which the radix sort left in the order in which they came, into total order.
void sort_ties(std::vector<const ScreenSplat*>& order, const Progress& progress) {
    const auto before = [](const ScreenSplat* a, const ScreenSplat* b) { return in_front_of(*a, *b); };
    for (std::size_t begin = 0; begin + 1 < order.size();) {
        if (begin % 1024 == 0) progress.check();
        std::size_t end = begin + 1;
        while (end < order.size() && order[end]->depth == order[begin]->depth) ++end;
        const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto last = order.begin() + static_cast<std::ptrdiff_t>(end);
        if (end - begin > 1 && !std::is_sorted(first, last, before)) std::sort(first, last, before);
        begin = end;
    }
}

}  // namespace

std::span<const ScreenSplat* const> SplatSorter::sort(std::span<const std::span<const ScreenSplat>> runs,
                                                      const Progress& progress) {
    std::size_t n = 0;
    for (const std::span<const ScreenSplat>& run : runs) n += run.size();
    keys_.resize(n);
    other_.resize(n);
    splats_.resize(n);
    order_.resize(n);
    std::uint32_t all_or = 0, all_and = 0xffffffffu;
    std::size_t i = 0;
    for (const std::span<const ScreenSplat>& run : runs) {
        progress.check();
        for (const ScreenSplat& splat : run) {
            splats_[i] = &splat;
            keys_[i] = std::uint64_t{splat.depth} << 32 | i;
            all_or |= splat.depth;
            all_and &= splat.depth;
            ++i;
        }
    }
    for (int shift = 0; shift < 32; shift += digit_bits) {
        if (((all_or ^ all_and) >> shift & (digits - 1u)) == 0) continue;  // the same for all
        sort_by_digit(keys_, other_, 32 + shift, progress);
        keys_.swap(other_);
    }
    bool ties = false;
    for (i = 0; i < n; ++i) {
        order_[i] = splats_[keys_[i] & 0xffffffffu];
        ties = ties || (i > 0 && keys_[i] >> 32 == keys_[i - 1] >> 32);
    }
    if (ties) sort_ties(order_, progress);
    return order_;
}

}  // namespace astrosplat
