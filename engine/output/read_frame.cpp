// Headers, and what --resume asks of a frame file that lies there already: its hashes, and whether it is
// whole.
#include "output/read_frame.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include "source/open_picture.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "output/metadata.h"

namespace astrosplat {
namespace {

std::string entry(const OIIO::ImageSpec& spec, const char* name) {
    std::string value = spec.get_string_attribute(name);
    if (!value.empty()) return value;
    return find_metadata_line(spec.get_string_attribute("ImageDescription"), name);
}

std::unique_ptr<OIIO::ImageInput> open_if_picture(const std::filesystem::path& file) {
    try {
        return open_picture(file);
    } catch (const InputError&) {
        return nullptr;
    }
}

}  // namespace

ImageInfo read_image_info(const std::filesystem::path& file) {
    const auto in = open_picture(file);
    const OIIO::ImageSpec& spec = in->spec();
    ImageInfo info{spec.width,       spec.height,       spec.x, spec.y, spec.full_width,
                   spec.full_height, in->format_name(), {},     {}};
    for (int c = 0; c < spec.nchannels; ++c) {
        info.channels.emplace_back(spec.channel_name(c), spec.channelformat(c).c_str());
    }
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        info.metadata.emplace_back(value.name().string(), value.get_string());
    }
    return info;
}

std::pair<std::string, std::string> read_frame_hashes(const std::filesystem::path& file) {
    const auto in = open_if_picture(file);
    if (!in) return {};
    return {entry(in->spec(), "astrosplat/frameHash"), entry(in->spec(), "astrosplat/pixelHash")};
}

bool frame_is_whole(const std::filesystem::path& file) {
    const auto in = open_if_picture(file);
    if (!in) return false;
    const QuietStderr quiet;
    const OIIO::ImageSpec& spec = in->spec();
    constexpr int rows = 256;
    std::vector<unsigned char> band(spec.scanline_bytes(true) * rows);
    for (int y = 0; y < spec.height; y += rows) {
        int end = std::min(y + rows, spec.height);
        const bool read = in->read_scanlines(0, 0, spec.y + y, spec.y + end, 0, 0, spec.nchannels,
                                             OIIO::TypeUnknown, band.data());
        // The reader of TIFF says that it has read strips that are cut short, but has a message about them.
        const std::string error = in->geterror();
        if (!read || !error.empty()) return false;
    }
    return true;
}

}  // namespace astrosplat
