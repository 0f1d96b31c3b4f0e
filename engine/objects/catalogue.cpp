// Names are compared as runs of letters and runs of digits, so that blanks, hyphens, zeros in front and
// capitals do not matter.
#include "objects/catalogue.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"

namespace astrosplat {
namespace {

using Tokens = std::vector<std::string>;

// Bytes of other alphabets count as letters.
Tokens tokens_of(std::string_view text) {
    enum class Class { none, letter, digit };
    Tokens tokens;
    Class last = Class::none;
    for (const char c : lower_case(std::string(text))) {
        const bool letter = (c >= 'a' && c <= 'z') || (static_cast<unsigned char>(c) & 0x80U) != 0;
        const Class here = c >= '0' && c <= '9' ? Class::digit : letter ? Class::letter : Class::none;
        if (here != Class::none) {
            if (here != last) tokens.emplace_back();
            if (tokens.back() == "0") tokens.back().clear();
            tokens.back() += c;
        }
        if (c != '\'') last = here;  // "cat's eye" is "cats eye"
    }
    return tokens;
}

struct Spelling {
    const char *full, *brief;
};
constexpr Spelling spellings[] = {{"messier", "m"}, {"caldwell", "c"}, {"sharpless", "sh"}, {"barnard", "b"}};

// Of catalogues with two spellings the brief one; Sharpless' second list is the one that is meant.
Tokens key_of(std::string_view name) {
    Tokens tokens = tokens_of(name);
    if (tokens.size() < 2) return tokens;
    for (const Spelling& spelling : spellings)
        if (tokens[0] == spelling.full) tokens[0] = spelling.brief;
    if (tokens[0] == "sh" && tokens.size() == 2) tokens.insert(tokens.begin() + 1, "2");
    return tokens;
}

struct NamedKey {
    Tokens key;
    const CatalogueObject* object;
};

std::vector<NamedKey> keys_of(const std::vector<CatalogueObject>& objects) {
    std::vector<NamedKey> keys;
    for (const CatalogueObject& object : objects)
        for (const std::string& name : object.names) keys.push_back({key_of(name), &object});
    return keys;
}

const std::vector<NamedKey>& catalogue_keys() {
    static const std::vector<NamedKey> keys = keys_of(object_catalogue());
    return keys;
}

bool is_number(const std::string& token) { return token.front() >= '0' && token.front() <= '9'; }

// Whether a name says what it means in the middle of other words: not "C 14", "B 33" or "Ring".
bool is_telling(const Tokens& key) {
    constexpr std::size_t telling_word = 6;  // letters
    if (key.size() == 1) return key[0].size() >= telling_word && !is_number(key[0]);
    return key[0].size() > 1 || key[0] == "m";
}

bool stands_at(const Tokens& text, std::size_t place, const Tokens& key) {
    return place + key.size() <= text.size() &&
           std::equal(key.begin(), key.end(), text.begin() + static_cast<std::ptrdiff_t>(place));
}

// With the brief spellings of catalogues that are named in full.
Tokens searched_tokens(std::string_view text) {
    Tokens tokens = tokens_of(text);
    for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
        if (tokens[i] == "messier" && is_number(tokens[i + 1])) tokens[i] = "m";
        if (tokens[i] == "sharpless" && is_number(tokens[i + 1])) tokens[i] = "sh";
    }
    return tokens;
}

std::optional<double> number_or_none(const TextRows& row, std::string_view field, std::string_view what) {
    return field.empty() ? std::nullopt : std::optional(row.number(field, what));
}

ObjectKind kind_named(const TextRows& row, std::string_view name) {
    constexpr auto names = names_of(ObjectKind{});
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) row.fail(alternatives(all_names<ObjectKind>()), shown(name));
    return static_cast<ObjectKind>(found - names.begin());
}

std::vector<std::string> names_in(std::string_view field) {
    std::vector<std::string> names;
    for (std::size_t end = 0; end != std::string_view::npos;
         field.remove_prefix(std::min(field.size(), end + 1))) {
        end = field.find(';');
        names.emplace_back(trim(field.substr(0, end)));
    }
    return names;
}

constexpr std::string_view columns =
    "names,kind,right_ascension_deg,declination_deg,major_arcmin,minor_arcmin,position_angle_deg,inclination_"
    "deg,"
    "distance_ly,source";

CatalogueObject object_of(const TextRows& row, const std::vector<std::string_view>& fields) {
    constexpr std::size_t count = 10;
    if (fields.size() != count) row.fail("10 fields", fmt::format("{}", fields.size()));
    CatalogueObject object;
    object.names = names_in(fields[0]);
    object.kind = kind_named(row, fields[1]);
    if (object.names.empty() || object.names.front().empty()) row.fail("a name", "none");
    object.right_ascension_deg = row.number(fields[2], "the right ascension");
    object.declination_deg = row.number(fields[3], "the declination");
    object.major_arcmin = number_or_none(row, fields[4], "the major axis");
    object.minor_arcmin = number_or_none(row, fields[5], "the minor axis");
    object.position_angle_deg = number_or_none(row, fields[6], "the position angle");
    object.inclination_deg = number_or_none(row, fields[7], "the inclination");
    object.distance_ly = number_or_none(row, fields[8], "the distance");
    object.source = fields[9];
    return object;
}

}  // namespace

std::vector<CatalogueObject> parse_catalogue(std::string_view text, const std::string& file) {
    TextRows rows(text, file);
    if (!rows.next() || rows.text() != columns) rows.fail(std::string(columns), shown(rows.text()));
    std::vector<CatalogueObject> objects;
    while (rows.next()) objects.push_back(object_of(rows, rows.fields(',')));
    return objects;
}

const std::vector<CatalogueObject>& object_catalogue() {
    static const std::vector<CatalogueObject> objects = []() -> std::vector<CatalogueObject> {
        const std::filesystem::path folder = assets_folder("objects"), file = folder / "objects.csv";
        if (!folder.empty()) return parse_catalogue(read_file(file), file.string());
        log_info("the table of objects, assets/objects, is not there: names say nothing");
        return {};
    }();
    return objects;
}

const CatalogueObject* object_named(std::string_view name) {
    const Tokens key = key_of(name);
    for (const NamedKey& named : catalogue_keys())
        if (named.key == key) return named.object;
    return nullptr;
}

const CatalogueObject* object_in(std::string_view text) {
    const Tokens tokens = searched_tokens(text);
    for (std::size_t place = 0; place < tokens.size(); ++place) {
        const NamedKey* longest = nullptr;
        for (const NamedKey& named : catalogue_keys())
            if (is_telling(named.key) && stands_at(tokens, place, named.key) &&
                (!longest || named.key.size() > longest->key.size()))
                longest = &named;
        if (longest) return longest->object;
    }
    return nullptr;
}

}  // namespace astrosplat
