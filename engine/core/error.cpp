// The one shape of a bad-input message.
#include "core/error.h"

#include <fmt/format.h>

namespace astrosplat {

void bad_input(std::string_view file, std::string_view place, std::string_view expected,
               std::string_view found) {
    const std::string where = place.empty() ? std::string(file) : fmt::format("{}:{}", file, place);
    throw InputError(fmt::format("{}: expected {}, found {}", where, expected, found));
}

}  // namespace astrosplat
