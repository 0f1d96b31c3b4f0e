// The plug-in is chosen by our table of formats and not by asking each in turn, because some of OpenImageIO's
// accept files that are no pictures.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include "source/open_picture.h"

#include <unistd.h>

#include <cstdio>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/text.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

thread_local int quiet_depth = 0;

// The stream's write function: everything "written" where a QuietStderr lives in this thread.
ssize_t write_unless_quiet(void*, const char* text, std::size_t size) {
    return quiet_depth > 0 ? static_cast<ssize_t>(size) : ::write(STDERR_FILENO, text, size);
}

// Replaces the stream stderr, which glibc allows, before main() and thus before other threads use it. An
// unbuffered stream writes each message at once, as the original does.
[[maybe_unused]] const bool stderr_is_filtered = [] {
    std::FILE* const filtered = ::fopencookie(nullptr, "w", {nullptr, write_unless_quiet, nullptr, nullptr});
    if (!filtered) return false;
    std::setvbuf(filtered, nullptr, _IONBF, 0);
    stderr = filtered;
    return true;
}();

}  // namespace

QuietStderr::QuietStderr() { ++quiet_depth; }
QuietStderr::~QuietStderr() { --quiet_depth; }

bool read_rows(OIIO::ImageInput& picture, int begin, int end, OIIO::TypeDesc format, void* values) {
    const QuietStderr quiet;
    const OIIO::ImageSpec& spec = picture.spec();
    const bool read =
        picture.read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, 0, spec.nchannels, format, values);
    // The reader of TIFF says that it has read strips that are cut short, but has a message about them.
    return picture.geterror().empty() && read;
}

void fail_picture(const fs::path& file, const std::string& reason) {
    throw InputError(fmt::format("{}: cannot be read as a picture: {}", file.string(),
                                 trim(reason.substr(0, reason.find('\n')))));
}

std::unique_ptr<OIIO::ImageInput> open_picture(const fs::path& file) {
    require_readable(file);
    const FileFormat* const format = format_of_file(file);
    if (kind_of(format) != FileKind::picture)
        fail_picture(file, fmt::format("it is not {}", names_of(FileKind::picture)));
    const QuietStderr quiet;
    std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(std::string(format->id));
    if (!in) fail_picture(file, OIIO::geterror());
    OIIO::ImageSpec spec, wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);
    if (in->open(file.string(), spec, wish)) return in;
    const std::string reason = in->geterror();
    if (reason.find("Subsampled channels") != std::string::npos)
        fail_picture(
            file, "its colour is stored at a lower resolution (subsampled luminance/chroma); save it as RGB");
    fail_picture(file, reason.empty() ? fmt::format("it is no {} file", format->name) : reason);
}

}  // namespace astrosplat
