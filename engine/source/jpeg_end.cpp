// Segments are skipped by their length, so that the end marker of a thumbnail inside one is not taken for the
// picture's own; compressed data are searched for the next marker.
#include "source/jpeg_end.h"

#include <cstddef>
#include <string>
#include <string_view>

#include "core/file.h"

namespace astrosplat {
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
