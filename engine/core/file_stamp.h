// What tells that a file on the disk was touched, without reading it.
#pragma once

#include <cstdint>
#include <filesystem>

namespace astrosplat {

/// When and how large a file was, and which one has the name: replacing it by renaming another changes that
/// alone. All 0 where there is no file, or none that may be looked at.
struct FileStamp {
    std::int64_t seconds = 0, nanoseconds = 0;  // of its last change
    std::int64_t size = 0;                      // bytes
    std::uint64_t device = 0, inode = 0;
    bool operator==(const FileStamp&) const = default;
};
FileStamp stamp_of(const std::filesystem::path& file);

}  // namespace astrosplat
