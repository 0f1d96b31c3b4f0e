#include <fmt/format.h>

#include <pugixml.hpp>

#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/packed_file.h"
#include "source/file_tables.h"

namespace astrosplat {
namespace {

struct Document {
    std::string text, name;
    pugi::xml_document xml;  // into the text
};

// Without the prefix of a namespace.
std::string_view local_name(const pugi::xml_node& node) {
    const std::string_view name = node.name();
    return name.substr(name.find(':') + 1);
}

pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name) {
    return node.find_child([&](const pugi::xml_node& child) { return local_name(child) == name; });
}

struct FieldType {
    std::string_view name;
    std::size_t bits;
};
constexpr FieldType field_types[] = {{"double", 64}, {"float", 32},        {"long", 64},
                                     {"int", 32},    {"short", 16},        {"unsignedByte", 8},
                                     {"char", 8},    {"unicodeChar", 16},  {"boolean", 8},
                                     {"bit", 1},     {"floatComplex", 64}, {"doubleComplex", 128}};
constexpr std::ptrdiff_t of_numbers = 6, of_single = 8;  // the first so many

class VoTable final : public RowTable {
  public:
    VoTable(std::shared_ptr<const Document> document, const pugi::xml_node& table)
        : document_(std::move(document)), data_(child_of(table, "DATA")) {
        for (const pugi::xml_node& node : table)
            if (local_name(node) == "FIELD") add(node);
        fields_.resize(columns_.size());
        texts_.resize(columns_.size());
    }

    bool next() override {
        if (row_++ == 0) begin();
        return binary_ ? next_binary() : next_cells();
    }
    std::int64_t line() const override { return row_; }
    std::string_view field(int column) const override {
        if (column < 0) return {};
        const auto i = std::size_t(column);
        if (binary_) texts_[i] = text_of(types_[i], fields_[i]);
        const std::string_view field = binary_ ? std::string_view(texts_[i]) : fields_[i];
        return field == types_[i].none ? std::string_view() : field;
    }

  private:
    struct Type {
        FieldType of = {};
        bool variable = false;
        std::int64_t count = 1;  // where it does not vary
        std::string none;        // how it writes that there is nothing
    };

    [[noreturn]] void fail(std::string_view expected, std::string_view found) const {
        bad_input(document_->name, row_ > 0 ? fmt::format("row {}", row_) : "", expected, found);
    }

    void add(const pugi::xml_node& field) {
        Type type;
        const std::string_view datatype = field.attribute("datatype").value();
        const auto known = std::ranges::find(field_types, datatype, &FieldType::name);
        if (known == std::end(field_types)) fail("a FIELD of a datatype of VOTable", shown(datatype));
        type.of = *known;
        type.none = child_of(field, "VALUES").attribute("null").value();
        std::string size = field.attribute("arraysize").value();
        type.variable = size.ends_with('*');
        if (type.variable) size.pop_back();
        for (std::size_t begin = 0, end = 0; begin < size.size() && !type.variable; begin = end + 1) {
            end = std::min(size.find('x', begin), size.size());
            const auto side = parse_int64(std::string_view(size).substr(begin, end - begin));
            if (!side || *side < 0 || *side > INT32_MAX || (type.count *= *side) > INT32_MAX)
                fail("an arraysize", shown(size));
        }
        const std::ptrdiff_t kind = known - field_types;
        const bool number = kind < of_numbers && !type.variable && type.count == 1;
        columns_.push_back({number || (kind >= of_numbers && kind < of_single)
                                ? lower_case(field.attribute("name").value())
                                : "",
                            field.attribute("unit").value(), lower_case(field.attribute("ucd").value())});
        types_.push_back(std::move(type));
    }

    void begin() {
        const pugi::xml_node cells = child_of(data_, "TABLEDATA");
        const pugi::xml_node two = child_of(data_, "BINARY2"), one = child_of(data_, "BINARY");
        const pugi::xml_node stream = child_of(two ? two : one, "STREAM");
        row_ = 0;
        if (stream.attribute("href"))
            fail("data in the document itself", "a STREAM of " + shown(stream.attribute("href").value()));
        if (!cells && !stream && data_) fail("TABLEDATA, BINARY or BINARY2", "none");
        row_ = 1;
        if (stream) read(stream.text().get());
        if (stream.attribute("encoding").value() == std::string_view("gzip"))
            bytes_ = unpacked(std::move(bytes_), document_->name);
        binary_ = bool(stream);
        flags_ = two ? (columns_.size() + 7) / 8 : 0;
        cell_ = cells.first_child();
    }

    void read(std::string_view text) {
        claim_memory(2 * std::ssize(text), fmt::format("reading {}", document_->name));
        std::string plain;
        plain.reserve(text.size());
        for (const char c : text)
            if (!std::isspace(static_cast<unsigned char>(c))) plain += c;
        std::optional<std::string> bytes = bytes_of_base64(plain);
        if (!bytes) fail("a STREAM in base64", "something else");
        bytes_ = std::move(*bytes);
    }

    bool next_cells() {
        while (cell_ && local_name(cell_) != "TR") cell_ = cell_.next_sibling();
        if (!cell_) return false;
        std::size_t i = 0;
        for (pugi::xml_node td = cell_.first_child(); td && i < fields_.size(); td = td.next_sibling())
            if (local_name(td) == "TD") fields_[i++] = trim(td.child_value());
        std::fill(fields_.begin() + std::ptrdiff_t(i), fields_.end(), std::string_view());
        cell_ = cell_.next_sibling();
        return true;
    }

    std::string_view take(std::size_t size) {
        if (size > bytes_.size() - at_) fail("data of whole rows", "their end");
        return std::string_view(bytes_).substr(std::exchange(at_, at_ + size), size);
    }

    bool next_binary() {
        if (at_ == bytes_.size()) return false;
        const std::size_t before = at_;
        const std::string_view flags = take(flags_);
        for (std::size_t i = 0; i < fields_.size(); ++i) {
            const Type& type = types_[i];
            const std::uint64_t count = type.variable ? number_of(take(4)) : std::uint64_t(type.count);
            fields_[i] = take((count * type.of.bits + 7) / 8);
            const bool is_null = flags_ > 0 && (std::uint8_t(flags[i / 8]) >> (7 - i % 8) & 1U) != 0;
            if (is_null) fields_[i] = {};
        }
        if (at_ == before) fail("rows of a size", "rows of no bytes");
        return true;
    }

    // The highest byte first.
    static std::uint64_t number_of(std::string_view bytes) {
        std::uint64_t number = 0;
        for (const char byte : bytes) number = number << 8 | std::uint8_t(byte);
        return number;
    }

    static std::string text_of(const Type& type, std::string_view bytes) {
        if (bytes.empty()) return {};
        const std::string_view name = type.of.name;
        std::string text;
        const std::size_t step = type.of.bits / 8;
        if (name == "char" || name == "unicodeChar") {
            for (std::size_t i = step - 1; i < bytes.size() && bytes[i] != '\0'; i += step) text += bytes[i];
            return text;
        }
        const std::uint64_t bits = number_of(bytes);
        const double real = name == "double"  ? std::bit_cast<double>(bits)
                            : name == "float" ? double(std::bit_cast<float>(std::uint32_t(bits)))
                            : name == "unsignedByte"
                                ? double(bits)
                                : double(std::int64_t(bits << (64 - type.of.bits)) >> (64 - type.of.bits));
        return std::isnan(real) ? "" : shortest(real);
    }

    std::shared_ptr<const Document> document_;
    pugi::xml_node data_, cell_;
    std::vector<Type> types_;
    std::vector<std::string_view> fields_;  // of this row: cells, or bytes
    mutable std::vector<std::string> texts_;
    std::string bytes_;
    std::size_t at_ = 0, flags_ = 0;  // bytes: of the next row, and before each
    std::int64_t row_ = 0;
    bool binary_ = false;
};

struct TableFinder : pugi::xml_tree_walker {
    std::vector<pugi::xml_node> tables;
    std::string unfollowed;

    bool for_each(pugi::xml_node& node) override {
        const auto said = [&](const char* name) { return lower_case(node.attribute(name).value()); };
        if (local_name(node) == "TABLE") tables.push_back(node);
        if (local_name(node) == "COOSYS" && said("system").find("icrs") == std::string::npos &&
            !(said("system").ends_with("fk5") && is_equinox_2000(said("equinox"))))
            unfollowed = fmt::format("coordinate system {} {} is not followed: places are taken for ICRS",
                                     shown(said("system")), printable(said("equinox")));
        if (local_name(node) == "PARAM" && said("name") == "equinox" && !is_equinox_2000(said("value")))
            unfollowed = fmt::format("EQUINOX = {} is not followed: places are taken for ICRS",
                                     printable(node.attribute("value").value()));
        if (said("name") == "query_status" && said("value") == "overflow")
            unfollowed = "QUERY_STATUS is OVERFLOW: rows are missing, the service left them out";
        return true;
    }
};

}  // namespace

bool is_votable(std::string_view text) {
    text = text.substr(0, std::size_t{1} << 16);
    if (text.find('<') > 4) return false;  // behind a byte order mark
    const std::size_t at = text.find("VOTABLE");
    return at != text.npos && (text[at - 1] == '<' || text[at - 1] == ':');
}

std::vector<FileTable> votables(std::string text, const std::string& name, const Progress& progress) {
    const auto document = std::make_shared<Document>();
    constexpr std::int64_t node_bytes = 64;  // an element or a text, each at a '<'
    claim_memory(node_bytes * std::ranges::count(text, '<'), fmt::format("reading {}", name));
    document->text = std::move(text);
    document->name = name;
    const pugi::xml_parse_result parsed = document->xml.load_buffer_inplace(
        document->text.data(), document->text.size(), pugi::parse_default | pugi::parse_embed_pcdata);
    if (!parsed) bad_input(name, fmt::format("byte {}", parsed.offset), "XML", parsed.description());
    progress.check();
    TableFinder finder;
    document->xml.traverse(finder);
    if (!finder.unfollowed.empty())
        log_warning(fmt::format("{}: its {}", printable(name), finder.unfollowed));
    std::vector<FileTable> tables;
    for (const pugi::xml_node& node : finder.tables)
        tables.push_back({fmt::format("table {}", shown(node.attribute("name").value())),
                          std::make_unique<VoTable>(document, node)});
    return tables;
}

}  // namespace astrosplat
