// Temporary name, lock, fsync, rename. The lock is the kernel's and ends with the process, so that a
// temporary file without one is a leftover. The holder of a FileLock removes the file, so a lock counts only
// when its file is still the one under that name.
#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <set>

#include "core/file.h"

namespace astrosplat {
namespace {

[[noreturn]] void fail_writing(const fs::path& target, const char* reason) {
    throw OutputError(fmt::format("{}: cannot be written: {}", target.string(), reason));
}

[[noreturn]] void fail_writing(const fs::path& target, int error) {
    fail_writing(target, std::strerror(error));
}

[[noreturn]] void fail_existing(const fs::path& target) {
    throw AlreadyExists(target.string() + ": was written by another program meanwhile, and is left as it is");
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

// ".STEM.HEX-HEX-HEX.part" and an ending.
bool is_temporary_name(const std::string& name) {
    const std::size_t part = name.rfind(".part");
    if (name.front() != '.' || part == std::string::npos || part == 0) return false;
    const std::size_t dot = name.rfind('.', part - 1);
    if (dot == std::string::npos || dot == 0) return false;
    int dashes = 0;
    for (std::size_t i = dot + 1; i < part; ++i) {
        if (name[i] == '-')
            ++dashes;
        else if (!std::isxdigit(static_cast<unsigned char>(name[i])))
            return false;
    }
    const char after = name[part + 5];  // the terminating 0 when nothing follows
    return dashes == 2 && (after == '.' || after == '\0');
}

void remove_if_nobodys(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) unlink(file.c_str());
    close(descriptor);
}

// Once a folder and process: what others leave later waits for the next program.
void remove_leftovers(const fs::path& folder) {
    static std::mutex mutex;
    static std::set<fs::path> seen;
    {
        const std::lock_guard lock(mutex);
        std::error_code ignored;
        if (!seen.insert(fs::absolute(folder, ignored)).second) return;
    }
    for (const fs::path& entry : entries_of(folder.empty() ? "." : folder))
        if (is_temporary_name(entry.filename().string())) remove_if_nobodys(entry);
}

// Where writing goes: the links' end, whether or not a file is there.
fs::path behind_links(const fs::path& target) {
    fs::path file = target;
    std::error_code error;
    for (int link = 0; link < 40; ++link) {
        if (!fs::is_symlink(file, error)) return file;
        file = file.parent_path() / fs::read_symlink(file, error);
        if (error) fail_writing(target, error.value());
    }
    fail_writing(target, ELOOP);
}

void sync_folder(const fs::path& folder) {
    const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);  // some file systems refuse; the rename itself stands
    close(descriptor);
}

// rename(2) that fails with EEXIST where `to` exists. File systems without the flag (NFS) know hard links.
int rename_to_free_name(const fs::path& from, const fs::path& to) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return -1;
    return link(from.c_str(), to.c_str()) == 0 ? unlink(from.c_str()) : -1;
}

bool is_still_named(int descriptor, const fs::path& file) {
    struct stat open_file {};
    struct stat named {};
    return ::fstat(descriptor, &open_file) == 0 && ::stat(file.c_str(), &named) == 0 &&
           open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target, Existing existing)
    : target_(target), resolved_(behind_links(target)), existing_(existing) {
    refuse_other_than_file(target);
    remove_leftovers(resolved_.parent_path());
    for (int attempt = 0; attempt < 100; ++attempt) {
        if (create_temporary()) return;
        if (errno != EEXIST) break;
    }
    fail_writing(target_, errno);
}

// False with errno when there is none; EEXIST means another try.
bool AtomicFile::create_temporary() {
    fs::path name = temporary_name(resolved_);
    const int descriptor = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return false;
    // Where the file system has no locks, no process gets one, and none removes the file.
    flock(descriptor, LOCK_EX | LOCK_NB);
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && status.st_nlink > 0) {
        descriptor_ = descriptor;
        temporary_ = std::move(name);  // which takes no memory: the file is ours whatever comes
        return true;
    }
    close(descriptor);  // another process took it for a leftover before it was locked
    errno = EEXIST;
    return false;
}

AtomicFile::~AtomicFile() {
    if (!temporary_.empty()) unlink(temporary_.c_str());
    if (descriptor_ >= 0) close(descriptor_);
}

void AtomicFile::write_at(std::int64_t offset, const void* bytes, std::size_t size) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = pwrite(descriptor_, next, size, offset);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail_writing(target_, errno);
        next += written;
        offset += written;
        size -= std::size_t(written);
    }
    size_ = std::max(size_, offset);
    // The disk starts while we go on, so that little is left for commit() to wait for. Only a hint.
    constexpr off_t portion = off_t{8} << 20;
    if (size_ - handed_over_ < portion) return;
    sync_file_range(descriptor_, handed_over_, size_ - handed_over_, SYNC_FILE_RANGE_WRITE);
    handed_over_ = size_;
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) fail_writing(target_, errno);
    const bool keep = existing_ == Existing::keep;
    const int renamed = keep ? rename_to_free_name(temporary_, resolved_)
                             : std::rename(temporary_.c_str(), resolved_.c_str());
    if (renamed != 0 && keep && errno == EEXIST) fail_existing(target_);
    if (renamed != 0) fail_writing(target_, errno);
    temporary_.clear();
    sync_folder(resolved_.parent_path());
}

void write_file_atomically(const fs::path& target, std::string_view text, Existing existing) {
    AtomicFile file(target, existing);
    file.write(text);
    file.commit();
}

void refuse_existing(const fs::path& target) {
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(target, ignored))) fail_existing(target);
}

void refuse_other_than_file(const fs::path& target) {
    std::error_code ignored;
    const fs::file_status status = fs::status(target, ignored);
    if (fs::is_directory(status)) fail_writing(target, "it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) fail_writing(target, "it is no regular file");
}

FileLock::~FileLock() {
    if (descriptor_ < 0) return;
    ::unlink(file_.c_str());
    ::close(descriptor_);
}

FileLock::State FileLock::try_lock(Missing missing) {
    assert(descriptor_ < 0);
    for (;;) {
        const int flags = O_RDWR | O_CLOEXEC | (missing == Missing::create ? O_CREAT : 0);
        const int descriptor = ::open(file_.c_str(), flags, 0666);
        if (descriptor < 0) {
            const bool absent = errno == ENOENT && missing == Missing::leave;
            return absent ? State::absent : State::refused;
        }
        const int error = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        if (error == 0 && is_still_named(descriptor, file_)) {
            descriptor_ = descriptor;
            return State::held;
        }
        ::close(descriptor);
        if (error != 0 && error != EINTR) return error == EWOULDBLOCK ? State::busy : State::refused;
    }
}

}  // namespace astrosplat
