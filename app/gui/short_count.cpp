#include "gui/short_count.h"

#include <fmt/format.h>

namespace astrosplat {

std::string short_count(std::int64_t count) {
    const double n = static_cast<double>(count);
    if (count < 1000) return fmt::format("{}", count);
    if (n < 9.95e3) return fmt::format("{:.1f} k", n / 1e3);
    if (n < 999.5e3) return fmt::format("{:.0f} k", n / 1e3);
    if (n < 99.95e6) return fmt::format("{:.1f} M", n / 1e6);
    if (n < 999.5e6) return fmt::format("{:.0f} M", n / 1e6);
    return fmt::format("{:.1f} G", n / 1e9);
}

std::string splat_count(std::int64_t count) {
    return short_count(count) + (count == 1 ? " splat" : " splats");
}

}  // namespace astrosplat
