// A picture file as a folder lists it: what a small picture of it is kept under.
#pragma once

#include <cstdint>
#include <filesystem>

namespace astrosplat {

struct ListedPicture {
    std::filesystem::path file;
    std::filesystem::file_time_type changed{};
    std::uintmax_t bytes = 0;
    auto operator<=>(const ListedPicture&) const = default;
};

}  // namespace astrosplat
