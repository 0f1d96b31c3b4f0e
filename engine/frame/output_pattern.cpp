#include "frame/output_pattern.h"

#include <fmt/format.h>

#include "core/error.h"

namespace astrosplat {
namespace {

/// A place for the frame's number.
struct Place {
    std::size_t begin = 0, size = 0;
    std::size_t width = 0;  // digits, at least
};

std::size_t digits_at(const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
    return end - at;
}

/// Width of "04": its value, at most 64 digits.
std::size_t width_of(const std::string& text, std::size_t at, std::size_t digits) {
    std::size_t width = 0;
    for (std::size_t i = 0; i < digits; ++i)
        width = std::min<std::size_t>(width * 10 + std::size_t(text[at + i] - '0'), 64);
    return width;
}

std::optional<Place> place_at(const std::string& text, std::size_t at) {
    if (text[at] == '#') {
        const std::size_t size = std::min(text.find_first_not_of('#', at), text.size()) - at;
        return Place{at, size, size};
    }
    if (text[at] == '%') {
        const std::size_t digits = digits_at(text, at + 1);
        if (at + 1 + digits < text.size() && text[at + 1 + digits] == 'd')
            return Place{at, digits + 2, width_of(text, at + 1, digits)};
    }
    if (text.compare(at, 7, "{frame}") == 0) return Place{at, 7, 0};
    if (text.compare(at, 7, "{frame:") == 0) {
        const std::size_t digits = digits_at(text, at + 7);
        std::size_t end = at + 7 + digits;
        if (digits > 0 && end < text.size() && text[end] == 'd') ++end;
        if (digits > 0 && end < text.size() && text[end] == '}')
            return Place{at, end + 1 - at, width_of(text, at + 7, digits)};
    }
    return std::nullopt;
}

std::optional<Place> find_place(const std::string& text, std::size_t from = 0) {
    for (std::size_t at = from; at < text.size(); ++at)
        if (const std::optional<Place> place = place_at(text, at)) return place;
    return std::nullopt;
}

/// Where "%V" or "%v" stands, or the text's end.
std::size_t find_eye(const std::string& text) {
    return std::min({text.find("%V"), text.find("%v"), text.size()});
}

std::string with_eye(std::string text, Eye eye) {
    const std::string name(name_of(eye));
    for (std::size_t at; (at = find_eye(text)) < text.size();)
        text.replace(at, 2, text[at + 1] == 'V' ? name : name.substr(0, 1));
    return text;
}

bool has_places(const std::string& text) { return find_place(text) || find_eye(text) < text.size(); }

void check_one_place(const std::string& name) {
    const std::optional<Place> place = find_place(name);
    if (place && find_place(name, place->begin + place->size))
        throw InputError(
            fmt::format("output.path: expected one place for the frame number (####, %04d or {{frame:04}}), "
                        "found more in '{}'",
                        name));
}

}  // namespace

fs::path OutputPattern::resolve(std::int64_t frame, Eye eye) const {
    check_one_place(name);
    const std::string named = with_eye(name, eye);
    const std::optional<Place> place = find_place(named);
    if (!place) return folder / named;
    const std::uint64_t magnitude = frame < 0 ? 0 - std::uint64_t(frame) : std::uint64_t(frame);
    return folder / fmt::format("{}{}{:0{}}{}", named.substr(0, place->begin), frame < 0 ? "-" : "",
                                magnitude, place->width, named.substr(place->begin + place->size));
}

bool OutputPattern::is_numbered() const { return find_place(name).has_value(); }

bool OutputPattern::is_stereo() const { return find_eye(name) < name.size(); }

fs::path OutputPattern::common_folder() const {
    fs::path common = folder;
    for (const fs::path& part : fs::path(name).parent_path()) {
        if (has_places(part.string())) break;
        common /= part;
    }
    return common;
}

std::string OutputPattern::stem() const {
    std::string stem = fs::path(name).stem().string();
    const std::optional<Place> place = find_place(stem);
    stem.erase(std::min(place ? place->begin : stem.size(), find_eye(stem)));
    while (!stem.empty() && (stem.back() == '.' || stem.back() == '_' || stem.back() == '-')) stem.pop_back();
    return stem.empty() ? "frame" : stem;
}

OutputPattern output_pattern(const fs::path& base, const std::string& text) {
    OutputPattern pattern{base, {}};
    const fs::path written(text);
    fs::path rest;
    bool exist = true;  // all folders so far
    for (auto part = written.begin(); part != written.end(); ++part) {
        std::error_code ignored;
        exist =
            exist && std::next(part) != written.end() && fs::is_directory(pattern.folder / *part, ignored);
        (exist ? pattern.folder : rest) /= *part;
    }
    pattern.name = rest.string();
    check_one_place(pattern.name);
    return pattern;
}

std::vector<Eye> eyes_of(const OutputPattern& pattern, const CameraParams& camera) {
    if (!pattern.is_stereo()) return {camera.eye};
    if (!has_two_eyes(camera.projection))
        bad_input(pattern.text(), "no %V, for this projection has no left and right eye",
                  std::string(name_of(camera.projection)));
    return {Eye::left, Eye::right};
}

}  // namespace astrosplat
