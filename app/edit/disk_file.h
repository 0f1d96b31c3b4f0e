// What is known of a file that others may change: when and how large it was, and a hash of its bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/file.h"

namespace astrosplat {

/// A file as it was last seen. Two calls of changed() cost two look-ups in its folder; its bytes are read
/// only when date or size say that it was touched.
class DiskFile {
  public:
    DiskFile() = default;
    /// `content` is what the file holds.
    DiskFile(const std::filesystem::path& file, std::string_view content);

    /// Its bytes differ from those last seen. A file that is gone or unreadable has not changed.
    bool changed();
    /// What lies there now counts as seen.
    void accept();

  private:
    std::filesystem::path file_;  // empty: there is none
    FileStamp checked_;           // at the last look
    std::string hash_;
    bool changed_ = false;  // what that look found
};

}  // namespace astrosplat
