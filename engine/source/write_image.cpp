#include "source/write_image.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include "source/picture_file.h"

#include <cassert>

namespace astrosplat {

void write_image(const std::filesystem::path& file, std::int64_t width, std::int64_t height,
                 std::span<const unsigned char> rgba) {
    assert(static_cast<std::int64_t>(rgba.size()) == width * height * 4);
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("DateTime", "");  // OpenImageIO would write the time
    PictureFile picture(file, file.string(), spec);
    picture.write_all(OIIO::TypeDesc::UINT8, rgba.data(), 4);
    picture.commit();
}

void write_linear_image(const std::filesystem::path& file, const Image& image, const std::string& credit,
                        Existing existing) {
    assert(image.channels == 3 || image.channels == 4);
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), image.channels,
                         OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");
    if (!credit.empty()) spec.attribute("Copyright", credit);
    PictureFile picture(file, "exr", spec, existing);
    picture.write_all(OIIO::TypeDesc::FLOAT, image.pixels.data());
    picture.commit();
}

std::string png_bytes(std::int64_t width, std::int64_t height, std::span<const unsigned char> rgb) {
    assert(static_cast<std::int64_t>(rgb.size()) == width * height * 3);
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, OIIO::TypeDesc::UINT8);
    OIIO::Filesystem::IOVecOutput memory;
    const auto png = OIIO::ImageOutput::create("png");
    const bool written = png && png->set_ioproxy(&memory) && png->open("memory.png", spec) &&
                         png->write_image(OIIO::TypeDesc::UINT8, rgb.data()) && png->close();
    if (!written)
        throw OutputError("a picture cannot be encoded: " + (png ? png->geterror() : OIIO::geterror()));
    return {memory.buffer().begin(), memory.buffer().end()};
}

}  // namespace astrosplat
