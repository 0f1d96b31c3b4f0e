// The headers of the standard library that nearly every file needs, and the short name of its paths
// and files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace astrosplat {

namespace fs = std::filesystem;

}  // namespace astrosplat
