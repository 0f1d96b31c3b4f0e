// Frame numbers in file names: "####", "%04d" and "{frame:04}" are replaced by the frame, padded with zeros,
// and
// "%V" by the eye.
#include "output/frame_path.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "core/error.h"

namespace astrosplat {
namespace {

struct Token {
    std::size_t begin = 0, size = 0;
    std::size_t width = 0;  // digits, at least
};

std::size_t digits_at(const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
    return end - at;
}

// Width of "04": its value, at most 64 digits.
std::size_t width_of(const std::string& text, std::size_t at, std::size_t digits) {
    std::size_t width = 0;
    for (std::size_t i = 0; i < digits; ++i)
        width = std::min<std::size_t>(width * 10 + std::size_t(text[at + i] - '0'), 64);
    return width;
}

std::optional<Token> token_at(const std::string& text, std::size_t at) {
    if (text[at] == '#') {
        std::size_t end = text.find_first_not_of('#', at);
        std::size_t size = (end == std::string::npos ? text.size() : end) - at;
        return Token{at, size, size};
    }
    if (text[at] == '%') {
        std::size_t digits = digits_at(text, at + 1);
        if (at + 1 + digits < text.size() && text[at + 1 + digits] == 'd')
            return Token{at, digits + 2, width_of(text, at + 1, digits)};
    }
    if (text.compare(at, 7, "{frame}") == 0) return Token{at, 7, 0};
    if (text.compare(at, 7, "{frame:") == 0) {
        std::size_t digits = digits_at(text, at + 7), end = at + 7 + digits;
        if (digits > 0 && end < text.size() && text[end] == 'd') ++end;
        if (digits > 0 && end < text.size() && text[end] == '}')
            return Token{at, end + 1 - at, width_of(text, at + 7, digits)};
    }
    return std::nullopt;
}

std::optional<Token> find_token(const std::string& text, std::size_t from) {
    for (std::size_t at = from; at < text.size(); ++at)
        if (std::optional<Token> token = token_at(text, at)) return token;
    return std::nullopt;
}

std::string with_eye(std::string pattern, Eye eye) {
    const std::string name(name_of(eye));
    for (std::size_t at = 0; at + 1 < pattern.size(); ++at)
        if (pattern[at] == '%' && (pattern[at + 1] == 'V' || pattern[at + 1] == 'v'))
            pattern.replace(at, 2, pattern[at + 1] == 'V' ? name : name.substr(0, 1));
    return pattern;
}

}  // namespace

bool has_frame_token(const std::string& pattern) { return find_token(pattern, 0).has_value(); }

bool has_eye_token(const std::string& pattern) { return with_eye(pattern, Eye::left) != pattern; }

std::string frame_file(const std::string& eyes_pattern, std::int64_t frame, Eye eye) {
    const std::string pattern = with_eye(eyes_pattern, eye);
    std::optional<Token> token = find_token(pattern, 0);
    if (!token) return pattern;
    std::size_t rest = token->begin + token->size;
    if (find_token(pattern, rest))
        throw InputError(
            fmt::format("output.path: expected one place for the frame number (####, %04d or {{frame:04}}), "
                        "found more in '{}'",
                        pattern));
    std::uint64_t magnitude =
        frame < 0 ? 0 - static_cast<std::uint64_t>(frame) : static_cast<std::uint64_t>(frame);
    std::string number = fmt::format("{}{:0{}}", frame < 0 ? "-" : "", magnitude, token->width);
    return pattern.substr(0, token->begin) + number + pattern.substr(rest);
}

}  // namespace astrosplat
