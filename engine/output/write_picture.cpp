#include "output/write_picture.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <string>

#include "core/atomic_file.h"
#include "core/error.h"

namespace astrosplat {

void write_picture(const std::filesystem::path& file, std::int64_t width, std::int64_t height,
                   std::span<const unsigned char> rgba) {
    assert(static_cast<std::int64_t>(rgba.size()) == width * height * 4);
    AtomicFile target(file);
    const auto out = OIIO::ImageOutput::create(target.temporary().string());
    OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 3, OIIO::TypeDesc::UINT8);
    spec.attribute("DateTime", "");  // OpenImageIO would write the time
    const bool written = out && out->open(target.temporary().string(), spec) &&
                         out->write_image(OIIO::TypeDesc::UINT8, rgba.data(), 4) && out->close();
    if (!written) {
        std::string reason = out ? out->geterror() : OIIO::geterror();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        throw OutputError(fmt::format("{}: cannot be written: {}", file.string(), reason));
    }
    target.commit();
}

}  // namespace astrosplat
