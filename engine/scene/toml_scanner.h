// Finds the keys, values and headers of a valid TOML text.
#pragma once

#include <map>

#include "scene/toml_text.h"

namespace astrosplat {

class TomlScanner {
  public:
    TomlScanner(const std::string& text, std::vector<TomlText::Header>& headers,
                std::vector<TomlText::Item>& items)
        : text_(text), headers_(headers), items_(items) {}
    void scan();

  private:
    char at(std::size_t offset = 0) const {
        return pos_ + offset < text_.size() ? text_[pos_ + offset] : '\0';
    }
    bool done() const { return pos_ >= text_.size(); }
    void skip_blank(bool newlines);
    std::string key_part();
    TomlPath key();
    void header();
    void pair(const TomlPath& parent, bool nested);
    void value(const TomlPath& path);
    void string_value();
    void list(const TomlPath& path);
    void inline_table(const TomlPath& path);
    TomlPath resolved(const TomlPath& path) const;

    const std::string& text_;
    std::vector<TomlText::Header>& headers_;
    std::vector<TomlText::Item>& items_;
    std::map<TomlPath, std::size_t> lists_;  // [[path]] -> elements so far
    std::size_t pos_ = 0;
};

}  // namespace astrosplat
