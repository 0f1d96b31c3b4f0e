// Headers, and what --resume asks of a frame file that lies there already: its hashes, and whether it is
// whole.
#include "output/read_frame.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include "source/open_picture.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/sha256.h"
#include "core/text.h"
#include "output/hashed_text.h"
#include "output/metadata.h"

namespace astrosplat {
namespace {

std::string entry(const OIIO::ImageSpec& spec, const char* name) {
    std::string value = spec.get_string_attribute(name);
    value.resize(value.find_last_not_of(' ') + 1);  // write_exr.cpp pads long ones
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

Eye eye_of(std::string_view name) {
    for (const Eye eye : {Eye::left, Eye::right})
        if (name == name_of(eye)) return eye;
    return Eye::centre;
}

void take_windows(FrameHeader& header, const OIIO::ImageSpec& spec) {
    header.whole_width = spec.full_width;
    header.whole_height = spec.full_height;
    if (spec.width != spec.full_width || spec.height != spec.full_height)
        header.region = {spec.x, spec.y, spec.width, spec.height};
}

/// Whole numbers between anything else.
std::vector<std::int64_t> numbers_in(const std::string& text) {
    std::vector<std::int64_t> numbers;
    for (std::size_t begin = 0; (begin = text.find_first_of("0123456789", begin)) != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_not_of("0123456789", begin), text.size());
        numbers.push_back(parse_int64(text.substr(begin, end - begin)).value_or(0));
        begin = end;
    }
    return numbers;
}

/// The text knows the region of files that have no windows, and the eye of those that have no views.
void take_hashed_text(FrameHeader& header, const std::string& text) {
    header.hashed_text = text;
    const auto size = numbers_in(hashed_value(text, "output.resolution").value_or(""));
    if (size.size() == 2) {
        header.whole_width = size[0];
        header.whole_height = size[1];
    }
    const auto region = numbers_in(hashed_value(text, "region").value_or(""));
    header.region = region.size() == 4 ? Region{region[0], region[1], region[2], region[3]} : Region{};
    std::string eye = hashed_value(text, "camera.eye").value_or("");
    std::erase(eye, '"');
    header.eye = eye_of(eye);
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

FrameHeader read_frame_header(const std::filesystem::path& file) {
    const auto in = open_if_picture(file);
    if (!in) return {};
    const OIIO::ImageSpec& spec = in->spec();
    FrameHeader header;
    header.frame = parse_int64(entry(spec, "astrosplat/frame"));
    header.frame_hash = entry(spec, "astrosplat/frameHash");
    header.pixel_hash = entry(spec, "astrosplat/pixelHash");
    header.compression = spec.get_string_attribute("compression");
    take_windows(header, spec);
    header.eye = eye_of(spec.get_string_attribute("view"));
    std::optional<std::string> text = unpack_hashed_text(entry(spec, "astrosplat/hashed"));
    if (text && Sha256().add(*text).hex() == header.frame_hash) take_hashed_text(header, *text);
    return header;
}

std::pair<std::string, std::string> read_frame_hashes(const std::filesystem::path& file) {
    const auto in = open_if_picture(file);
    if (!in) return {};
    return {entry(in->spec(), "astrosplat/frameHash"), entry(in->spec(), "astrosplat/pixelHash")};
}

bool frame_is_whole(const std::filesystem::path& file) {
    const auto in = open_if_picture(file);
    if (!in) return false;
    const OIIO::ImageSpec& spec = in->spec();
    constexpr int rows = 256;
    std::vector<unsigned char> band(spec.scanline_bytes(true) * rows);
    for (int y = 0; y < spec.height; y += rows)
        if (!read_rows(*in, y, std::min(y + rows, spec.height), OIIO::TypeUnknown, band.data())) return false;
    return true;
}

}  // namespace astrosplat
