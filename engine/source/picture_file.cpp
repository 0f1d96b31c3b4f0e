#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include "source/picture_file.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "source/open_picture.h"

namespace astrosplat {

PictureFile::Sink::Sink(const std::filesystem::path& path, Existing existing)
    : IOProxy(path.string(), Write), file(path, existing), guarded(file) {}

std::size_t PictureFile::Sink::write(const void* bytes, std::size_t size) {
    const std::size_t written = pwrite(bytes, size, m_pos);
    m_pos += static_cast<std::int64_t>(written);
    return written;
}

std::size_t PictureFile::Sink::pwrite(const void* bytes, std::size_t size, std::int64_t offset) {
    return guarded.write_at(offset, bytes, size) ? size : 0;
}

PictureFile::PictureFile(const std::filesystem::path& file, const std::string& format,
                         const OIIO::ImageSpec& spec, Existing existing)
    : sink_(file, existing), out_(OIIO::ImageOutput::create(format)) {
    check(out_ && out_->set_ioproxy(&sink_) && out_->open(file.string(), spec));
}

void PictureFile::write_all(OIIO::TypeDesc type, const void* pixels, OIIO::stride_t x_stride) {
    check(out_->write_image(type, pixels, x_stride));
}

void PictureFile::write_rows(std::int64_t begin, std::int64_t end, OIIO::TypeDesc type, const void* pixels) {
    check(out_->write_scanlines(static_cast<int>(begin), static_cast<int>(end), 0, type, pixels));
}

void PictureFile::commit() {
    check(out_->close());
    sink_.file.commit();
}

void PictureFile::check(bool done) {
    if (done && !sink_.guarded.failed()) return;
    std::string reason = out_ ? out_->geterror() : OIIO::geterror();
    if (out_) {
        const QuietStderr quiet;  // libpng says that pixels are missing
        out_->close();
        (void)out_->geterror();  // a message left behind would be printed
    }
    sink_.guarded.rethrow_failure();
    std::ranges::replace(reason, '\n', ' ');
    if (reason.empty()) reason = "unknown reason";
    throw OutputError(fmt::format("{}: cannot be written: {}", sink_.file.target().string(), reason));
}

}  // namespace astrosplat
