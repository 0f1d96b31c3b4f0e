#include "edit/watched_files.h"

#include <utility>

namespace astrosplat {
namespace fs = std::filesystem;

void WatchedFiles::watch(const std::vector<fs::path>& files) {
    std::map<fs::path, Entry> watched;
    for (const fs::path& file : files) {
        const auto known = files_.find(file);
        if (known != files_.end()) {
            watched.insert(*known);
        } else if (!watched.count(file)) {
            const FileStamp now = stamp_of(file);
            watched[file] = {now, now};
        }
    }
    files_ = std::move(watched);
}

std::vector<fs::path> WatchedFiles::changed() {
    std::vector<fs::path> found;
    for (auto& [file, entry] : files_) {
        const FileStamp now = stamp_of(file), before = std::exchange(entry.seen, now);
        if (now == FileStamp{} || now == entry.known || now != before) continue;
        entry.known = now;
        found.push_back(file);
    }
    return found;
}

}  // namespace astrosplat
