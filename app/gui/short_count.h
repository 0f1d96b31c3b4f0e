// Numbers of splats, as the whole window writes them. In: a count. Out: "340", "1.2 k", "12.4 M".
#pragma once

#include <cstdint>
#include <string>

namespace astrosplat {

/// Three digits at most, thousands as k, M, G. `count` >= 0.
std::string short_count(std::int64_t count);

/// "2.9 M splats", "1 splat".
std::string splat_count(std::int64_t count);

}  // namespace astrosplat
