// The Hilbert curve's arithmetic on many places at once, and a radix sort by three digits.
#include "generate/curve_order.h"

#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <numeric>

#include "core/morton.h"

namespace astrosplat {
void CurvePlaces::add(const glm::dvec3& p, double reach) {
    const double scale = reach > 0.0 ? 1023.0 / (2.0 * reach) : 0.0;
    const glm::uvec3 cell(glm::clamp((p + reach) * scale, 0.0, 1023.0));
    x_[count_] = cell.x, y_[count_] = cell.y, z_[count_] = cell.z;
    ++count_;
}

// Bit by bit for all at once, so that the compiler makes vectors of it.
const CurvePlaces::Numbers& CurvePlaces::finish() {
    const auto turn = [&](Numbers& axis, std::uint32_t bit) {
        for (std::size_t i = 0; i < most; ++i) {
            const std::uint32_t low = bit - 1, flip = axis[i] & bit ? low : 0;
            const std::uint32_t swapped = (x_[i] ^ axis[i]) & (low ^ flip);
            x_[i] ^= flip | swapped;
            axis[i] ^= swapped;
        }
    };
    for (std::uint32_t bit = 512; bit > 1; bit >>= 1) {
        for (std::size_t i = 0; i < most; ++i) x_[i] ^= x_[i] & bit ? bit - 1 : 0;
        turn(y_, bit);
        turn(z_, bit);
    }
    for (std::size_t i = 0; i < most; ++i) {
        y_[i] ^= x_[i];
        z_[i] ^= y_[i];
        std::uint32_t turned = 0;
        for (std::uint32_t bit = 512; bit > 1; bit >>= 1) turned ^= z_[i] & bit ? bit - 1 : 0;
        x_[i] = static_cast<std::uint32_t>(morton_place(z_[i] ^ turned, y_[i] ^ turned, x_[i] ^ turned));
    }
    count_ = 0;
    return x_;
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
