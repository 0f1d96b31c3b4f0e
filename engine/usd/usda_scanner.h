// The characters of a .usda: words, strings and brackets. In: the text. Out: one after the other, and every
// message's line.
#pragma once

#include <string>
#include <string_view>

namespace astrosplat {

inline constexpr int deepest_usd = 64;  // prims and brackets within each other

class UsdScanner {
  public:
    /// Both outlive this.
    UsdScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// Throws InputError with the file and this line; what is found is the rest of the line.
    [[noreturn]] void fail(const std::string& expected) const;
    std::size_t place() const { return at_; }
    void go_back(std::size_t place) { at_ = place; }
    void skip_line();

    /// Over blanks and comments; true where a line ended among them.
    bool skip_blanks();
    /// The character here; 0 at the end.
    char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    /// The next that is no blank, which stays; 0 at the end.
    char peek();
    /// Takes it where it is c.
    bool take(char c);
    void require(char c);
    /// Letters, digits and what numbers and names hold beside them; may be empty.
    std::string next_word();
    /// Between `mark`s, each once or three times; a backslash takes the next character.
    std::string quoted(char mark);
    /// [...] from the bracket here on, unread: a list of numbers has no other brackets of its kind.
    std::string_view numbers();
    /// <...>
    void skip_path();
    /// What stands between the bracket here and its end, whatever it is.
    void skip_brackets(int depth = 0);
    /// A string, a word, a bracket with its inside or one other character.
    void skip_one(int depth = 0);
    /// To the end of the line, with all brackets that begin on it.
    void skip_statement();

  private:
    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
};

}  // namespace astrosplat
