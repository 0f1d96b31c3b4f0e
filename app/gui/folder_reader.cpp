#include "gui/folder_reader.h"

#include <atomic>

namespace astrosplat {
namespace fs = std::filesystem;

void FolderReader::begin(const fs::path& folder, const fs::path& otherwise,
                         const std::vector<std::string>& extensions) {
    question_.begin([folder, otherwise, extensions](const std::atomic<bool>& forgotten) {
        std::error_code ignored;
        FolderContents contents;
        contents.folder =
            fs::weakly_canonical(fs::is_directory(folder, ignored) ? folder : otherwise, ignored);
        contents.entries = list_folder(contents.folder, extensions, &forgotten);
        return contents;
    });
}

}  // namespace astrosplat
