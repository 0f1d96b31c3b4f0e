// "Did you mean ...?": the nearest of the known names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace astrosplat {

/// Number of insertions, deletions, substitutions and swaps of neighbours that turn a into b.
int edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `name`, or "" when none is near. Dotted keys may also match by their last part,
/// so that a right key in the wrong section is found.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

/// "; did you mean 'NAME'?" or "".
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

}  // namespace astrosplat
