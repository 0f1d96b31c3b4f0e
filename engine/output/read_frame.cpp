// Headers, and what --resume asks of a frame file that lies there already: its hashes, and whether it is
// whole.
#include "output/read_frame.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include "source/open_picture.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/file_format.h"
#include "core/hash.h"
#include "core/text.h"
#include "output/exr_frame.h"
#include "output/metadata.h"
#include "output/png_frame.h"
#include "output/tiff_frame.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

Eye eye_of(std::string_view name) {
    for (const Eye eye : {Eye::left, Eye::right})
        if (name == name_of(eye)) return eye;
    return Eye::centre;
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

/// Readers of a format's frames without OpenImageIO, which takes a fifth of a second to load.
struct FrameFileFormat {
    std::string_view id;
    std::optional<StoredHeader> (*read_header)(const fs::path&);
    bool (*is_whole)(const fs::path&);
};
constexpr FrameFileFormat frame_file_formats[] = {{"openexr", read_exr_header, exr_is_whole},
                                                  {"tiff", read_tiff_header, tiff_is_whole},
                                                  {"png", read_png_header, png_is_whole}};

/// nullptr: no file that a frame can be in.
const FrameFileFormat* frame_file_format(const fs::path& file) {
    std::error_code ignored;
    const FileFormat* const format = fs::is_regular_file(file, ignored) ? format_of_file(file) : nullptr;
    const auto found = std::ranges::find_if(
        frame_file_formats, [&](const FrameFileFormat& f) { return format && format->id == f.id; });
    return found == std::end(frame_file_formats) ? nullptr : found;
}

/// Any picture, also in forms that no frame is written in.
bool picture_is_whole(const fs::path& file) try {
    const auto in = open_picture(file);
    const OIIO::ImageSpec& spec = in->spec();
    constexpr int rows = 256;
    std::vector<unsigned char> band(spec.scanline_bytes(true) * rows);
    for (int y = 0; y < spec.height; y += rows)
        if (!read_rows(*in, y, std::min(y + rows, spec.height), OIIO::TypeUnknown, band.data())) return false;
    return true;
} catch (const InputError&) {
    return false;
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
    const FrameFileFormat* const format = frame_file_format(file);
    const std::optional<StoredHeader> stored = format ? format->read_header(file) : std::nullopt;
    if (!stored) return {};
    const auto text_of = [&](const char* name) {
        const auto found = stored->texts.find(name);
        return found == stored->texts.end() ? std::string() : found->second;
    };
    FrameHeader header;
    header.frame = parse_int64(text_of("astrosplat/frame"));
    header.frame_hash = text_of("astrosplat/frameHash");
    header.pixel_hash = text_of("astrosplat/pixelHash");
    header.dwaa = stored->dwaa;
    header.whole_width = stored->whole_width;
    header.whole_height = stored->whole_height;
    header.region = stored->region;
    header.eye = eye_of(text_of("view"));
    std::optional<std::string> text = unpack_hashed_text(text_of("astrosplat/hashed"));
    if (text && Sha256().add(*text).hex() == header.frame_hash) take_hashed_text(header, *text);
    return header;
}

bool frame_is_whole(const std::filesystem::path& file) {
    const FrameFileFormat* const format = frame_file_format(file);
    return (format && format->is_whole(file)) || picture_is_whole(file);
}

}  // namespace astrosplat
