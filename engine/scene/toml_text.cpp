// Edits of a TOML text; after each the text is scanned again, which costs nothing at the size of
// a scene file.
#include "scene/toml_text.h"

#include "scene/entries.h"

namespace astrosplat {

/// Finds the headers, keys and values of a text, of which toml++ says where each stands. A friend of
/// TomlText, whose items it makes.
struct TomlScanner {
    const std::string& text;
    std::vector<TomlText::Header>& headers;
    std::vector<TomlText::Item>& items;
    std::vector<std::size_t> lines = {};  // where each begins

    void scan() {
        const std::size_t begin = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
        lines.push_back(begin);
        for (std::size_t end = 0; (end = text.find('\n', end)) != std::string::npos;) lines.push_back(++end);
        headers.push_back({{}, begin, begin});
        table(parse_toml(text, ""), {}, false);
        order_headers();
        std::ranges::sort(items, {}, &TomlText::Item::begin);
        for (TomlText::Item& item : items)
            item.header = std::size_t(std::ranges::count_if(
                              headers, [&](const auto& header) { return header.begin <= item.begin; })) -
                          1;
    }

    /// Columns count characters, which begin with any byte but 10xxxxxx.
    std::size_t offset(const toml::source_position& position) const {
        std::size_t at = lines[position.line - 1];
        for (auto column = position.column; column > 1; --column)
            while (++at < text.size() && (text[at] & 0xC0) == 0x80) {
            }
        return at;
    }

    void add_item(const TomlPath& path, std::size_t begin, const toml::node& value, bool nested) {
        items.push_back({path, 0, begin, offset(value.source().begin), offset(value.source().end), nested});
    }

    void add_header(const TomlPath& path, const toml::node& table) {
        const std::size_t begin = offset(table.source().begin), end = text.find('\n', begin);
        headers.push_back({path, begin, end == std::string::npos ? text.size() : end + 1});
    }

    /// Where a key begins: dotted ones with their first part, which may stand in more than one of them.
    std::size_t key_begin(const toml::key& key, bool nested) const {
        const std::size_t at = offset(key.source().begin);
        if (!nested) return at;
        return text.find_first_not_of(" \t\r", text.find_last_of("{,\n", at - 1) + 1);
    }

    void table(const toml::table& table, const TomlPath& path, bool nested) {
        for (const auto& [key, node] : table) {
            TomlPath own = path;
            own.emplace_back(key.str());
            const toml::table* const inner = node.as_table();
            const toml::array* const list = list_of_tables(node);
            if (inner && !inner->is_inline()) {
                // Dotted keys make tables without a header.
                if (text[offset(node.source().begin)] == '[') add_header(own, node);
                this->table(*inner, own, nested);
            } else if (list && !list->front().as_table()->is_inline()) {
                elements(*list, own, false);
            } else {
                add_item(own, key_begin(key, nested), node, nested);
                if (inner) this->table(*inner, own, true);
                if (const toml::array* array = node.as_array()) elements(*array, own, true);
            }
        }
    }

    /// Of a list of values, in which everything is `nested`, or of [[tables]].
    void elements(const toml::array& array, const TomlPath& path, bool nested) {
        for (std::size_t i = 0; i < array.size(); ++i) {
            TomlPath own = path;
            own.push_back(std::to_string(i));
            const toml::table* const inner = array[i].as_table();
            if (inner && nested) add_item(own, offset(inner->source().begin), *inner, true);
            if (inner && !nested) add_header(own, *inner);
            if (inner) table(*inner, own, nested);
            if (const toml::array* list = array[i].as_array()) elements(*list, own, true);
        }
    }

    /// Of tables that one header makes, [a.b] perhaps a and b, the innermost has it.
    void order_headers() {
        std::ranges::sort(headers, {}, [](const auto& h) { return std::pair(h.body_begin, h.path.size()); });
        const auto same = [](const auto& a, const auto& b) { return a.body_begin == b.body_begin; };
        const auto kept = std::unique(headers.rbegin(), headers.rend(), same);
        headers.erase(headers.begin(), kept.base());
    }
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
    TomlScanner{text_, headers_, items_}.scan();
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
    // Next to the key that shares most of the path ...
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
        headers_.erase(headers_.begin() + std::ptrdiff_t(i));
        for (std::size_t j = i; j < headers_.size(); ++j) {
            headers_[j].begin -= to - from;
            headers_[j].body_begin -= to - from;
        }
    }
    scan();
    return block;
}

}  // namespace astrosplat
