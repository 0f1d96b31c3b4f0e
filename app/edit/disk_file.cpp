// Date and size first, then the bytes.
#include "edit/disk_file.h"

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

}  // namespace astrosplat
