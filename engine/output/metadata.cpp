// Frame metadata as text; hashed text by deflate and base64, and a merge of two lists of lines. Then headers,
// and what --resume asks of a frame file that lies there already: its hashes, and whether it is whole.
#include "output/metadata.h"

#include <fmt/format.h>
#include <zlib.h>

#include <new>
#include <numeric>

#include "core/error.h"
#include "core/file_format.h"
#include "core/hash.h"
#include "core/text.h"
#include "output/frame_formats.h"
#include "source/open_picture.h"
#include "source/picture.h"

// fmt first: OpenImageIO brings a copy of it with other settings.

namespace astrosplat {
namespace {

struct KeyLine {
    std::string_view key, value;
};

/// Of lines "KEY<between>VALUE"; others are left out.
std::vector<KeyLine> key_lines(std::string_view text, std::string_view between) {
    std::vector<KeyLine> lines;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        if (const std::size_t at = line.find(between); at != line.npos)
            lines.push_back({line.substr(0, at), line.substr(at + between.size())});
    }
    return lines;
}

constexpr std::size_t longest_text = std::size_t{64} << 20;  // bytes; of a damaged file's promises

std::vector<KeyLine> hashed_lines(std::string_view text) {
    std::vector<KeyLine> lines = key_lines(text, " =");
    for (KeyLine& line : lines) line.value = trim(line.value);
    return lines;
}

/// Keys in their order, each once, with the values of all of its lines.
std::vector<std::pair<std::string, std::string>> values_by_key(const std::string& text) {
    std::vector<std::pair<std::string, std::string>> values;
    std::map<std::string_view, std::size_t> places;
    for (const auto& [key, value] : hashed_lines(text)) {
        const auto [known, added] = places.try_emplace(key, values.size());
        if (added)
            values.emplace_back(key, value);
        else
            values[known->second].second.append("; ").append(value);
    }
    return values;
}

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

/// nullptr: no file that a frame can be in.
const FrameFileFormat* frame_file_format(const fs::path& file) {
    std::error_code ignored;
    const FileFormat* const format = fs::is_regular_file(file, ignored) ? format_of_file(file) : nullptr;
    const auto found = std::ranges::find_if(
        frame_file_formats, [&](const FrameFileFormat& f) { return format && format->id == f.id; });
    return found == std::end(frame_file_formats) ? nullptr : found;
}

/// Nothing where it is no frame.
std::optional<StoredHeader> stored_header(const fs::path& file) {
    const FrameFileFormat* const format = frame_file_format(file);
    return format ? format->read_header(file) : std::nullopt;
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

MetadataEntries metadata_entries(const FrameMetadata& metadata) {
    MetadataEntries entries = {
        {"astrosplat/version", ASTROSPLAT_VERSION},
        {"astrosplat/frameHash", metadata.frame_hash},
        {"astrosplat/pixelHash", metadata.pixel_hash},
        {"astrosplat/seed", std::to_string(metadata.seed)},
        {"astrosplat/frame", std::to_string(metadata.frame)},
        {"astrosplat/fps", shortest(metadata.fps)},
    };
    auto add = [&](const char* name, const std::string& value) {
        // On one line, so that it cannot be mistaken for the next entry.
        if (!value.empty()) entries.emplace_back(name, utf8_line(value));
    };
    if (!metadata.hashed_text.empty())
        entries.emplace_back("astrosplat/hashed", pack_hashed_text(metadata.hashed_text));
    add("astrosplat/title", metadata.provenance.title);
    add("astrosplat/credit", metadata.provenance.credit);
    add("astrosplat/type", metadata.provenance.type);
    add("astrosplat/origin", metadata.origin);
    return entries;
}

std::string frame_xmp(const FrameMetadata& metadata) {
    ObjectMetadata said = metadata.sources;
    said.id = metadata.frame_hash;
    said.title = metadata.provenance.title;
    said.credit = metadata.provenance.credit;
    said.type = metadata.provenance.type;
    // Seen from elsewhere, in perspective: no place, scale or north of the sky holds over such a frame.
    said.degrees_per_px.reset();
    said.north_angle.reset();
    said.sky_position.reset();
    said.reference_px = {};
    return xmp_packet(said);
}

std::string movie_metadata(const fs::path& frame, const std::string& movie_hash) {
    std::map<std::string, std::string> texts = stored_header(frame).value_or(StoredHeader{}).texts;
    std::erase_if(texts, [](const auto& text) { return !text.first.starts_with("astrosplat/"); });
    std::string lines = ";FFMETADATA1\n";
    const auto add = [&](const char* key, const std::string& value) {
        if (value.empty()) return;
        lines += fmt::format("{}=", key);
        for (const char c : value)
            lines += (std::string_view("=;#\\\n").find(c) != std::string_view::npos ? "\\" : "") +
                     std::string(1, c);
        lines += "\n";
    };
    const std::string credit = texts["astrosplat/credit"];
    add("title", texts["astrosplat/title"]);
    add("artist", credit);
    add("copyright", credit);
    std::string comment;
    for (const auto& [group, name, values] : read_avm_tags(frame))
        if (name != "title" && name != "credit")
            comment += fmt::format("{} {}: {}\n", group, name, fmt::join(values, ", "));
    texts.erase("astrosplat/title");
    texts.erase("astrosplat/credit");
    texts["astrosplat/movieHash"] = movie_hash;
    add("comment", comment + metadata_lines({texts.begin(), texts.end()}));
    return lines;
}

std::string metadata_lines(const MetadataEntries& entries) {
    std::string lines;
    for (const auto& [name, value] : entries) lines += fmt::format("{}={}\n", name, value);
    return lines;
}

std::map<std::string, std::string> parse_metadata_lines(std::string_view lines) {
    std::map<std::string, std::string> entries;
    for (const auto& [name, value] : key_lines(lines, "=")) entries.emplace(name, value);
    return entries;
}

Rational rational_fps(double fps) {
    double ntsc = std::round(fps * 1.001);
    if (std::fabs(ntsc * 1000.0 / 1001.0 - fps) < 0.0005 && std::fabs(ntsc - fps) > 0.0005)
        return {int(ntsc) * 1000, 1001};
    int thousandths = int(std::round(std::fmin(fps, 1e6) * 1000.0));
    int common = std::gcd(thousandths, 1000);
    return {thousandths / common, 1000 / common};
}

std::string pack_hashed_text(const std::string& text) {
    uLongf size = compressBound(static_cast<uLong>(text.size()));
    std::string bytes(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                  static_cast<uLong>(text.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw std::bad_alloc();  // the only way it can fail, with room for all of it
    bytes.resize(size);
    return base64(bytes);
}

std::optional<std::string> unpack_hashed_text(const std::string& packed) {
    const std::optional<std::string> bytes = bytes_of_base64(packed);
    if (!bytes || bytes->empty()) return std::nullopt;
    z_stream stream = {};
    if (inflateInit(&stream) != Z_OK) return std::nullopt;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes->data()));
    stream.avail_in = static_cast<uInt>(bytes->size());
    std::string text;
    int state = Z_OK;
    while (state == Z_OK && text.size() < longest_text) {
        char portion[16384];
        stream.next_out = reinterpret_cast<Bytef*>(portion);
        stream.avail_out = sizeof portion;
        state = inflate(&stream, Z_NO_FLUSH);
        text.append(portion, sizeof portion - stream.avail_out);
    }
    inflateEnd(&stream);
    return state == Z_STREAM_END ? std::optional(text) : std::nullopt;
}

std::optional<std::string> hashed_value(const std::string& text, const std::string& key) {
    for (const KeyLine& line : hashed_lines(text))
        if (line.key == key) return std::string(line.value);
    return std::nullopt;
}

std::vector<KeyDifference> differing_keys(const std::string& first, const std::string& second) {
    const auto a = values_by_key(first), b = values_by_key(second);
    std::map<std::string, std::string> of_a(a.begin(), a.end()), of_b(b.begin(), b.end());
    std::vector<KeyDifference> differences;
    for (const auto& [key, value] : a)
        if (!of_b.count(key) || of_b[key] != value) differences.push_back({key, value, of_b[key]});
    for (const auto& [key, value] : b)
        if (!of_a.count(key)) differences.push_back({key, "", value});
    return differences;
}

ImageInfo read_image_info(const fs::path& file) {
    const auto in = open_picture(file);
    const PictureParts parts = describe_parts(file);
    const OIIO::ImageSpec spec = in->spec(parts.taken);
    ImageInfo info{spec.width,       spec.height,       spec.x, spec.y, spec.full_width,
                   spec.full_height, in->format_name(), {},     {},     {}};
    for (int c = 0; c < spec.nchannels; ++c) {
        info.channels.emplace_back(spec.channel_name(c), spec.channelformat(c).c_str());
    }
    if (parts.parts.size() > 1) info.parts = parts.parts;
    for (const OIIO::ParamValue& value : spec.extra_attribs) {
        info.metadata.emplace_back(value.name().string(), value.get_string());
    }
    return info;
}

FrameHeader read_frame_header(const fs::path& file) {
    const std::optional<StoredHeader> stored = stored_header(file);
    if (!stored) return {};
    const auto text_of = [&](const char* name) {
        const auto found = stored->texts.find(name);
        return found == stored->texts.end() ? std::string() : found->second;
    };
    FrameHeader header;
    static_cast<StoredHeader&>(header) = *stored;
    header.frame = parse_int64(text_of("astrosplat/frame"));
    header.frame_hash = text_of("astrosplat/frameHash");
    header.pixel_hash = text_of("astrosplat/pixelHash");
    header.eye = eye_of(text_of("view"));
    std::optional<std::string> text = unpack_hashed_text(text_of("astrosplat/hashed"));
    if (text && Sha256().add(*text).hex() == header.frame_hash) take_hashed_text(header, *text);
    return header;
}

bool frame_is_whole(const fs::path& file) {
    const FrameFileFormat* const format = frame_file_format(file);
    return (format && format->is_whole(file)) || picture_is_whole(file);
}

}  // namespace astrosplat
