#include "source/write_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "core/error.h"
#include "source/open_picture.h"

// fmt first: OpenImageIO brings a copy of it with other settings.

namespace astrosplat {
namespace {

// One picture file on its way to the disk: OpenImageIO encodes, an AtomicFile takes the bytes, so that
// every write that fails is an error whatever the format's plug-in makes of it.
class PictureFile {
  public:
    /// Writes the header of a picture in the `format` that OpenImageIO knows under this name or ending
    /// ("tiff", "x.png"). Throws OutputError, as all functions here.
    PictureFile(const fs::path& file, const std::string& format, const OIIO::ImageSpec& spec,
                Existing existing = Existing::replace)
        : sink_(file, existing), out_(OIIO::ImageOutput::create(format)) {
        check(out_ && out_->set_ioproxy(&sink_) && out_->open(file.string(), spec));
    }

    /// All rows, from memory where a pixel takes x_stride bytes.
    void write_all(OIIO::TypeDesc type, const void* pixels, OIIO::stride_t x_stride = OIIO::AutoStride) {
        check(out_->write_image(type, pixels, x_stride));
    }

    /// Finishes the file, which then appears under its name.
    void commit() {
        check(out_->close());
        sink_.file.commit();
    }

  private:
    /// Takes the plug-in's bytes, and remembers what went wrong: plug-ins need not report it.
    struct Sink : OIIO::Filesystem::IOProxy {
        Sink(const fs::path& path, Existing existing)
            : IOProxy(path.string(), Write), file(path, existing), guarded(file) {}
        const char* proxytype() const override { return "astrosplat"; }
        std::size_t write(const void* bytes, std::size_t size) override {
            const std::size_t written = pwrite(bytes, size, m_pos);
            m_pos += std::int64_t(written);
            return written;
        }
        std::size_t pwrite(const void* bytes, std::size_t size, std::int64_t offset) override {
            return guarded.write_at(offset, bytes, size) ? size : 0;
        }
        std::size_t size() const override { return std::size_t(file.size()); }

        AtomicFile file;
        GuardedFile guarded;
    };

    /// Throws the sink's failure, else the plug-in's where it is not `done`.
    void check(bool done) {
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

    Sink sink_;  // outlives out_, which may write at its end
    std::unique_ptr<OIIO::ImageOutput> out_;
};

}  // namespace

void write_image(const fs::path& file, std::int64_t width, std::int64_t height,
                 std::span<const unsigned char> rgba, const std::string& credit) {
    assert(std::int64_t(rgba.size()) == width * height * 4);
    OIIO::ImageSpec spec(int(width), int(height), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("DateTime", "");  // OpenImageIO would write the time
    if (!credit.empty()) spec.attribute("Copyright", credit);
    PictureFile picture(file, file.string(), spec);
    picture.write_all(OIIO::TypeDesc::UINT8, rgba.data(), 4);
    picture.commit();
}

void write_linear_image(const fs::path& file, const Image& image, const std::string& credit,
                        Existing existing, const std::string& xmp) {
    assert(image.channels == 3 || image.channels == 4);
    OIIO::ImageSpec spec(int(image.width), int(image.height), image.channels, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");
    if (!credit.empty()) spec.attribute("Copyright", credit);
    if (!xmp.empty()) spec.attribute("xmp", xmp);  // as it is: headers of EXR are not compressed
    PictureFile picture(file, "exr", spec, existing);
    picture.write_all(OIIO::TypeDesc::FLOAT, image.pixels.data());
    picture.commit();
}

std::string png_bytes(std::int64_t width, std::int64_t height, std::span<const unsigned char> rgb) {
    assert(std::int64_t(rgb.size()) == width * height * 3);
    OIIO::ImageSpec spec(int(width), int(height), 3, OIIO::TypeDesc::UINT8);
    OIIO::Filesystem::IOVecOutput memory;
    const auto png = OIIO::ImageOutput::create("png");
    const bool written = png && png->set_ioproxy(&memory) && png->open("memory.png", spec) &&
                         png->write_image(OIIO::TypeDesc::UINT8, rgb.data()) && png->close();
    if (!written)
        throw OutputError("a picture cannot be encoded: " + (png ? png->geterror() : OIIO::geterror()));
    return {memory.buffer().begin(), memory.buffer().end()};
}

}  // namespace astrosplat
