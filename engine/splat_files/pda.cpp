// Maya's particle files (formats.h). The header is read word by word, so line breaks and blanks in it do not
// matter; the data line by line.
#include "splat_files/formats.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"
#include "splat_files/file_bytes.h"
#include "splat_files/number_text.h"
#include "splat_files/splat_table.h"

namespace astrosplat {
namespace {

/// The header's words, with the line each stands on.
class Words {
  public:
    Words(const fs::path& file, std::string_view text) : file_(file.string()), text_(text) {
        if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;  // byte order mark
    }

    /// The next word; empty at the end of the file.
    std::string_view next() {
        for (; at_ < text_.size() && scan::is_space(text_[at_]); ++at_) line_ += text_[at_] == '\n';
        const std::size_t begin = at_;
        while (at_ < text_.size() && !scan::is_space(text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }
    void expect(std::string_view keyword) {
        const std::string_view word = next();
        if (word != keyword) fail(fmt::format("'{}'", keyword), word);
    }
    [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
        bad_input(file_, std::to_string(line_), expected,
                  found.empty() ? "the end of the file" : quoted(found));
    }
    /// The text behind the line of the last word, which must end there.
    std::string_view rest() {
        while (at_ < text_.size() && scan::is_blank(text_[at_])) ++at_;
        if (at_ < text_.size() && text_[at_] != '\n') fail("nothing behind 'BEGIN DATA' on its line", next());
        return text_.substr(std::min(at_ + 1, text_.size()));
    }
    std::int64_t line() const { return line_; }

  private:
    std::string file_;
    std::string_view text_;
    std::size_t at_ = 0;
    std::int64_t line_ = 1;
};

struct Attribute {
    std::string name;
    char type = 'R';  // I, R or V
};

struct PdaHeader {
    std::vector<Attribute> attributes;
    std::uint64_t particles = 0;
    std::string_view data;
    std::int64_t data_line = 0;  // the file's line where data begins
};

/// An attribute that becomes a column of the SplatSet.
struct KnownAttribute {
    std::string_view name;
    std::string_view types;
    SplatColumn column;
};
constexpr KnownAttribute known_attributes[] = {
    {"position", "V", SplatColumn::position}, {"rgbPP", "V", SplatColumn::color},
    {"opacityPP", "R", SplatColumn::alpha},   {"DistanceFromSurfaceMeshPP", "R", SplatColumn::distance},
    {"radiusPP", "R", SplatColumn::radius},   {"whichMeshPP", "IR", SplatColumn::mesh},
    {"particleId", "IR", SplatColumn::id},    {"id", "IR", SplatColumn::id},
};

const KnownAttribute* find_known(std::string_view name) {
    const auto* const found = std::ranges::find(known_attributes, name, &KnownAttribute::name);
    return found == std::end(known_attributes) ? nullptr : found;
}

bool has_attribute(const std::vector<Attribute>& attributes, std::string_view name) {
    return std::ranges::any_of(attributes, [&](const Attribute& a) { return a.name == name; });
}

void read_attributes(Words& words, std::vector<Attribute>& attributes) {
    for (std::string_view word = words.next(); word != "TYPES"; word = words.next()) {
        if (word.empty()) words.fail("'TYPES'", word);
        if (has_attribute(attributes, word)) words.fail("each attribute once", word);
        attributes.push_back({std::string(word), 'R'});
    }
}

void read_types(Words& words, std::vector<Attribute>& attributes) {
    for (Attribute& attribute : attributes) {
        const std::string_view type = words.next();
        if (type != "I" && type != "R" && type != "V")
            words.fail(fmt::format("type I, R or V of attribute {}", attribute.name), type);
        attribute.type = type[0];
        const KnownAttribute* known = find_known(attribute.name);
        if (known && known->types.find(attribute.type) == known->types.npos)
            words.fail(fmt::format("type {} of attribute {}", known->types == "IR" ? "I or R" : known->types,
                                   attribute.name),
                       type);
    }
    if (!has_attribute(attributes, "position")) words.fail("an attribute position", "none");
}

/// "NUMBER_OF_PARTICLES: 30", with or without the colon, and with or without blanks around it.
std::uint64_t read_particle_count(Words& words) {
    constexpr std::string_view keyword = "NUMBER_OF_PARTICLES";
    std::string_view word = words.next();
    if (word.substr(0, keyword.size()) != keyword) words.fail("'NUMBER_OF_PARTICLES:'", word);
    word.remove_prefix(keyword.size());
    if (word.empty()) word = words.next();
    if (!word.empty() && word[0] == ':') word.remove_prefix(1);
    if (word.empty()) word = words.next();
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size()) words.fail("a number of particles", word);
    return count;
}

PdaHeader read_header(const fs::path& file, std::string_view text) {
    PdaHeader header;
    Words words(file, text);
    words.expect("ATTRIBUTES");
    read_attributes(words, header.attributes);
    read_types(words, header.attributes);
    header.particles = read_particle_count(words);
    words.expect("BEGIN");
    words.expect("DATA");
    header.data = words.rest();
    header.data_line = words.line() + 1;
    return header;
}

std::vector<Column> columns_of(const std::vector<Attribute>& attributes) {
    std::vector<Column> columns;
    for (const Attribute& attribute : attributes) {
        const KnownAttribute* known = find_known(attribute.name);
        if (attribute.name == "id" && has_attribute(attributes, "particleId")) known = nullptr;
        for (int component = 0; component < (attribute.type == 'V' ? 3 : 1); ++component) {
            Column column;
            column.name = attribute.name;
            if (known) column.field = Field{known->column, component};
            columns.push_back(column);
        }
    }
    return columns;
}

constexpr std::size_t longest_number = float_text_room;  // a whole number has 20 digits at most

char* put_text(char* out, float value) { return put_float(out, value); }
char* put_text(char* out, std::uint64_t value) { return std::to_chars(out, out + longest_number, value).ptr; }

/// The longest row: nine floats, a mesh, an id, blanks and the newline.
constexpr std::size_t longest_row = 11 * (longest_number + 1);

char* put_row(char* out, const SplatSet& set, std::int64_t i) {
    const auto put = [&](const auto&... numbers) { ((out = put_text(out, numbers), *out++ = ' '), ...); };
    const glm::vec3 &p = set.position[i], &c = set.color[i];
    put(p.x, p.y, p.z, c.x, c.y, c.z, set.alpha[i], set.distance[i]);
    if (!set.mesh.empty()) put(std::uint64_t{set.mesh[i]});
    if (!set.radius.empty()) put(set.radius[i]);
    out = put_text(out, set.id[i]);
    *out++ = '\n';
    return out;
}

std::string header_text(const SplatSet& set) {
    std::string names = " position rgbPP opacityPP DistanceFromSurfaceMeshPP", types = " V V R R";
    if (!set.mesh.empty()) names += " whichMeshPP", types += " I";
    if (!set.radius.empty()) names += " radiusPP", types += " R";
    return fmt::format("ATTRIBUTES\n{} particleId\nTYPES\n{} I\nNUMBER_OF_PARTICLES: {}\nBEGIN DATA\n", names,
                       types, set.size());
}

SplatSet read_pda_bytes(const fs::path& file, std::string_view bytes, const Progress& progress) {
    const PdaHeader header = read_header(file, bytes);
    const SplitRows rows = split_rows(header.data, header.data_line);
    if (std::uint64_t(rows.rows) != header.particles)
        bad_input(file, fmt::format("{} rows, as NUMBER_OF_PARTICLES says", header.particles),
                  std::to_string(rows.rows));
    SplatTable table;
    table.columns = columns_of(header.attributes);
    open_table(table, rows.rows, file);
    read_text_rows(rows, 0, rows.rows, table, file, progress);
    return finish_table(table, file);
}

}  // namespace

SplatColumns pda_columns(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        return columns_held(columns_of(read_header(file, bytes).attributes));
    });
}

std::int64_t pda_splat_count(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) {
        constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
        return std::int64_t(std::min(most, read_header(file, bytes).particles));
    });
}

SplatSet read_pda(const fs::path& file, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) { return read_pda_bytes(file, bytes, progress); });
}

void write_pda(const WriteTarget& target, const SplatSet& set, const Progress& progress) {
    check_consistent(set);
    constexpr std::int64_t rows = 16384;  // about 1 MiB of text
    write_rows(target, header_text(set), set.size(), rows, longest_row, progress,
               [&](char* out, std::int64_t i) { return put_row(out, set, i); });
}

}  // namespace astrosplat
