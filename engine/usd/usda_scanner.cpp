#include "usd/usda_scanner.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/shown.h"

namespace astrosplat {
namespace {

bool in_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ':' || c == '.' || c == '+' || c == '-' || c == '!' || static_cast<unsigned char>(c) > 127;
}

}  // namespace

void UsdScanner::fail(const std::string& expected) const {
    const std::size_t at = std::min(at_, text_.size());
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    const auto line = 1 + std::ranges::count(text_.substr(0, at), '\n');
    bad_input(file_, std::to_string(line), expected,
              at == text_.size() ? "the end of the file" : shown(text_.substr(at, end - at)));
}

void UsdScanner::skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

bool UsdScanner::skip_blanks() {
    bool line_ended = false;
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (c == '#') {
            skip_line();
            continue;
        }
        if (c != ' ' && c != '\t' && c != '\r' && c != ';' && c != '\n') break;
        line_ended = line_ended || c == '\n';
        ++at_;
    }
    return line_ended;
}

char UsdScanner::peek() {
    skip_blanks();
    return here();
}

bool UsdScanner::take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
}

void UsdScanner::require(char c) {
    if (!take(c)) fail(fmt::format("'{}'", c));
}

std::string UsdScanner::next_word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && in_word(text_[at_])) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
}

std::string UsdScanner::quoted(char mark) {
    const std::string one(1, mark), three(3, mark);
    const std::string& end = text_.substr(at_).starts_with(three) ? three : one;
    const std::size_t begin = at_ + end.size();
    for (at_ = std::min(begin, text_.size()); at_ < text_.size(); ++at_) {
        if (text_[at_] == '\\' && mark != '@') {
            ++at_;
            continue;
        }
        if (!text_.substr(at_).starts_with(end)) continue;
        std::string inside(text_.substr(begin, at_ - begin));
        at_ += end.size();
        return inside;
    }
    at_ = text_.size();
    fail(fmt::format("a closing {}", mark));
}

std::string_view UsdScanner::numbers() {
    const std::size_t begin = at_;
    at_ = std::min(text_.find(']', at_), text_.size());
    require(']');
    return text_.substr(begin, at_ - begin);
}

void UsdScanner::skip_path() {
    at_ = std::min(text_.find('>', at_), text_.size());
    require('>');
}

void UsdScanner::skip_brackets(int depth) {
    if (depth > deepest_usd) fail(fmt::format("at most {} brackets within each other", deepest_usd));
    const char close = here() == '(' ? ')' : here() == '[' ? ']' : '}';
    ++at_;
    while (!take(close)) skip_one(depth + 1);
}

void UsdScanner::skip_one(int depth) {
    const char c = peek();
    if (c == '\0') fail("a closing bracket");
    if (c == '(' || c == '[' || c == '{')
        skip_brackets(depth);
    else if (c == '"' || c == '\'' || c == '@')
        quoted(c);
    else if (next_word().empty())
        ++at_;
}

void UsdScanner::skip_statement() {
    while (true) {
        const bool line_ended = skip_blanks();
        const char c = here();
        if (c == '\0' || c == '}' || (line_ended && c != '{' && c != '(')) return;
        skip_one();
    }
}

}  // namespace astrosplat
