// What the readers of the three formats of frames find in a file's header. Each answers nothing where the
// file is none of its format or damaged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/image.h"

namespace astrosplat {

struct StoredHeader {
    std::int64_t whole_width = 0, whole_height = 0;  // px
    Region region{};                                 // of what is stored in the whole
    std::map<std::string, std::string> texts;        // "astrosplat/frameHash", ..., "view"
    bool dwaa = false;                               // compressed with a loss
};

}  // namespace astrosplat
