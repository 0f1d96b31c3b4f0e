// Percentiles by counting digits, and the three curves with the engine's own functions.
#include "source/fits.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/real.h"

namespace astrosplat {
namespace {

constexpr int digit_bits = 16, digits = 4;

// Of a finite value: orders as the values do.
std::uint64_t key_of(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 is 0
    constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
    return bits & sign ? ~bits : bits | sign;
}

double value_of(std::uint64_t key) {
    constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
    return std::bit_cast<double>(key & sign ? key & ~sign : ~key);
}

// The value of one rank, found digit by digit: those of the values that begin as it does are counted by
// their next one.
class RankSearch {
  public:
    explicit RankSearch(std::int64_t rank) : rank_(rank), counts_(std::size_t{1} << digit_bits) {}

    void count(std::uint64_t key) {
        const int below = 64 - known_ * digit_bits;  // bits that are not known
        if (known_ > 0 && key >> below != prefix_) return;
        ++counts_[key >> (below - digit_bits) & (counts_.size() - 1)];
    }
    void next_digit() {
        std::size_t digit = 0;
        for (; rank_ >= counts_[digit]; ++digit) rank_ -= counts_[digit];
        prefix_ = prefix_ << digit_bits | digit;
        ++known_;
        std::ranges::fill(counts_, 0);
    }
    double value() const { return value_of(prefix_); }

  private:
    std::int64_t rank_;  // among the values that begin with the prefix
    std::vector<std::int64_t> counts_;
    std::uint64_t prefix_ = 0;
    int known_ = 0;
};

// A place between two ranks.
struct Percentile {
    Percentile(double fraction, std::int64_t count)
        : rank(fraction * double(count - 1)),
          below(std::int64_t(rank)),
          above(std::min(std::int64_t(rank) + 1, count - 1)) {}

    double value() const {
        const double part = rank - std::floor(rank);
        return part == 0.0 ? below.value() : below.value() + (above.value() - below.value()) * part;
    }

    double rank;
    RankSearch below, above;
};

}  // namespace

ValueRange value_range(std::span<const double> values) {
    return value_range([&](const ValueTaker& take) { take(values); });
}

ValueRange value_range(const std::function<void(const ValueTaker&)>& hand_out) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::int64_t count = 0;
    ValueRange range{infinity, -infinity, 0.0, 0.0};
    const auto each_finite = [&](const auto& visit) {
        hand_out([&](std::span<const double> values) {
            for (const double value : values)
                if (std::isfinite(value)) visit(value);
        });
    };
    each_finite([&](double value) {
        ++count;
        range.min = std::min(range.min, value);
        range.max = std::max(range.max, value);
    });
    if (count == 0) return {};
    Percentile black(0.0025, count), white(0.9975, count);
    RankSearch* const searches[] = {&black.below, &black.above, &white.below, &white.above};
    for (int digit = 0; digit < digits; ++digit) {
        each_finite([&](double value) {
            const std::uint64_t key = key_of(value);
            for (RankSearch* search : searches) search->count(key);
        });
        for (RankSearch* search : searches) search->next_digit();
    }
    range.black = black.value();
    range.white = white.value();
    return range;
}

Limits choose_limits(const ValueRange& range, const TextureSettings& settings, const std::string& file) {
    Limits limits{settings.black.value_or(range.black), settings.white.value_or(range.white)};
    const bool set = settings.black || settings.white;
    if (!set && !(limits.black < limits.white)) limits.white = limits.black + 1.0;
    if (!std::isfinite(limits.black) || !std::isfinite(limits.white) || !(limits.black < limits.white))
        bad_input(file, "a black point below the white point",
                  fmt::format("black = {} and white = {}", limits.black, limits.white));
    return limits;
}

StretchCurve::StretchCurve(const Limits& limits, TextureSettings::Stretch stretch, double softening)
    : limits_(limits), stretch_(stretch), softening_(softening) {
    assert(stretch != TextureSettings::Stretch::automatic);
    if (stretch == TextureSettings::Stretch::asinh) of_white_ = real::asinh(1.0 / softening);
    if (stretch == TextureSettings::Stretch::log) of_white_ = real::log(1001.0);
}

double StretchCurve::operator()(double value) const {
    if (std::isnan(value)) return value;
    const double x = std::clamp((value - limits_.black) / (limits_.white - limits_.black), 0.0, 1.0);
    if (stretch_ == TextureSettings::Stretch::asinh) return real::asinh(x / softening_) / of_white_;
    if (stretch_ == TextureSettings::Stretch::log) return real::log(1000.0 * x + 1.0) / of_white_;
    return x;
}

}  // namespace astrosplat
