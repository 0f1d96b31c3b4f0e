// Rows of a splat set in another order. In: a bin for each row, and ids. Out: the rows' numbers in
// order of bin, then id; and arrays gathered in such an order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/buffer.h"

namespace astrosplat {

/// True when ids ascend; equal ones may follow each other.
bool ids_ascend(const Buffer<std::uint64_t>& ids);

/// The rows in ascending order of bin, those of equal bin in ascending order of id, those of equal id in
/// ascending order. Bins are below `bin_count`. The same for any thread count. Row: std::uint32_t, for
/// fewer than 2^32 rows, or std::uint64_t.
template <class Row>
Buffer<Row> rows_by_bin(const Buffer<std::uint32_t>& bins, std::size_t bin_count,
                        const Buffer<std::uint64_t>& ids);

/// Copies the rows one after the other to `out`, which need not be aligned, and returns its end. They lie
/// anywhere in memory, so that fetching them ahead of time is worth more than all else here.
template <class T, class Row>
char* gather(const T* from, std::span<const Row> rows, char* out) {
    constexpr std::size_t ahead = 256;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        __builtin_prefetch(from + rows[std::min(i + ahead, rows.size() - 1)]);
        std::memcpy(out, from + rows[i], sizeof(T));
        out += sizeof(T);
    }
    return out;
}

}  // namespace astrosplat
