// A scanner for valid TOML: it needs no error messages, toml++ has read the same text before.
#include "scene/toml_scanner.h"

#include <algorithm>

namespace astrosplat {

void TomlScanner::skip_blank(bool newlines) {
    while (!done()) {
        const char c = at();
        if (c == '#' && newlines) {
            pos_ = std::min(text_.find('\n', pos_), text_.size());
        } else if (c == ' ' || c == '\t' || (newlines && (c == '\n' || c == '\r'))) {
            ++pos_;
        } else {
            return;
        }
    }
}

std::string TomlScanner::key_part() {
    const char quote = at();
    std::string part;
    if (quote == '"' || quote == '\'') {
        for (++pos_; !done() && at() != quote; ++pos_) {
            if (quote == '"' && at() == '\\') ++pos_;
            part += at();
        }
        ++pos_;
        return part;
    }
    while (!done() && std::string_view(" \t.=]").find(at()) == std::string_view::npos) part += text_[pos_++];
    return part;
}

TomlPath TomlScanner::key() {
    TomlPath path;
    for (;;) {
        skip_blank(false);
        path.push_back(key_part());
        skip_blank(false);
        if (at() != '.') return path;
        ++pos_;
    }
}

/// The path with the index of the newest element after every [[list]] in it.
TomlPath TomlScanner::resolved(const TomlPath& path) const {
    TomlPath result;
    for (const std::string& part : path) {
        result.push_back(part);
        const auto found = lists_.find(result);
        if (found != lists_.end()) result.push_back(std::to_string(found->second - 1));
    }
    return result;
}

void TomlScanner::header() {
    const std::size_t begin = pos_;
    const bool list = at(1) == '[';
    pos_ += list ? 2 : 1;
    const TomlPath path = key();
    if (list) {
        TomlPath outer = resolved(TomlPath(path.begin(), path.end() - 1));
        outer.push_back(path.back());
        ++lists_[outer];
    }
    const std::size_t end = text_.find('\n', pos_);
    pos_ = end == std::string::npos ? text_.size() : end + 1;
    headers_.push_back({resolved(path), begin, pos_});
}

void TomlScanner::string_value() {
    const char quote = at();
    const bool long_string = at(1) == quote && at(2) == quote;
    if (!long_string) {
        for (++pos_; !done() && at() != quote; ++pos_)
            if (quote == '"' && at() == '\\') ++pos_;
        ++pos_;
        return;
    }
    for (pos_ += 3; !done() && !(at() == quote && at(1) == quote && at(2) == quote); ++pos_)
        if (quote == '"' && at() == '\\') ++pos_;
    pos_ += 3;
    while (at() == quote) ++pos_;  // up to two quotes may end the string's own text
}

void TomlScanner::list(const TomlPath& path) {
    ++pos_;
    for (std::size_t index = 0;; ++index) {
        skip_blank(true);
        if (at() == ']' || done()) break;
        TomlPath element = path;
        element.push_back(std::to_string(index));
        const std::size_t begin = pos_;
        const bool table = at() == '{';
        const std::size_t slot = items_.size();
        if (table) items_.push_back({element, headers_.size() - 1, begin, begin, begin, true});
        value(element);
        if (table) items_[slot].value_end = pos_;
        skip_blank(true);
        if (at() == ',') ++pos_;
    }
    ++pos_;
}

void TomlScanner::inline_table(const TomlPath& path) {
    ++pos_;
    for (;;) {
        skip_blank(true);
        if (at() == '}' || done()) break;
        pair(path, true);
        skip_blank(true);
        if (at() == ',') ++pos_;
    }
    ++pos_;
}

void TomlScanner::value(const TomlPath& path) {
    const char c = at();
    if (c == '"' || c == '\'') return string_value();
    if (c == '[') return list(path);
    if (c == '{') return inline_table(path);
    const std::size_t begin = pos_;
    pos_ = std::min(text_.find_first_of(",]}#\r\n", pos_), text_.size());
    while (pos_ > begin && (text_[pos_ - 1] == ' ' || text_[pos_ - 1] == '\t')) --pos_;
}

void TomlScanner::pair(const TomlPath& parent, bool nested) {
    const std::size_t begin = pos_;
    TomlPath path = parent;
    for (std::string& part : key()) path.push_back(std::move(part));
    ++pos_;  // =
    skip_blank(false);
    const std::size_t slot = items_.size();
    items_.push_back({path, headers_.size() - 1, begin, pos_, pos_, nested});
    value(path);
    items_[slot].value_end = pos_;
}

void TomlScanner::scan() {
    if (text_.rfind("\xEF\xBB\xBF", 0) == 0) pos_ = 3;
    headers_.push_back({{}, pos_, pos_});
    for (;;) {
        skip_blank(true);
        if (done()) return;
        if (at() == '[')
            header();
        else
            pair(TomlPath(headers_.back().path), false);
    }
}

}  // namespace astrosplat
