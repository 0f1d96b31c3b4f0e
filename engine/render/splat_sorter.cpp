#include "render/screen_splat.h"

#include "core/sorting.h"

namespace astrosplat {
namespace {

constexpr int digit_bits = 11;
constexpr std::size_t check_every = 65536;  // splats between looks at whether to stop

/// The records of runs lie all over memory: asks for those of one that is soon to be read.
void prefetch(std::span<const ScreenSplat> run) {
    const auto* bytes = reinterpret_cast<const char*>(run.data());
    for (std::size_t i = 0; i < run.size_bytes(); i += 64) __builtin_prefetch(bytes + i);
}

}  // namespace

/// Sets codes_ and splats_; returns how many bits of the codes' depths are in use.
int SplatSorter::read(std::span<const std::span<const ScreenSplat>> runs, const Progress& progress) {
    constexpr std::size_t runs_ahead = 3;
    std::size_t n = 0;
    for (const std::span<const ScreenSplat>& run : runs) n += run.size();
    codes_.resize(n);
    other_.resize(n);
    splats_.resize(n);
    order_.resize(n);
    std::uint32_t least = 0xffffffffu, most = 0;
    std::size_t i = 0;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        if (r % 64 == 0) progress.check();
        if (r + runs_ahead < runs.size()) prefetch(runs[r + runs_ahead]);
        for (const ScreenSplat& splat : runs[r]) {
            splats_[i] = &splat;
            codes_[i] = std::uint64_t{splat.depth} << 32 | i;
            least = std::min(least, splat.depth);
            most = std::max(most, splat.depth);
            ++i;
        }
    }
    for (std::uint64_t& code : codes_) code -= std::uint64_t{least} << 32;
    return n == 0 ? 0 : std::bit_width(most - least);
}

/// Sets order_ from the sorted codes. Those whose depths differ in their lowest `open_bits` bits at most, by
/// which the codes are not sorted, are put into total order.
template <class Before>
void SplatSorter::put_in_order(int open_bits, const Before& before, const Progress& progress) {
    const auto close = [&](std::size_t a, std::size_t b) {
        return (codes_[a] ^ codes_[b]) >> (32 + open_bits) == 0;
    };
    for (std::size_t i = 0; i < codes_.size(); ++i) order_[i] = splats_[codes_[i] & 0xffffffffu];
    for (std::size_t begin = 0, end = 1; end <= codes_.size(); ++end) {
        if (end % check_every == 0) progress.check();
        if (end < codes_.size() && close(begin, end)) continue;
        const auto first = order_.begin() + std::ptrdiff_t(begin);
        const auto last = order_.begin() + std::ptrdiff_t(end);
        if (end - begin > 1 && !std::is_sorted(first, last, before)) std::sort(first, last, before);
        begin = end;
    }
}

std::span<const ScreenSplat* const> SplatSorter::sort(std::span<const std::span<const ScreenSplat>> runs,
                                                      const Progress& progress, const TieIds& ids) {
    const int bits = read(runs, progress);
    // Two digits tell nearly all depths of a tile apart.
    const int open_bits = std::max(0, bits - 2 * digit_bits);
    const auto* const sorted = radix_sort<digit_bits>(
        codes_.data(), other_.data(), codes_.size(), unsigned(32 + open_bits), unsigned(32 + bits),
        [](std::uint64_t code) { return code; }, [&] { progress.check(); });
    if (sorted != codes_.data()) codes_.swap(other_);
    if (ids.of_layer.empty())
        put_in_order(
            open_bits, [](const ScreenSplat* a, const ScreenSplat* b) { return in_front_of(*a, *b); },
            progress);
    else
        put_in_order(
            open_bits, [&](const ScreenSplat* a, const ScreenSplat* b) { return in_front_of(*a, *b, ids); },
            progress);
    return order_;
}

}  // namespace astrosplat
