// POSIX mmap with one-line errors; an empty file maps to an empty view.
#include "splat_files/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"

namespace astrosplat {

namespace {

/// Closes on every way out.
struct Descriptor {
    int fd;
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
};

[[noreturn]] void unreadable(const std::filesystem::path& file) {
    bad_input(file.string(), "", "a readable file", std::generic_category().message(errno));
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file) {
    const Descriptor descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC)};
    struct stat status {};
    if (descriptor.fd < 0 || ::fstat(descriptor.fd, &status) != 0) unreadable(file);
    if (!S_ISREG(status.st_mode)) bad_input(file.string(), "", "a regular file", "something else");
    size_ = static_cast<std::size_t>(status.st_size);
    if (size_ == 0) return;
    memory_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor.fd, 0);
    if (memory_ == MAP_FAILED) unreadable(file);
    ::madvise(memory_, size_, MADV_SEQUENTIAL);
}

MappedFile::~MappedFile() {
    if (size_ != 0) ::munmap(memory_, size_);
}

}  // namespace astrosplat
