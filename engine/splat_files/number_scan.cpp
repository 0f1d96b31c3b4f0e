// The rare cases of number scanning: long mantissas, extreme exponents, denormals, halves, inf and nan.
#include "splat_files/number_scan.h"

#include <cmath>
#include <limits>
#include <string_view>

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
        value = std::fabs(wide) > 1.0 ? std::numeric_limits<float>::infinity() : static_cast<float>(wide);
    } else {  // outside of double as well: below it exactly where the exponent is negative
        const std::string_view token(p, static_cast<std::size_t>(after - p));
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
    value = static_cast<std::uint64_t>(real);
    return real_after;
}

}  // namespace astrosplat::scan
