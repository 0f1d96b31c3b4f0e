// A recursive descent that needs no list of types: a statement begins with words, an = and a
// value may follow.
#include "usd/usda_stage.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr int deepest_usd = 64;  // prims and brackets within each other

bool in_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ':' || c == '.' || c == '+' || c == '-' || c == '!' || static_cast<unsigned char>(c) > 127;
}

/// The characters of a .usda: words, strings and brackets, one after the other, and the line for messages.
class UsdScanner {
  public:
    /// Both outlive this.
    UsdScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// Throws InputError with the file and this line; what is found is the rest of the line.
    [[noreturn]] void fail(const std::string& expected) const {
        const std::size_t at = std::min(at_, text_.size());
        const std::size_t end = std::min(text_.find('\n', at), text_.size());
        const auto line = 1 + std::ranges::count(text_.substr(0, at), '\n');
        bad_input(file_, std::to_string(line), expected,
                  at == text_.size() ? "the end of the file" : shown(text_.substr(at, end - at)));
    }

    std::size_t place() const { return at_; }
    void go_back(std::size_t place) { at_ = place; }
    void skip_line();

    /// Over blanks and comments; true where a line ended among them.
    bool skip_blanks() {
        bool line_ended = false;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (std::string_view("# \t\r;\n").find(c) == std::string_view::npos) break;
            line_ended = line_ended || c == '\n';
            c == '#' ? skip_line() : void(++at_);
        }
        return line_ended;
    }

    /// The character here; 0 at the end.
    char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    /// The next that is no blank, which stays; 0 at the end.
    char peek() {
        skip_blanks();
        return here();
    }

    /// Takes it where it is c.
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }

    void require(char c) {
        if (!take(c)) fail(fmt::format("'{}'", c));
    }

    /// Letters, digits and what numbers and names hold besides them; may be empty.
    std::string next_word() {
        skip_blanks();
        const std::size_t begin = at_;
        while (at_ < text_.size() && in_word(text_[at_])) ++at_;
        return std::string(text_.substr(begin, at_ - begin));
    }

    /// Between `mark`s, each once or three times; a backslash takes the next character.
    std::string quoted(char mark) {
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

    /// [...] from the bracket here on, unread: a list of numbers has no other brackets of its kind.
    std::string_view numbers() {
        const std::size_t begin = at_;
        at_ = std::min(text_.find(']', at_), text_.size());
        require(']');
        return text_.substr(begin, at_ - begin);
    }

    /// A path in angle brackets.
    void skip_path() {
        at_ = std::min(text_.find('>', at_), text_.size());
        require('>');
    }

    /// The text between the bracket here and its end, of any kind.
    void skip_brackets(int depth = 0) {
        if (depth > deepest_usd) fail(fmt::format("at most {} brackets within each other", deepest_usd));
        const char close = here() == '(' ? ')' : here() == '[' ? ']' : '}';
        ++at_;
        while (!take(close)) skip_one(depth + 1);
    }

    /// A string, a word, a bracket with its inside or one other character.
    void skip_one(int depth = 0) {
        const char c = peek();
        if (c == '\0') fail("a closing bracket");
        if (c == '(' || c == '[' || c == '{')
            skip_brackets(depth);
        else if (c == '"' || c == '\'' || c == '@')
            quoted(c);
        else if (next_word().empty())
            ++at_;
    }

    /// To the end of the line, with all brackets that begin on it.
    void skip_statement() {
        while (true) {
            const bool line_ended = skip_blanks();
            const char c = here();
            if (c == '\0' || c == '}' || (line_ended && c != '{' && c != '(')) return;
            skip_one();
        }
    }

  private:
    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
};

void UsdScanner::skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

bool is_kept(std::string_view name) {
    constexpr std::array others{"focalLength",
                                "horizontalAperture",
                                "verticalAperture",
                                "horizontalApertureOffset",
                                "verticalApertureOffset",
                                "projection",
                                "visibility",
                                "radiance:sphericalHarmonicsDegree"};
    return name.starts_with("xformOp") || std::ranges::find(others, name) != others.end();
}

/// Of Gaussians, in floats or halves.
bool is_list(std::string_view name) {
    constexpr std::array lists{"positions", "orientations", "scales", "opacities",
                               "radiance:sphericalHarmonicsCoefficients"};
    if (name.ends_with('h')) name.remove_suffix(1);
    return std::ranges::find(lists, name) != lists.end();
}

class Parser {
  public:
    Parser(std::string_view text, const std::string& file)
        : scan_(text, file), is_usda_(text.starts_with("#usda")) {}

    UsdStage stage() {
        if (!is_usda_) scan_.fail("#usda and a version");
        scan_.skip_line();
        if (scan_.peek() == '(') metadata(stage_.metadata);
        while (scan_.peek() != '\0') {
            std::string word = scan_.next_word();
            if (is_specifier(word))
                stage_.prims.push_back(prim(word, 0));
            else if (word.empty())
                scan_.fail("def, over or class");
            else
                scan_.skip_statement();
        }
        return std::move(stage_);
    }

  private:
    static bool is_specifier(std::string_view word) {
        return word == "def" || word == "over" || word == "class";
    }
    // Adds to `value`, which may be null.
    void read_value(UsdValue* value, int depth) {
        if (depth > deepest_usd)
            scan_.fail(fmt::format("at most {} brackets within each other", deepest_usd));
        const char c = scan_.peek();
        if (c == '(' || c == '[') {
            scan_.take(c);
            const char close = c == '(' ? ')' : ']';
            while (!scan_.take(close)) {
                read_value(value, depth + 1);
                scan_.take(',');
            }
        } else if (c == '{') {
            scan_.skip_brackets(depth);
        } else if (c == '"' || c == '\'' || c == '@') {
            std::string text = scan_.quoted(c);
            if (value && c != '@') value->words.push_back(std::move(text));
        } else if (c == '<') {
            scan_.skip_path();
        } else {
            const std::size_t begin = scan_.place();
            const std::string word = scan_.next_word();
            if (word.empty()) scan_.fail("a value");
            const std::optional<double> number = parse_double(word);
            if (!value) return;
            if (number)
                value->numbers.push_back(*number);
            else if (word != "None")
                value->words.push_back(word);
            if (value->numbers.size() > most_numbers) {
                scan_.go_back(begin);
                scan_.fail(fmt::format("at most {} numbers of an attribute", most_numbers));
            }
        }
    }

    // { 1: value, 2: value, }; what is None is no sample: true where there are such.
    bool read_samples(UsdAttribute* attribute) {
        bool some_none = false;
        scan_.require('{');
        while (!scan_.take('}')) {
            const std::size_t begin = scan_.place();
            std::string word = scan_.next_word();
            // "1:" and "1: 5" alike: a word may hold the colon.
            const bool colon = !word.empty() && word.back() == ':';
            if (colon) word.pop_back();
            const std::optional<double> time = parse_double(word);
            if (!time) {
                scan_.go_back(begin);
                scan_.fail("a time code");
            }
            if (!colon) scan_.require(':');
            UsdValue value;
            read_value(attribute ? &value : nullptr, 0);
            scan_.take(',');
            const bool none = value.numbers.empty() && value.words.empty();
            some_none |= attribute && none;
            if (attribute && !none) attribute->samples.emplace_back(*time, std::move(value));
        }
        if (attribute) std::ranges::stable_sort(attribute->samples, {}, &std::pair<double, UsdValue>::first);
        return some_none;
    }

    // ( key = value ... ), of which the first word of a key that stands alone is its name.
    void metadata(std::map<std::string, UsdValue>& kept) {
        scan_.require('(');
        while (!scan_.take(')')) {
            const char c = scan_.peek();
            if (c == '"' || c == '\'') {
                scan_.quoted(c);
                continue;
            }
            std::string name = scan_.next_word();
            if (name.empty()) scan_.fail("a name");
            while (!scan_.take('=')) {
                if (scan_.peek() == ')') break;
                std::string word = scan_.next_word();
                if (word.empty()) scan_.fail("'='");
                name = std::move(word);
            }
            if (scan_.peek() == ')') continue;
            constexpr std::array arcs{"references", "payload", "subLayers", "inherits", "specializes"};
            const auto* const arc = std::ranges::find(arcs, name);
            stage_.refers_elsewhere |= arc < arcs.begin() + 3;
            if (arc != arcs.end()) kept["unread"].words.push_back(name);
            if (name == "variants" && scan_.peek() == '{') {
                kept[name].words = selections();
                continue;
            }
            constexpr std::array wanted{"upAxis", "timeCodesPerSecond", "framesPerSecond", "active"};
            const bool is_wanted = std::ranges::find(wanted, name) != wanted.end();
            UsdValue value;
            read_value(is_wanted ? &value : nullptr, 0);
            if (scan_.peek() == '<') scan_.skip_path();         // within the file before it
            while (scan_.peek() == '(') scan_.skip_brackets();  // a layer's offset
            if (is_wanted) kept[name] = std::move(value);
        }
    }

    // { string SET = "VARIANT" ... } as SET, VARIANT, ...
    std::vector<std::string> selections() {
        std::vector<std::string> words;
        scan_.require('{');
        while (!scan_.take('}')) {
            scan_.next_word();  // the type
            words.push_back(name_or_string());
            scan_.require('=');
            words.push_back(name_or_string());
        }
        return words;
    }

    std::string name_or_string() {
        const char c = scan_.peek();
        std::string word = c == '"' || c == '\'' ? scan_.quoted(c) : scan_.next_word();
        if (word.empty()) scan_.fail("a name");
        return word;
    }

    // What the file selects of "SET" = { "VARIANT" (...) { ... } ... }.
    void variant_set(UsdPrim& prim, int depth) {
        if (depth > deepest_usd) scan_.fail(fmt::format("at most {} prims within each other", deepest_usd));
        const auto chosen = prim.variants.find(name_or_string());
        scan_.require('=');
        scan_.require('{');
        while (!scan_.take('}')) {
            const bool selected = name_or_string() == (chosen == prim.variants.end() ? "" : chosen->second);
            std::map<std::string, UsdValue> own;
            if (scan_.peek() == '(') metadata(own);
            if (!selected) {
                stage_.has_unselected |= chosen == prim.variants.end();
                if (scan_.peek() != '{') scan_.fail("'{'");
                scan_.skip_brackets();
                continue;
            }
            UsdPrim inside;
            inside.type = prim.type;
            inside.variants = prim.variants;
            take_metadata(own, inside);
            body(inside, depth);
            add_weaker(prim, std::move(inside));
        }
    }

    // From { to }; variants last, for they are weaker than the prim's own.
    void body(UsdPrim& prim, int depth) {
        scan_.require('{');
        std::vector<std::size_t> sets;
        std::swap(sets, variant_sets_);
        while (!scan_.take('}')) statement(prim, depth);
        std::swap(sets, variant_sets_);
        const std::size_t end = scan_.place();
        for (const std::size_t at : sets) {
            scan_.go_back(at);
            variant_set(prim, depth + 1);
        }
        scan_.go_back(end);
    }

    static void take_metadata(std::map<std::string, UsdValue>& metadata, UsdPrim& prim) {
        std::ranges::copy(metadata["unread"].words, std::back_inserter(prim.unread));
        const std::vector<std::string>& words = metadata["variants"].words;
        for (std::size_t i = 0; i + 1 < words.size(); i += 2)
            prim.variants.try_emplace(words[i], words[i + 1]);
    }

    static void add_weaker(UsdPrim& prim, UsdPrim weaker) {
        if (prim.type.empty()) prim.type = weaker.type;
        std::ranges::copy(weaker.unread, std::back_inserter(prim.unread));
        prim.attributes.merge(weaker.attributes);
        for (UsdPrim& child : weaker.children) {
            const auto same = std::ranges::find(prim.children, child.name, &UsdPrim::name);
            if (same == prim.children.end()) {
                prim.children.push_back(std::move(child));
            } else {
                same->defined = same->defined || child.defined;
                add_weaker(*same, std::move(child));
            }
        }
    }

    UsdPrim prim(const std::string& specifier, int depth) {
        if (depth > deepest_usd) scan_.fail(fmt::format("at most {} prims within each other", deepest_usd));
        UsdPrim prim;
        prim.defined = specifier == "def";
        if (scan_.peek() != '"' && scan_.peek() != '\'') prim.type = scan_.next_word();
        if (scan_.peek() != '"' && scan_.peek() != '\'') scan_.fail("the name of a prim");
        prim.name = scan_.quoted(scan_.peek());
        if (depth == 0) prim.unread = stage_.metadata["unread"].words;
        if (scan_.peek() == '(') {
            std::map<std::string, UsdValue> own;
            metadata(own);
            if (own["active"].is("false")) prim.defined = false;
            take_metadata(own, prim);
        }
        body(prim, depth);
        return prim;
    }

    void statement(UsdPrim& prim, int depth) {
        const std::size_t begin = scan_.place();
        std::string word = scan_.next_word();
        if (word.empty()) {
            scan_.go_back(begin);
            if (scan_.peek() == '\0') scan_.fail("'}'");
            scan_.fail("an attribute or a prim");
        }
        if (is_specifier(word)) {
            prim.children.push_back(this->prim(word, depth + 1));
            return;
        }
        if (word == "variantSet") variant_sets_.push_back(scan_.place());
        if (word == "variantSet" || word == "reorder") return scan_.skip_statement();
        std::string name;
        while (true) {  // words up to the = or the line's end; the last is the name
            const bool line_ended = scan_.skip_blanks();
            const char c = scan_.here();
            if (line_ended || c == '\0' || c == '}' || c == '(') break;
            if (c == '=') return assign(prim, name);
            if (c == '[' || c == ']') {
                scan_.take(c);
                continue;
            }
            name = scan_.next_word();
            if (name.empty()) scan_.fail("the name of an attribute");
        }
        if (scan_.here() == '(') scan_.skip_brackets();
    }

    void assign(UsdPrim& prim, std::string name) {
        scan_.require('=');
        constexpr std::string_view sampled = ".timeSamples";
        const bool samples = name.ends_with(sampled);
        if (samples) name.resize(name.size() - sampled.size());
        const bool list = prim.type == usd_gaussians && is_list(name);
        constexpr std::array cameras{"fStop",         "focusDistance", "shutter:open",
                                     "shutter:close", "stereoRole",    "exposure"};
        const bool camera = std::ranges::find(cameras, name) != cameras.end();
        const std::string base = name.substr(0, name.find('.'));
        const bool still = list || name == "visibility";
        if ((still && samples) || (base != name && (is_kept(base) || is_list(base))))
            prim.unread.push_back(samples ? name + ".timeSamples" : name);
        UsdAttribute told;  // of a camera, where it is other than USD's own
        UsdAttribute* const attribute = is_kept(name) || list ? &prim.attributes[name]
                                        : camera              ? &told
                                                              : nullptr;
        if (list && !samples && scan_.peek() == '[') {
            attribute->list = scan_.numbers();
        } else if (still && samples) {
            read_samples(nullptr);
        } else if (list) {
            read_value(nullptr, 0);
        } else if (samples) {
            if (attribute) attribute->samples.clear();
            if (read_samples(attribute)) prim.unread.push_back("None in " + name + ".timeSamples");
        } else {
            UsdValue value;
            read_value(attribute ? &value : nullptr, 0);
            if (attribute && (!value.numbers.empty() || !value.words.empty())) {
                attribute->value = std::move(value);
                attribute->has_value = true;
            }
        }
        if (!told.samples.empty() ||
            (told.has_value && told.value.numbers != std::vector{0.0} && !told.value.is("mono")))
            prim.unread.push_back(name);
        if (scan_.peek() == '(') scan_.skip_brackets();
    }

    static constexpr std::size_t most_numbers = 1024;

    UsdScanner scan_;
    std::vector<std::size_t> variant_sets_;  // where those of the prim that is read begin
    bool is_usda_;
    UsdStage stage_;
};

}  // namespace

const UsdAttribute& UsdPrim::attribute(const std::string& attribute_name) const {
    static const UsdAttribute none;
    const auto found = attributes.find(attribute_name);
    return found == attributes.end() ? none : found->second;
}

bool UsdStage::is_z_up() const {
    const auto up = metadata.find("upAxis");
    return up != metadata.end() && up->second.is("Z");
}

std::string UsdStage::none_found() const {
    return refers_elsewhere ? "none but what other files may hold, which are not opened"
           : has_unselected ? "none but what variants may hold of which the file selects none"
                            : "none";
}

std::string left_out(std::span<const UsdPrim* const> prims) {
    std::string text;
    for (const UsdPrim* const prim : prims)
        if (!prim->unread.empty())
            text += fmt::format("{}{} of '{}'", text.empty() ? "" : ", ", fmt::join(prim->unread, ", "),
                                printable(prim->name));
    return text.empty() ? text : text + " are not followed";
}

UsdStage parse_usda(std::string_view text, const std::string& file) {
    if (text.starts_with("PXR-USDC") || text.starts_with("PK\x03\x04"))
        bad_input(file, "USD as text (usdcat FILE -o FILE.usda makes it)", "a binary file");
    return Parser(text, file).stage();
}

}  // namespace astrosplat
