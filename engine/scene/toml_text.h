// A TOML text that can be edited without losing its comments, order or layout: finds where each key and value
// stands, and changes, inserts or removes single ones. The text must be valid TOML (entries.h
// has parsed it).
#pragma once

#include "core/standard.h"

namespace astrosplat {

/// {"layer", "0", "look", "alpha", "power"}: lists of tables carry their index.
using TomlPath = std::vector<std::string>;

class TomlText {
  public:
    explicit TomlText(std::string text);
    const std::string& text() const { return text_; }

    /// Whether the path itself, or anything below it, is written.
    bool contains(const TomlPath& path) const;
    /// Whether `path` is the key of a value, not of a header or the beginning of dotted keys.
    bool is_value(const TomlPath& path) const { return find(path) != nullptr; }
    /// Parts that follow `path` in keys and headers, each once, in the order of the text.
    std::vector<std::string> children(const TomlPath& path) const;

    /// Replaces the value at `path`, or inserts it where its neighbours stand: in its inline table, after
    /// keys of the same table, at the end of its header's part, or below a new header of the
    /// first `section` parts.
    void set(const TomlPath& path, std::size_t section, const std::string& value);
    /// Removes the value at `path` and everything below it, with their lines.
    void remove(const TomlPath& path);
    /// The whole text of everything below headers that begin with `path`, cut out, and where it began.
    std::string cut_block(const TomlPath& path, std::size_t& begin);
    void insert(std::size_t at, const std::string& text);

  private:
    struct Item {  // key = value, or an inline table that is an element of a list
        TomlPath path;
        std::size_t header;  // index into headers_
        std::size_t begin, value_begin, value_end;
        bool nested;  // inside an inline table or list
    };
    struct Header {
        TomlPath path;
        std::size_t begin, body_begin;  // of its line, of the line after it
    };
    friend struct TomlScanner;

    void scan();
    void replace(std::size_t begin, std::size_t end, const std::string& text);
    const Item* find(const TomlPath& path) const;
    bool insert_in_inline_table(const TomlPath& path, const std::string& value);
    bool insert_in_header(const TomlPath& path, std::size_t section, const std::string& value);
    void insert_header(const TomlPath& path, std::size_t section, const std::string& value);
    std::size_t line_begin(std::size_t at) const;
    std::size_t line_end(std::size_t at) const;  // of the next line's first character
    std::size_t body_end(std::size_t header) const;
    std::size_t block_begin(std::size_t header) const;  // with the comments directly above it
    void insert_line(std::size_t at, const std::string& line);

    std::string text_;
    std::vector<Header> headers_;  // the first is the top of the file
    std::vector<Item> items_;
};

/// a.b."c.d": parts in quotes where TOML needs them.
std::string toml_key(const TomlPath& path, std::size_t from = 0);

}  // namespace astrosplat
