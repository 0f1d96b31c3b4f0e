// One way to replace a text file: a temporary name beside it, fsync, rename.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"
#include "scene/save.h"

namespace astrosplat {
namespace fs = std::filesystem;

static bool write_all(int file, const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t size = ::write(file, text.data() + done, text.size() - done);
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) return false;
        done += static_cast<std::size_t>(size);
    }
    return ::fsync(file) == 0;
}

void write_text_file(const fs::path& file, const std::string& text) {
    const std::string temporary = fmt::format("{}.{}.tmp", file.string(), ::getpid());
    const auto fail = [&] {
        const std::string reason = std::strerror(errno);
        ::unlink(temporary.c_str());
        throw OutputError(fmt::format("{}: cannot be written: {}", file.string(), reason));
    };
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) fail();
    const bool written = write_all(descriptor, text);
    if (::close(descriptor) != 0 || !written) fail();
    if (::rename(temporary.c_str(), file.c_str()) != 0) fail();
}

}  // namespace astrosplat
