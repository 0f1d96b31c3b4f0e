// toml++ behind four functions. Its messages become one line in the style of ours.
#include "scene/toml_read.h"

#include <fmt/format.h>

#include "core/error.h"
#include "scene/parameter.h"

namespace astrosplat {

/// "Error while parsing key-value pair: cannot redefine existing integer 'a'" -> "duplicate key 'a'"; other
/// messages lose their head.
static std::string plain_words(std::string message) {
    const std::string redefined = "cannot redefine existing ";
    if (const std::size_t at = message.find(redefined); at != std::string::npos) {
        const std::size_t open = message.find('\'', at);
        const std::size_t close = open == std::string::npos ? open : message.find('\'', open + 1);
        if (close != std::string::npos)
            return fmt::format("duplicate key '{}'", message.substr(open + 1, close - open - 1));
    }
    const std::string head = "Error while parsing ";
    if (message.rfind(head, 0) == 0) message = message.substr(head.size());
    if (!message.empty() && message[0] == 'E') message[0] = 'e';
    for (char& c : message)
        if (c == '\n' || c == '\r') c = ' ';
    return "not valid TOML: " + message;
}

toml::table parse_toml(const std::string& text, const std::string& name) {
    try {
        return toml::parse(std::string_view(text), std::string_view(name));
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}: {}", place_of(name, error.source()),
                                     plain_words(std::string(error.description()))));
    }
}

std::string place_of(const std::string& name, const toml::source_region& source) {
    return source.begin.line > 0 ? fmt::format("{}:{}", name, source.begin.line) : name;
}

std::string kind_of(const toml::node& node) {
    if (node.is_table()) return "a table";
    if (node.is_date() || node.is_time() || node.is_date_time()) return "a date";
    if (list_of_tables(node)) return "a list of tables";
    if (const auto* array = node.as_array()) return fmt::format("a list of {}", array->size());
    return kind_of(value_of(node));
}

Value value_of(const toml::node& node) {
    if (const auto* b = node.as_boolean()) return b->get();
    if (const auto* i = node.as_integer()) return i->get();
    if (const auto* d = node.as_floating_point()) return d->get();
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* array = node.as_array()) {
        Value::List list;
        for (const toml::node& element : *array) list.push_back(value_of(element));
        return list;
    }
    throw ValueError(fmt::format("expected a value, found {}", kind_of(node)));
}

const toml::array* list_of_tables(const toml::node& node) {
    const toml::array* array = node.as_array();
    return array && array->is_array_of_tables() ? array : nullptr;
}

}  // namespace astrosplat
