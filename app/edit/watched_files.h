// Files that others may write while they are in use here. In: their names, and a look at the disk now and
// then. Out: those that were changed, once the program that writes them has finished.
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "core/file.h"

namespace astrosplat {

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
