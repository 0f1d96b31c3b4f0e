// Temporary name, fsync, rename.
#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>

#include "core/error.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, int error) {
    throw OutputError(fmt::format("{}: cannot be written: {}", target.string(), std::strerror(error)));
}

// Process, time and a counter; creation is exclusive, so a clash (two machines on one share) only means
// another try.
std::string unique_ending() {
    static std::atomic<unsigned> counter{0};
    const auto ticks = std::chrono::steady_clock::now().time_since_epoch().count();
    return fmt::format("{:x}-{:x}-{:x}", getpid(), static_cast<unsigned long long>(ticks), counter++);
}

// Hidden, and short where the file's own name leaves no room (255 bytes).
fs::path temporary_name(const fs::path& target) {
    const std::string stem = target.stem().string().substr(0, 150);
    const std::string extension = target.extension().string().substr(0, 50);
    return target.parent_path() / fmt::format(".{}.{}.part{}", stem, unique_ending(), extension);
}

void sync_folder(const fs::path& folder) {
    const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);  // some file systems refuse; the rename itself stands
    close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target), resolved_(target) {
    std::error_code ignored;
    if (fs::is_symlink(target, ignored)) resolved_ = fs::weakly_canonical(target, ignored);
    if (resolved_.empty()) resolved_ = target;
    const fs::file_status status = fs::status(resolved_, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw OutputError(fmt::format("{}: cannot be written: it is no regular file", target.string()));
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
        const fs::path name = temporary_name(resolved_);
        descriptor_ = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) temporary_ = name;
        if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) fail(target_, errno);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::write(const void* bytes, std::size_t size) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, next, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(target_, errno);
        next += written;
        size -= static_cast<std::size_t>(written);
        written_ += written;
    }
    // The disk starts while we go on, so that little is left for commit() to wait for. Only a hint.
    constexpr off_t portion = off_t{8} << 20;
    if (written_ - handed_over_ < portion) return;
    sync_file_range(descriptor_, handed_over_, written_ - handed_over_, SYNC_FILE_RANGE_WRITE);
    handed_over_ = written_;
}

void AtomicFile::commit() {
    // A library may have replaced the file under its name: open it again, so that what is there now is
    // flushed.
    close(descriptor_);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0 || fsync(descriptor_) != 0) fail(target_, errno);
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail(target_, errno);
    if (std::rename(temporary_.c_str(), resolved_.c_str()) != 0) fail(target_, errno);
    temporary_.clear();
    sync_folder(resolved_.parent_path());
}

void write_file_atomically(const fs::path& target, std::string_view text) {
    AtomicFile file(target);
    file.write(text);
    file.commit();
}

}  // namespace astrosplat
