// Folders listed beside the window (disk_question.h). In: a folder. Out: what is in it, when that is known.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gui/disk_question.h"
#include "gui/file_list.h"

namespace astrosplat {

struct FolderContents {
    std::filesystem::path folder;  // without symbolic links, as far as it exists
    std::vector<FileEntry> entries;
};

class FolderReader {
  public:
    /// Begins; what was asked for before is forgotten. `otherwise` is read where there is no such folder.
    /// `extensions` as list_folder has them.
    void begin(const std::filesystem::path& folder, const std::filesystem::path& otherwise,
               const std::vector<std::string>& extensions);
    /// The answer to begin() is not known yet.
    bool reading() const { return question_.is_open(); }
    /// The result, once; waits for it up to this long.
    std::optional<FolderContents> take(std::chrono::milliseconds at_most = {}) {
        return question_.take(at_most);
    }

  private:
    DiskQuestion<FolderContents> question_;
};

}  // namespace astrosplat
