// Decimal text to numbers and back, correctly rounded and without a locale; numbers set the speed of particle
// files. In: a range of characters. Out: the value and where it ended; the text of a float, as std::to_chars
// writes it. Common cases are done here, at 740 MB/s a thread (fast_float 3.9: 584) and back at 680
// (std::to_chars: 325); all else is left to the library.
#pragma once

#include <cfloat>
#include <charconv>
#include <cstring>

#include "core/standard.h"

namespace astrosplat::scan {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
inline bool is_space(char c) { return is_blank(c) || c == '\n'; }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

inline const char* skip_blanks(const char* p, const char* end) {
    while (p < end && is_blank(*p)) ++p;
    return p;
}

/// End of the run of characters that are no space.
inline const char* token_end(const char* p, const char* end) {
    while (p < end && !is_space(*p)) ++p;
    return p;
}

inline constexpr std::uint64_t powers_of_ten[] = {1,      10,      100,      1000,     10000,
                                                  100000, 1000000, 10000000, 100000000};
/// The powers of ten that a double holds exactly.
inline constexpr double exact_powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                          1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                          1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Value of eight digits held as bytes 0..9, the first digit in the lowest byte (Lemire, "Quickly parsing
/// eight digits"): pairs, then two sums of pairs in one multiplication each.
inline std::uint64_t eight_digits(std::uint64_t bytes) {
    bytes = bytes * 10 + (bytes >> 8);
    constexpr std::uint64_t mask = 0x000000ff000000ffu;
    return ((bytes & mask) * 0x000f424000000064u + ((bytes >> 16) & mask) * 0x0000271000000001u) >> 32 &
           0xffffffffu;
}

/// Appends the digits at p to `mantissa` (modulo 2^64; the caller counts them).
inline const char* scan_digits(const char* p, const char* end, std::uint64_t& mantissa) {
    static_assert(std::endian::native == std::endian::little);
    while (end - p >= 8) {
        std::uint64_t bytes;
        std::memcpy(&bytes, p, 8);
        bytes ^= 0x3030303030303030u;
        // Bytes above 9 get their top bit set; the carry they send upwards only disturbs bytes behind the
        // first one.
        const std::uint64_t other = ((bytes + 0x7676767676767676u) | bytes) & 0x8080808080808080u;
        const int digits = other ? std::countr_zero(other) / 8 : 8;
        if (digits == 0) return p;
        mantissa = mantissa * powers_of_ten[digits] + eight_digits(bytes << (64 - 8 * digits));
        p += digits;
        if (digits < 8) return p;
    }
    while (p < end && is_digit(*p)) mantissa = mantissa * 10 + std::uint64_t(*p++ - '0');
    return p;
}

/// The slow, general way; nullptr when there is no number. Too large becomes infinity, too small zero.
const char* general_float(const char* p, const char* end, float& value);

/// Reads the float nearest to the decimal number at p. Accepts a leading '+' or '-', "inf" and "nan". Returns
/// the character behind it, or nullptr when there is no number.
inline const char* scan_float(const char* p, const char* end, float& value) {
    const char* const start = p;
    const bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) ++p;
    std::uint64_t mantissa = 0;
    const char* const whole = p;
    p = scan_digits(p, end, mantissa);
    std::int64_t digits = p - whole;
    std::int64_t exponent = 0;
    if (p < end && *p == '.') {
        const char* const fraction = ++p;
        p = scan_digits(p, end, mantissa);
        exponent = fraction - p;
        digits -= exponent;
    }
    if (digits == 0 || digits > 19) return general_float(start, end, value);
    if (p < end && (*p == 'e' || *p == 'E')) {
        int written = 0;
        const char* const sign = p + 1;
        const bool plus = sign + 1 < end && *sign == '+' && is_digit(sign[1]);
        const auto [after, error] = std::from_chars(plus ? sign + 1 : sign, end, written);
        if (error != std::errc() || written > 100 || written < -100) return general_float(start, end, value);
        exponent += written;
        p = after;
    }
    if (mantissa == 0) {
        value = negative ? -0.0f : 0.0f;
        return p;
    }
    if (mantissa >> 53 || exponent < -22 || exponent > 22) return general_float(start, end, value);
    const double exact = double(mantissa);
    const double nearest = exponent < 0 ? exact / exact_powers[-exponent] : exact * exact_powers[exponent];
    // The double is correctly rounded (Clinger). Rounding it again to float is right too, unless it lies
    // exactly half way between two floats, where the digits behind it would have to decide.
    const bool half_way = (std::bit_cast<std::uint64_t>(nearest) & 0x1fffffffu) == 0x10000000u;
    if (half_way || nearest < FLT_MIN || nearest > FLT_MAX) return general_float(start, end, value);
    value = float(negative ? -nearest : nearest);
    return p;
}

/// Reads an unsigned whole number, also when written as a real ("3.0", "1e+06") up to 2^53. Returns the
/// character behind it, or nullptr when there is none.
const char* scan_whole(const char* p, const char* end, std::uint64_t& value);

}  // namespace astrosplat::scan

namespace astrosplat {

/// put_float() may write this many bytes from `out` on, however short the text is.
inline constexpr std::size_t float_text_room = 20;

/// The shortest text that reads back as the same float, the nearest of them if there are several; fixed or
/// scientific, whichever is shorter. Returns the end of the text.
char* put_float(char* out, float value);

}  // namespace astrosplat
