// The holder removes the file, so a lock counts only when its file is still the one under that name.
#include "core/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>

namespace astrosplat {
namespace {

bool is_still_named(int descriptor, const std::filesystem::path& file) {
    struct stat open_file {};
    struct stat named {};
    return ::fstat(descriptor, &open_file) == 0 && ::stat(file.c_str(), &named) == 0 &&
           open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

}  // namespace

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
