// A search for three properties, not an XML parser: packets are small and written by few programs.
#include "source/credit.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

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

}  // namespace astrosplat
