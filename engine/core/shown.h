// Words of files in messages. In: a word as it stands in a file. Out: what fits into one line.
#pragma once

#include <string>
#include <string_view>

namespace astrosplat {

/// In quotes, control characters written out, cut after 40 bytes.
std::string shown(std::string_view word);

}  // namespace astrosplat
