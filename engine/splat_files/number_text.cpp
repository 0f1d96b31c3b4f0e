// Rare cases of reading: long mantissas, extreme exponents, denormals, halves, inf, nan. Writing: floats of
// 0.001 to 100000 are short in fixed notation and small enough for exact 64-bit arithmetic, without the
// tables of general methods (Ryu, Schubfach: R. Giulietti, "The Schubfach way to render doubles", whose
// choice among candidates is taken). Digits are made eight at a time in a register.
#include "splat_files/number_text.h"

namespace astrosplat::scan {

const char* general_float(const char* p, const char* end, float& value) {
    if (p < end && *p == '+') {
        ++p;
        if (p < end && *p == '-') return nullptr;
    }
    const auto [after, error] = std::from_chars(p, end, value);
    if (error == std::errc()) return after;
    if (error != std::errc::result_out_of_range) return nullptr;
    double wide = 0.0;
    if (std::from_chars(p, end, wide).ec == std::errc()) {
        value = std::fabs(wide) > 1.0 ? std::numeric_limits<float>::infinity() : float(wide);
    } else {  // outside of double as well: below it exactly where the exponent is negative
        const std::string_view token(p, std::size_t(after - p));
        const bool tiny = token.find("e-") != token.npos || token.find("E-") != token.npos;
        value = tiny ? 0.0f : std::numeric_limits<float>::infinity();
    }
    value = std::copysign(value, *p == '-' ? -1.0f : 1.0f);
    return after;
}

const char* scan_whole(const char* p, const char* end, std::uint64_t& value) {
    const auto [after, error] = std::from_chars(p, end, value);
    if (error == std::errc() && (after == end || is_space(*after))) return after;
    double real = 0.0;
    const auto [real_after, real_error] = std::from_chars(p, end, real);
    constexpr double exact = 9007199254740992.0;  // 2^53
    if (real_error != std::errc() || !(real >= 0.0 && real <= exact) || real != std::floor(real))
        return nullptr;
    value = std::uint64_t(real);
    return real_after;
}

}  // namespace astrosplat::scan

namespace astrosplat {
namespace {

static_assert(std::endian::native == std::endian::little, "the first digit is the lowest byte of a word");

constexpr int decimals = 10;  // behind the point in fixed point: enough for the last digit of 0.001
constexpr std::uint64_t powers_of_ten[] = {1,       10,       100,       1000,       10000,      100000,
                                           1000000, 10000000, 100000000, 1000000000, 10000000000};
constexpr std::uint64_t ascii_zeros = 0x3030303030303030u;
constexpr std::uint64_t hundred_million = 100000000;

void store(char* out, std::uint64_t word) { std::memcpy(out, &word, sizeof word); }

/// The eight digits of a number below 10^8 as bytes 0..9, the first digit in the lowest byte: halves of four
/// digits, of two, of one. Each step divides by a multiplication that is exact for numbers of that size, and
/// x - (x / n) n moves up by one field: q + ((x - q n) << w) = (x << w) - q ((n << w) - 1).
std::uint64_t eight_digits(std::uint64_t number) {
    const std::uint64_t fours = (number << 32) - number / 10000 * ((std::uint64_t{10000} << 32) - 1);
    const std::uint64_t hundreds = (fours * 10486 >> 20) & 0x0000007f0000007fu;
    const std::uint64_t twos = (fours << 16) - hundreds * ((100u << 16) - 1);
    const std::uint64_t tens = (twos * 103 >> 10) & 0x000f000f000f000fu;
    return (twos << 8) - tens * ((10u << 8) - 1);
}

/// The digits up to the last one that is not zero, of eight that are not all zero.
int significant_digits(std::uint64_t digits) { return (63 - std::countl_zero(digits)) / 8 + 1; }

/// Constants for the exponent q of a float c 2^q.
struct Scale {
    std::uint64_t power;   // 10^e, where 10^-e <= 2^q < 10^(1-e)
    std::uint64_t filler;  // 10^(decimals - e)
    int unit;              // 2 - q
};

// Bits of the first float that is done here, of the first above that is not, and the exponent of the former.
constexpr auto smallest = std::bit_cast<std::uint32_t>(0.001f), end = std::bit_cast<std::uint32_t>(1e5f);
constexpr std::uint32_t first_exponent = smallest >> 23;

constexpr auto scales = [] {
    std::array<Scale, (end >> 23) - first_exponent + 1> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const int minus_q = 150 - int(first_exponent + i);
        int e = 0;
        while (powers_of_ten[e] < std::uint64_t{1} << minus_q) ++e;
        table[i] = {powers_of_ten[e], powers_of_ten[decimals - e], minus_q + 2};
    }
    return table;
}();

/// The shortest decimal that rounds to the float of these bits, the nearest if there are several, times
/// 10^decimals. Counted in 2^(q-2) 10^-e everything is a whole number below 2^62: the float is `value`, its
/// neighbours are 4 power away, the decimals with e places `1 << unit` apart. The nearest of these always
/// rounds to the float, and of those with e-1 places at most one does. (Below a power of two the neighbour is
/// only half as far away; in our range powers of two have at most e-1 places themselves.)
std::uint64_t shortest_fixed_point(std::uint32_t bits) {
    const Scale& scale = scales[(bits >> 23) - first_exponent];
    const std::uint64_t c = (bits & 0x7fffffu) | 0x800000u;
    const std::uint64_t value = 4 * c * scale.power;
    const std::uint64_t margin = 2 * scale.power - (c & 1);  // a decimal on the border rounds to even
    const std::uint64_t below = value >> scale.unit;
    const std::uint64_t half = std::uint64_t{1} << (scale.unit - 1);
    const std::uint64_t fine = (value + half - 1 + (below & 1)) >> scale.unit;  // nearest, ties to even
    const std::uint64_t coarse = (below + 5) / 10 * 10;
    const bool is_coarse = value - (coarse << scale.unit) + margin <= 2 * margin;
    // Chosen by a mask, because a branch would be unpredictable.
    const std::uint64_t is_fine = std::uint64_t(is_coarse) - 1;
    return (coarse ^ ((coarse ^ fine) & is_fine)) * scale.filler;
}

/// Writes a number of at most 16 digits with `decimals` of them behind the point, no zeros at either end.
char* put_fixed_point(char* out, std::uint64_t number) {
    const std::uint64_t high = eight_digits(number / hundred_million);
    const std::uint64_t low = eight_digits(number % hundred_million);
    constexpr int whole_places = 16 - decimals;
    constexpr std::uint64_t last_whole = std::uint64_t{1} << (8 * whole_places - 8);  // "0.5" keeps its zero
    const int zeros = std::countr_zero(high | last_whole) / 8;
    store(out, (high | ascii_zeros) >> (8 * zeros));
    out += whole_places - zeros;
    *out++ = '.';
    const std::uint64_t tenths = high >> (8 * whole_places);
    store(out, tenths | ascii_zeros);
    store(out + 8 - whole_places, low | ascii_zeros);
    if (low) return out + 8 - whole_places + significant_digits(low);
    return tenths ? out + significant_digits(tenths) : out - 1;
}

}  // namespace

char* put_float(char* out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t magnitude = bits & 0x7fffffffu;
    if (magnitude - smallest >= end - smallest) return std::to_chars(out, out + float_text_room, value).ptr;
    *out = '-';
    return put_fixed_point(out + (bits >> 31), shortest_fixed_point(magnitude));
}

}  // namespace astrosplat
