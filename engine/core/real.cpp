// Elementary functions from additions, multiplications, divisions and square roots alone, which IEEE 754
// rounds the same everywhere. Method: reduce the argument exactly (Cody and Waite, "Software Manual for the
// Elementary Functions"), sum the Taylor series on the small rest, and carry the rounding error of the
// leading term as a second double where it would show.
#include "core/real.h"

#include <cstring>

namespace astrosplat::real {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A number as an unevaluated sum; |lo| is at most half a unit in the last place of hi.
struct Pair {
    double hi;
    double lo;
};

// hi + lo == a + b exactly (Knuth).
Pair two_sum(double a, double b) {
    const double hi = a + b;
    const double part = hi - a;
    return {hi, (a - (hi - part)) + (b - part)};
}

Pair difference(Pair a, Pair b) {
    const Pair d = two_sum(a.hi, -b.hi);
    return {d.hi, d.lo + (a.lo - b.lo)};
}

// hi + lo == a * b exactly (Dekker's splitting by 2^27 + 1; |a|, |b| < 2^995).
Pair two_product(double a, double b) {
    constexpr double splitter = 134217729.0;
    const double ta = splitter * a, tb = splitter * b;
    const double ah = ta - (ta - a), al = a - ah;
    const double bh = tb - (tb - b), bl = b - bh;
    const double hi = a * b;
    return {hi, ((ah * bh - hi) + ah * bl + al * bh) + al * bl};
}

// c[0] + c[1] x + c[2] x^2 + ...
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) {
    double sum = c[N - 1];
    for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + c[i];
    return sum;
}

// sign^i / (first + step i)!
template <std::size_t N>
constexpr std::array<double, N> inverse_factorials(int first, int step, double sign) {
    std::array<double, N> c{};
    double factorial = 1.0, s = 1.0;  // factorials up to 22! are exact in double
    for (int k = 2; k <= first; ++k) factorial *= k;
    for (std::size_t i = 0; i < N; ++i) {
        c[i] = s / factorial;
        for (int k = 1; k <= step; ++k) factorial *= first + int(i) * step + k;
        s *= sign;
    }
    return c;
}

// sign^i / (3 + 2 i), the series of atanh (sign 1) and atan (sign -1) behind their linear term.
template <std::size_t N>
constexpr std::array<double, N> inverse_odds(double sign) {
    std::array<double, N> c{};
    double s = 1.0;
    for (std::size_t i = 0; i < N; ++i, s *= sign) c[i] = s / double(3 + 2 * i);
    return c;
}

// 2^k, -1022 <= k <= 1023.
double power_of_two(int k) {
    const std::uint64_t bits = std::uint64_t(k + 1023) << 52;
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

constexpr double ln2_hi = 0x1.62e42feep-1;  // 32 bits, so that a product with an exponent is exact
constexpr double ln2_lo = 0x1.a39ef35793c76p-33;

// e^(x.hi + x.lo), |x.hi| < 750: e^r * 2^k with |r| <= ln(2) / 2.
double exp_pair(Pair x) {
    static constexpr auto c = inverse_factorials<13>(2, 1, 1.0);
    const double k = std::floor(x.hi * 1.4426950408889634 + 0.5);
    const Pair r = two_sum(x.hi - k * ln2_hi, -k * ln2_lo);
    const double tail = r.lo + x.lo;
    const double q = r.hi * r.hi * polynomial(c, r.hi);
    const double p = 1.0 + (r.hi + (q + tail * (1.0 + (r.hi + q))));
    const int half = int(k) / 2;  // two steps: 2^k alone may lie outside the range of doubles
    return p * power_of_two(half) * power_of_two(int(k) - half);
}

// ln x for finite x > 0: 2 atanh(s) + e ln 2 with s = (m - 1) / (m + 1), x = m 2^e, m within sqrt(2) of 1.
Pair log_pair(double x) {
    static constexpr auto c = inverse_odds<13>(1.0);
    int e = 0;
    double m = std::frexp(x, &e);  // exact
    if (m < 0.70710678118654752) {
        m *= 2.0;
        --e;
    }
    const double f = m - 1.0;
    const Pair d = two_sum(2.0, f);
    const double s = f / d.hi;
    const Pair back = two_product(s, d.hi);
    const double s_lo = ((f - back.hi) - back.lo - s * d.lo) / d.hi;
    const double z = s * s;
    const Pair sum = two_sum(e * ln2_hi, 2.0 * s);
    return two_sum(sum.hi, sum.lo + (e * ln2_lo + 2.0 * (s_lo + s * (z * polynomial(c, z)))));
}

struct Reduced {
    Pair rest;     // |rest| <= pi / 4
    int quadrant;  // 0..3
};

// x less the nearest multiple of pi / 2, which is taken in four parts of 33 bits.
Reduced reduce(double x) {
    if (std::fabs(x) > 1e6)
        x = std::fmod(x, 2.0 * pi);  // beyond the promised range: still the same bits everywhere
    const double k = std::floor(x * 0.63661977236758138 + 0.5);
    const Pair a = two_sum(x - k * 0x1.921fb544p+0, -k * 0x1.0b4611a6p-34);
    const Pair b = two_sum(a.hi, -k * 0x1.3198a2ep-69);
    const Pair rest = two_sum(b.hi, a.lo + b.lo - k * 0x1.b839a252049c1p-104);
    return {rest, int(std::int64_t(k) & 3)};
}

Pair sin_series(Pair x) {
    static constexpr auto c = inverse_factorials<8>(3, 2, -1.0);
    const double z = x.hi * x.hi;
    return two_sum(x.hi, x.lo * (1.0 - 0.5 * z) - x.hi * z * polynomial(c, z));
}

Pair cos_series(Pair x) {
    static constexpr auto c = inverse_factorials<8>(4, 2, -1.0);
    const double z = x.hi * x.hi;
    const double leading = 1.0 - 0.5 * z;
    return two_sum(leading, ((1.0 - leading) - 0.5 * z) + (z * z * polynomial(c, z) - x.hi * x.lo));
}

// atan(i / 8) to twice the precision of a double.
constexpr Pair atan_of_eighths[9] = {{0.0, 0.0},
                                     {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                     {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                     {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                     {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                     {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                     {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                     {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

constexpr Pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

// atan(y / x) for 0 <= y <= x, x > 0: atan(c) + atan((y - c x) / (x + c y)) with c the nearest eighth.
Pair atan_ratio(double y, double x) {
    static constexpr auto series = inverse_odds<8>(-1.0);
    const int eighth = int(std::floor(y / x * 8.0 + 0.5));
    const double c = eighth * 0.125;
    const double t = (y - c * x) / (x + c * y);
    const double z = t * t;
    const Pair sum = two_sum(atan_of_eighths[eighth].hi, t);
    return {sum.hi, sum.lo + (atan_of_eighths[eighth].lo - t * z * polynomial(series, z))};
}

// a / b, rounded once but for the last correction.
double quotient(Pair a, Pair b) {
    const double q = a.hi / b.hi;
    const Pair back = two_product(q, b.hi);
    return q + (((a.hi - back.hi) - back.lo) + (a.lo - q * b.lo)) / b.hi;
}

// ln(1 + x) for x >= 0; the second term restores what rounding 1 + x loses.
double log1p(double x) {
    const Pair u = two_sum(1.0, x);
    const Pair l = log_pair(u.hi);
    return l.hi + (l.lo + u.lo / u.hi);
}

}  // namespace

double sin(double x) {
    if (!std::isfinite(x)) return nan;
    const Reduced r = reduce(x);
    const double value = (r.quadrant & 1 ? cos_series(r.rest) : sin_series(r.rest)).hi;
    return r.quadrant & 2 ? -value : value;
}

double cos(double x) {
    if (!std::isfinite(x)) return nan;
    const Reduced r = reduce(x);
    const double value = (r.quadrant & 1 ? sin_series(r.rest) : cos_series(r.rest)).hi;
    return r.quadrant == 1 || r.quadrant == 2 ? -value : value;
}

double tan(double x) {
    if (!std::isfinite(x)) return nan;
    const Reduced r = reduce(x);
    const Pair s = sin_series(r.rest), c = cos_series(r.rest);
    return r.quadrant & 1 ? -quotient(c, s) : quotient(s, c);
}

const std::array<double, 14> circle_numbers = [] {
    std::array<double, 14> numbers{half_pi.hi};
    std::ranges::copy(inverse_factorials<6>(3, 2, -1.0), numbers.begin() + 1);
    std::ranges::copy(inverse_factorials<7>(4, 2, -1.0), numbers.begin() + 7);
    return numbers;
}();

using glm::vec2;
#include "circle.glsl"

double atan2(double y, double x) {
    if (std::isnan(x) || std::isnan(y)) return nan;
    double ax = std::fabs(x), ay = std::fabs(y);
    if (ax == 0.0 && ay == 0.0) return 0.0;
    if (std::isinf(ax) || std::isinf(ay)) {
        ax = std::isinf(ax) ? 1.0 : 0.0;
        ay = std::isinf(ay) ? 1.0 : 0.0;
    }
    if (std::fmax(ax, ay) > 1e300) {  // sums below must not overflow
        ax *= 0x1p-60;
        ay *= 0x1p-60;
    }
    const bool steep = ay > ax;
    Pair angle = steep ? difference(half_pi, atan_ratio(ax, ay)) : atan_ratio(ay, ax);
    if (x < 0.0) angle = difference({2.0 * half_pi.hi, 2.0 * half_pi.lo}, angle);
    const double value = angle.hi + angle.lo;
    return y < 0.0 ? -value : value;
}

double atan(double x) { return x == 0.0 ? x : atan2(x, 1.0); }

double asin(double x) {
    x = x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x;
    return atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}

double acos(double x) {
    x = x < -1.0 ? -1.0 : x > 1.0 ? 1.0 : x;
    return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

double exp(double x) {
    if (std::isnan(x)) return nan;
    if (x > 709.79) return infinity;
    if (x < -745.2) return 0.0;
    return exp_pair({x, 0.0});
}

double log(double x) {
    if (x == 0.0) return -infinity;
    if (!(x > 0.0)) return nan;
    if (std::isinf(x)) return x;
    const Pair l = log_pair(x);
    return l.hi + l.lo;
}

double pow(double x, double y) {
    if (y == 0.0 || x == 1.0) return 1.0;
    if (std::isnan(y) || !(x >= 0.0)) return nan;
    if (y == 1.0) return x;
    if (x == 0.0) return y > 0.0 ? 0.0 : infinity;
    if (std::isinf(x)) return y > 0.0 ? infinity : 0.0;
    const Pair l = log_pair(x);
    if (std::fabs(y * l.hi) > 750.0) return exp(y * l.hi);
    const Pair product = two_product(y, l.hi);
    return exp_pair({product.hi, product.lo + y * l.lo});
}

double asinh(double x) {
    const double a = std::fabs(x);
    if (!(a < infinity)) return x;
    double value = 0.0;
    if (a > 1e9) {
        value = log(a) + 0.69314718055994531;  // a + sqrt(a^2 + 1) is 2a to the last bit
    } else {
        const double square = a * a;
        value = log1p(a + square / (1.0 + std::sqrt(square + 1.0)));
    }
    return x < 0.0 ? -value : value;
}

}  // namespace astrosplat::real
