#include "splats/curve_order.h"

#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <numeric>

namespace astrosplat {
namespace {

// Bits 0..9 of v to every third bit.
std::uint32_t spread_bits(std::uint32_t v) {
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

}  // namespace

std::uint32_t curve_place(const glm::dvec3& p, double reach) {
    const double scale = reach > 0.0 ? 1023.0 / (2.0 * reach) : 0.0;
    glm::uvec3 cell(glm::clamp((p + reach) * scale, 0.0, 1023.0));
    for (std::uint32_t bit = 512; bit > 1; bit >>= 1) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const std::uint32_t swapped = (cell.x ^ cell[axis]) & (bit - 1), flip = cell[axis] & bit;
            cell.x ^= flip ? bit - 1 : swapped;
            cell[axis] ^= flip ? 0 : swapped;
        }
    }
    cell.y ^= cell.x;
    cell.z ^= cell.y;
    std::uint32_t turned = 0;
    for (std::uint32_t bit = 512; bit > 1; bit >>= 1) turned ^= cell.z & bit ? bit - 1 : 0;
    cell ^= turned;
    return spread_bits(cell.x) << 2 | spread_bits(cell.y) << 1 | spread_bits(cell.z);
}

void sort_by_place(Buffer<std::uint64_t>& order) {
    constexpr unsigned digit_bits = 10;
    Buffer<std::uint64_t> other(order.size());
    for (unsigned shift = 32; shift < 62; shift += digit_bits) {
        const auto digit = [&](std::uint64_t v) { return v >> shift & ((1u << digit_bits) - 1u); };
        std::array<std::size_t, std::size_t{1} << digit_bits> next{};
        for (const std::uint64_t v : order) ++next[digit(v)];
        std::exclusive_scan(next.begin(), next.end(), next.begin(), std::size_t{0});
        for (const std::uint64_t v : order) other[next[digit(v)]++] = v;
        order.swap(other);
    }
}

}  // namespace astrosplat
