// Files that other programs may write while they are in use here: the document's own, and those that its
// scene reads. In: their names, and a look at the disk now and then. Out: whether they were changed.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

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
    /// The file as it is now counts as seen.
    void accept();

  private:
    std::filesystem::path file_;  // empty: there is none
    FileStamp checked_;           // at the last look
    std::string hash_;
    bool changed_ = false;  // what that look found
};

class WatchedFiles {
  public:
    /// Watches these from now on; what is known of those watched already stays.
    void watch(const std::vector<std::filesystem::path>& files);
    /// Files whose date or size differ from those when they were first watched or last returned, or that have
    /// appeared, and that lie there as they did at the call before. A file that is gone is waited for: many
    /// programs write a file by replacing it.
    std::vector<std::filesystem::path> changed();

  private:
    struct Entry {
        FileStamp known, seen;  // as returned last; at the last call
    };

    std::map<std::filesystem::path, Entry> files_;
};

}  // namespace astrosplat
