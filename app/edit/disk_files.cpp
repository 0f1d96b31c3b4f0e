// Date and size first, then the bytes.
#include "edit/disk_files.h"

#include <utility>

#include "core/error.h"
#include "core/hash.h"

namespace astrosplat {
namespace fs = std::filesystem;

DiskFile::DiskFile(const fs::path& file, std::string_view content)
    : file_(file), checked_(stamp_of(file)), hash_(Sha256().add(content).hex()) {}

bool DiskFile::changed() {
    if (file_.empty()) return false;
    const FileStamp now = stamp_of(file_);
    if (now == FileStamp{}) return false;
    if (now == checked_) return changed_;
    try {
        changed_ = sha256_of_file(file_) != hash_;
    } catch (const InputError&) {
        return false;
    }
    checked_ = now;
    return changed_;
}

void DiskFile::accept() {
    if (file_.empty()) return;
    try {
        checked_ = stamp_of(file_);
        hash_ = sha256_of_file(file_);
        changed_ = false;
    } catch (const InputError&) {
        // gone: nothing to accept
    }
}

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
