// The one shape of a bad-input message.
#include "core/error.h"

#include <fmt/format.h>

namespace astrosplat {

void bad_input(const fs::path& file, std::string_view place, std::string_view expected,
               std::string_view found) {
    const std::string colon = place.empty() ? "" : ":";
    throw InputError(
        fmt::format("{}{}{}: expected {}, found {}", file.string(), colon, place, expected, found));
}

void bad_input(const fs::path& file, std::string_view expected, std::string_view found) {
    bad_input(file, "", expected, found);
}

}  // namespace astrosplat
