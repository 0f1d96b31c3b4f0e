// Edits of a TOML text; after each the text is scanned again, which costs nothing at the size of a scene
// file.
#include "scene/toml_text.h"

#include <algorithm>
#include <map>

#include "scene/parameter.h"
#include "scene/parameter_key.h"

namespace astrosplat {

/// Finds the keys, values and headers of a valid TOML text. A friend of TomlText, whose items it makes.
class TomlScanner {
  public:
    TomlScanner(const std::string& text, std::vector<TomlText::Header>& headers,
                std::vector<TomlText::Item>& items)
        : text_(text), headers_(headers), items_(items) {}
    void scan() {
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

  private:
    char at(std::size_t offset = 0) const {
        return pos_ + offset < text_.size() ? text_[pos_ + offset] : '\0';
    }
    bool done() const { return pos_ >= text_.size(); }
    void skip_blank(bool newlines) {
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

    std::string key_part() {
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
        while (!done() && std::string_view(" \t.=]").find(at()) == std::string_view::npos)
            part += text_[pos_++];
        return part;
    }

    TomlPath key() {
        TomlPath path;
        for (;;) {
            skip_blank(false);
            path.push_back(key_part());
            skip_blank(false);
            if (at() != '.') return path;
            ++pos_;
        }
    }

    void header() {
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

    void pair(const TomlPath& parent, bool nested) {
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

    void value(const TomlPath& path) {
        const char c = at();
        if (c == '"' || c == '\'') return string_value();
        if (c == '[') return list(path);
        if (c == '{') return inline_table(path);
        const std::size_t begin = pos_;
        pos_ = std::min(text_.find_first_of(",]}#\r\n", pos_), text_.size());
        while (pos_ > begin && (text_[pos_ - 1] == ' ' || text_[pos_ - 1] == '\t')) --pos_;
    }

    void string_value() {
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

    void list(const TomlPath& path) {
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

    void inline_table(const TomlPath& path) {
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

    /// The path with the index of the newest element after every [[list]] in it.
    TomlPath resolved(const TomlPath& path) const {
        TomlPath result;
        for (const std::string& part : path) {
            result.push_back(part);
            const auto found = lists_.find(result);
            if (found != lists_.end()) result.push_back(std::to_string(found->second - 1));
        }
        return result;
    }

    const std::string& text_;
    std::vector<TomlText::Header>& headers_;
    std::vector<TomlText::Item>& items_;
    std::map<TomlPath, std::size_t> lists_;  // [[path]] -> elements so far
    std::size_t pos_ = 0;
};

namespace {

bool begins_with(const TomlPath& path, const TomlPath& head) {
    return path.size() >= head.size() && std::equal(head.begin(), head.end(), path.begin());
}

std::size_t common_parts(const TomlPath& a, const TomlPath& b) {
    std::size_t count = 0;
    while (count < a.size() && count < b.size() && a[count] == b[count]) ++count;
    return count;
}

bool is_bare(const std::string& part) {
    return !part.empty() && std::ranges::all_of(part, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
               c == '-';
    });
}

}  // namespace

std::string toml_key(const TomlPath& path, std::size_t from) {
    std::string text;
    for (std::size_t i = from; i < path.size(); ++i)
        text += (i == from ? "" : ".") + (is_bare(path[i]) ? path[i] : to_toml(path[i]));
    return text;
}

TomlText::TomlText(std::string text) : text_(std::move(text)) { scan(); }

void TomlText::scan() {
    headers_.clear();
    items_.clear();
    TomlScanner(text_, headers_, items_).scan();
}

void TomlText::replace(std::size_t begin, std::size_t end, const std::string& text) {
    text_.replace(begin, end - begin, text);
    scan();
}

void TomlText::insert(std::size_t at, const std::string& text) { replace(at, at, text); }

const TomlText::Item* TomlText::find(const TomlPath& path) const {
    for (const Item& item : items_)
        if (item.path == path) return &item;
    return nullptr;
}

bool TomlText::contains(const TomlPath& path) const {
    return std::ranges::any_of(items_, [&](const Item& i) { return begins_with(i.path, path); }) ||
           std::ranges::any_of(headers_, [&](const Header& h) { return begins_with(h.path, path); });
}

std::vector<std::string> TomlText::children(const TomlPath& path) const {
    std::vector<std::pair<std::size_t, std::string>> found;
    const auto add = [&](const TomlPath& full, std::size_t at) {
        if (full.size() > path.size() && begins_with(full, path)) found.emplace_back(at, full[path.size()]);
    };
    for (const Header& header : headers_) add(header.path, header.begin);
    for (const Item& item : items_) add(item.path, item.begin);
    std::ranges::sort(found);
    std::vector<std::string> names;
    for (const auto& [at, name] : found)
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names;
}

std::size_t TomlText::line_begin(std::size_t at) const {
    const std::size_t newline = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
    return newline == std::string::npos ? 0 : newline + 1;
}

std::size_t TomlText::line_end(std::size_t at) const {
    const std::size_t newline = text_.find('\n', at);
    return newline == std::string::npos ? text_.size() : newline + 1;
}

/// After the header's last key, or its own line.
std::size_t TomlText::body_end(std::size_t header) const {
    std::size_t end = headers_[header].body_begin;
    for (const Item& item : items_)
        if (item.header == header && !item.nested) end = std::max(end, line_end(item.value_end));
    return end;
}

std::size_t TomlText::block_begin(std::size_t header) const {
    std::size_t begin = line_begin(headers_[header].begin);
    while (begin > 0) {
        const std::size_t above = line_begin(begin - 1);
        if (text_[std::min(text_.find_first_not_of(" \t", above), text_.size() - 1)] != '#') break;
        begin = above;
    }
    return begin;
}

void TomlText::insert_line(std::size_t at, const std::string& line) {
    const std::string newline = text_.find("\r\n") != std::string::npos ? "\r\n" : "\n";
    const bool unfinished = at > 0 && text_[at - 1] != '\n';
    std::string lines = (unfinished ? "\n" : "") + line + "\n";
    for (std::size_t i = 0; (i = lines.find('\n', i)) != std::string::npos; i += newline.size())
        lines.replace(i, 1, newline);
    replace(at, at, lines);
}

bool TomlText::insert_in_inline_table(const TomlPath& path, const std::string& value) {
    const Item* table = nullptr;
    for (const Item& item : items_)
        if (begins_with(path, item.path) && text_[item.value_begin] == '{' &&
            (!table || item.path.size() > table->path.size()))
            table = &item;
    if (!table) return false;
    const std::size_t close = table->value_end - 1;
    std::size_t last = close;  // after the last value
    while (text_[last - 1] == ' ' || text_[last - 1] == '\t') --last;
    const bool empty = text_[last - 1] == '{';
    const std::string pair = toml_key(path, table->path.size()) + " = " + value;
    replace(last, close, (empty ? " " : ", ") + pair + " ");
    return true;
}

bool TomlText::insert_in_header(const TomlPath& path, std::size_t section, const std::string& value) {
    // Beside the key that shares most of the path ...
    const Item* neighbour = nullptr;
    std::size_t shared = section;
    for (const Item& item : items_) {
        const std::size_t common = common_parts(item.path, path);
        const bool fits = !item.nested && begins_with(path, headers_[item.header].path);
        if (!fits || common < shared || (common == shared && headers_[item.header].path.size() > section))
            continue;
        neighbour = &item;
        shared = common;
    }
    if (neighbour) {
        const std::string key = toml_key(path, headers_[neighbour->header].path.size());
        insert_line(line_end(neighbour->value_end), key + " = " + value);
        return true;
    }
    // ... or below the longest header that begins it.
    std::size_t best = 0;
    for (std::size_t i = 1; i < headers_.size(); ++i)
        if (begins_with(path, headers_[i].path) && headers_[i].path.size() > headers_[best].path.size())
            best = i;
    if (headers_[best].path.size() < section || section == 0) return false;
    insert_line(body_end(best), toml_key(path, headers_[best].path.size()) + " = " + value);
    return true;
}

void TomlText::insert_header(const TomlPath& path, std::size_t section, const std::string& value) {
    // A [layer.look] belongs to the [[layer]] above it, so it goes after the last part of that layer.
    const std::size_t owner = section > 2 ? 2 : section;
    std::size_t at = text_.size();
    for (std::size_t i = 1; i < headers_.size(); ++i)
        if (common_parts(headers_[i].path, path) >= owner) at = body_end(i);
    TomlPath header;
    for (std::size_t i = 0; i < section; ++i)
        if (!is_list_index(path[i])) header.push_back(path[i]);
    insert_line(at, "\n[" + toml_key(header) + "]\n" + toml_key(path, section) + " = " + value);
}

void TomlText::set(const TomlPath& path, std::size_t section, const std::string& value) {
    if (const Item* item = find(path))
        replace(item->value_begin, item->value_end, value);
    else if (!insert_in_inline_table(path, value) && !insert_in_header(path, section, value))
        insert_header(path, section, value);
}

void TomlText::remove(const TomlPath& path) {
    std::size_t ignored = 0;
    cut_block(path, ignored);
    for (std::size_t i = 0; i < items_.size();) {
        const Item& item = items_[i];
        if (!begins_with(item.path, path)) {
            ++i;
            continue;
        }
        std::size_t begin = item.begin, end = item.value_end;
        if (!item.nested) {
            begin = line_begin(begin);
            end = line_end(end);
        } else if (const std::size_t next = text_.find_first_not_of(" \t", end); text_[next] == ',') {
            end = std::min(text_.find_first_not_of(" \t", next + 1), text_.size());
        } else if (const std::size_t last = text_.find_last_not_of(" \t", begin - 1); text_[last] == ',') {
            begin = last;
        }
        replace(begin, end, "");
        i = 0;
    }
}

std::string TomlText::cut_block(const TomlPath& path, std::size_t& begin) {
    std::string block;
    begin = std::string::npos;
    for (std::size_t i = 1; i < headers_.size();) {
        if (!begins_with(headers_[i].path, path)) {
            ++i;
            continue;
        }
        const std::size_t from = block_begin(i);
        const std::size_t to = i + 1 < headers_.size() ? block_begin(i + 1) : text_.size();
        if (begin == std::string::npos) begin = from;
        block += text_.substr(from, to - from);
        text_.erase(from, to - from);
        // The paths of what follows keep their indices: only the places move.
        headers_.erase(headers_.begin() + static_cast<std::ptrdiff_t>(i));
        for (std::size_t j = i; j < headers_.size(); ++j) {
            headers_[j].begin -= to - from;
            headers_[j].body_begin -= to - from;
        }
    }
    scan();
    return block;
}

}  // namespace astrosplat
