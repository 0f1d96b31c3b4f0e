#include "splats/take_rows.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/shared_maths.h"

namespace astrosplat {
namespace {

template <class T>
void copy_array(const Buffer<T>& from, const Buffer<std::int64_t>& rows, Buffer<T>& to) {
    constexpr std::int64_t rows_at_once = 1 << 16;
    if (from.empty()) return;
    to.resize(rows.size());
    parallel_each(rows.size(), rows_at_once, [&](std::size_t i) { to[i] = from[rows[i]]; });
}

}  // namespace

SplatSet take_rows(const SplatSet& set, const Buffer<std::int64_t>& rows) {
    SplatSet taken;
    static_cast<SplatSetFacts&>(taken) = set;
    for_each_column([&](auto column, SplatColumn) { copy_array(set.*column, rows, taken.*column); });
    return taken;
}

std::int64_t sampled_row(std::int64_t size, std::int64_t count, std::int64_t i) {
    const auto begin_of = [&](std::int64_t stretch) {
        return static_cast<std::int64_t>(static_cast<double>(stretch) * static_cast<double>(size) /
                                         static_cast<double>(count));
    };
    const std::int64_t begin = begin_of(i), end = i + 1 < count ? begin_of(i + 1) : size;
    const float chance = shared::as_uniform(shared::as_hash(1u, static_cast<std::uint32_t>(i), 0u, 0u));
    const auto step = static_cast<std::int64_t>(chance * static_cast<float>(end - begin));
    return std::min(begin + step, end - 1);
}

Buffer<std::int64_t> sampled_rows(std::int64_t size, std::int64_t count) {
    Buffer<std::int64_t> rows(static_cast<std::size_t>(std::min(count, size)));
    const auto sampled = static_cast<std::int64_t>(rows.size());
    for (std::int64_t i = 0; i < sampled; ++i) rows[i] = sampled_row(size, sampled, i);
    return rows;
}

SplatSet sample_rows(const SplatSet& set, std::int64_t count) {
    return take_rows(set, sampled_rows(set.size(), count));
}

}  // namespace astrosplat
