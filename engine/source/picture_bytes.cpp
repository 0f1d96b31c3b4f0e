// XMP is searched for three properties, not parsed: packets are small and written by few programs. JPEG's
// segments are skipped by their length, so that the end marker of a thumbnail inside one is not taken for the
// picture's own; compressed data are searched for the next marker.
#include "source/picture_bytes.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

#include "core/file.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr std::size_t searched_bytes = std::size_t{4} << 20;

// The five entities XML has by itself.
std::string decode_entities(std::string_view text) {
    constexpr std::array<std::array<std::string_view, 2>, 5> entities = {
        {{"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}}};
    std::string result;
    while (!text.empty()) {
        std::string_view found = text.substr(0, 1), meaning = found;
        for (const auto& [entity, character] : entities) {
            if (text.substr(0, entity.size()) != entity) continue;
            found = entity;
            meaning = character;
        }
        result += meaning;
        text.remove_prefix(found.size());
    }
    return result;
}

// Tags and runs of blanks become one blank.
std::string plain(std::string_view markup) {
    std::string text;
    bool inside_tag = false;
    for (const char c : markup) {
        if (c == '<') inside_tag = true;
        const bool blank = inside_tag || c == ' ' || c == '\t' || c == '\r' || c == '\n';
        if (c == '>') inside_tag = false;
        if (!blank) text += c;
        if (blank && !text.empty() && text.back() != ' ') text += ' ';
    }
    return decode_entities(trim(text));
}

std::string_view up_to(std::string_view text, std::string_view end) {
    const std::size_t at = text.find(end);
    return at == std::string_view::npos ? std::string_view() : text.substr(0, at);
}

}  // namespace

std::string xmp_property(std::string_view packet, std::string_view name) {
    const std::string attribute = fmt::format("{}=", name);
    const std::size_t as_attribute = packet.find(attribute);
    if (as_attribute != std::string_view::npos && as_attribute + attribute.size() < packet.size()) {
        const std::string_view value = packet.substr(as_attribute + attribute.size());
        return plain(up_to(value.substr(1), value.substr(0, 1)));
    }
    const std::string open = fmt::format("<{}>", name), close = fmt::format("</{}>", name);
    const std::size_t as_element = packet.find(open);
    if (as_element == std::string_view::npos) return {};
    return plain(up_to(packet.substr(as_element + open.size()), close));
}

std::string xmp_credit(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string start(searched_bytes, '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(in.gcount());
    const std::size_t begin = start.find("<x:xmpmeta");
    if (begin == std::string::npos) return {};
    const std::string_view packet = up_to(std::string_view(start).substr(begin), "</x:xmpmeta>");
    for (const char* name : {"photoshop:Credit", "dc:creator", "dc:rights"}) {
        std::string value = xmp_property(packet, name);
        if (!value.empty()) return value;
    }
    return {};
}

namespace {

constexpr unsigned char start_of_image = 0xD8, end_of_image = 0xD9, first_restart = 0xD0;

unsigned char byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

// FF 00 is a data byte, FF D0 to D7 are restarts within the data, FF FF is padding.
bool begins_segment(unsigned char code) {
    return code != 0x00 && code != 0xFF && !(code >= first_restart && code < start_of_image);
}

// Where the next marker's code stands, npos where none follows.
std::size_t next_marker(std::string_view bytes, std::size_t at) {
    while ((at = bytes.find('\xFF', at)) != std::string_view::npos) {
        ++at;
        if (at < bytes.size() && begins_segment(byte_at(bytes, at))) return at;
    }
    return std::string_view::npos;
}

}  // namespace

bool jpeg_is_whole(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    const std::string_view bytes = text;
    if (bytes.substr(0, 3) != "\xFF\xD8\xFF") return true;
    std::size_t at = 2;
    while ((at = next_marker(bytes, at)) != std::string_view::npos) {
        if (byte_at(bytes, at) == end_of_image) return true;
        if (at + 2 >= bytes.size()) return false;
        at += 1 + (std::size_t{byte_at(bytes, at + 1)} << 8U) + byte_at(bytes, at + 2);
    }
    return false;
}

}  // namespace astrosplat
