// Parsing of TOML, with toml++'s messages as one line in the style of ours; and entries into parameters, with
// every message that a wrong entry can cause.
#include "scene/entries.h"

#include <fmt/format.h>

#include <charconv>

#include "core/error.h"
#include "scene/describe.h"
#include "scene/parameter_key.h"

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

toml::table parse_toml(const std::string& text, const std::string& name) try {
    return toml::parse(std::string_view(text), std::string_view(name));
} catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}: {}", place_of(name, error.source()), plain_words(std::string(error.description()))));
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

namespace {

std::vector<std::string> known_keys(const ParameterKey& layer_group) {
    std::vector<std::string> keys;
    for (const ParameterRow& row : parameter_rows()) {
        const ParameterKey& key = row.spec.key;
        if (key.is_below("layer"))
            keys.push_back(key.moved("layer", layer_group));
        else if (!layer_group.empty())
            keys.push_back(key);
    }
    return keys;
}

/// "unknown key 'x'; did you mean 'y'?" for a key that no parameter has. `shown` is as the person wrote it.
std::string unknown_key(const std::string& shown, const ParameterKey& key, const ParameterKey& layer_group) {
    const std::string hint = did_you_mean(key, known_keys(layer_group));
    return fmt::format("unknown key '{}'{}", shown,
                       hint.empty() ? "; 'astrosplat parameters' lists all keys" : hint);
}

/// As written below its [section]: 'alpha.powr'.
std::string shown_key(const Entry& entry, const EntryOrigin& origin) {
    if (origin.command_line) return entry.key;
    return std::string(entry.generic_key.below(section_of(entry.generic_key)));
}

[[noreturn]] void fail(const Entry& entry, const std::string& message) {
    throw InputError(fmt::format("{}: {}", entry.place, message));
}

[[noreturn]] void fail_value(const Entry& entry, const EntryOrigin& origin, const std::string& message) {
    fail(entry, fmt::format("{}: {}", origin.command_line ? entry.key : entry.generic_key, message));
}

const ParameterList* list_at(const Description& description, const ParameterKey& key) {
    const ParameterKey full = full_key(description, key);
    for (const ParameterList& list : description.lists)
        if (list.key == full) return &list;
    return nullptr;
}

/// Whether `key` names something that has parameters below it, such as layer.look.alpha.
bool is_group(const Description& description, const ParameterKey& key) {
    const auto below = [&](const ParameterKey& known) { return known == key || known.is_below(key); };
    return std::ranges::any_of(description.parameters,
                               [&](const Parameter& p) { return below(p.spec.key); }) ||
           std::ranges::any_of(description.lists, [&](const ParameterList& l) { return below(l.key); });
}

/// Sets the length that a list, or an element of one, asks for. What lies within is there to be described
/// after that, so `description` is made again.
void set_list_length(Description& description, const Entry& entry, const EntryOrigin& origin,
                     const std::function<Description()>& describe_target) {
    const ParameterList* list = list_at(description, entry.key);
    if (list && entry.kind == Entry::Kind::list) {
        list->resize(0);  // a list replaces what a preset said
        list->resize(entry.node->as_array()->size());
        description = describe_target();
    } else if (list && entry.kind == Entry::Kind::leaf) {
        const toml::array* array = entry.node->as_array();
        if (!array || !array->empty())
            fail_value(entry, origin,
                       fmt::format("expected a table or a list of tables, found {}", kind_of(*entry.node)));
        list->resize(0);
        description = describe_target();
    } else if (entry.kind != Entry::Kind::list) {
        // A single table in place of a list is its first element.
        const ParameterKey key = entry.kind == Entry::Kind::table ? entry.key / 0 : entry.key;
        try {
            while (extend_lists(description, key)) description = describe_target();
        } catch (const ValueError& error) {
            fail_value(entry, origin, error.what());
        }
    }
}

/// A parameter below a group that was given one value, as an example: the one that takes this value,
/// or the first.
std::string example_below(const Entry& entry, const EntryOrigin& origin, const Description& description) {
    const auto* given = entry.node->as_string();
    std::string first;
    for (const Parameter& parameter : description.parameters) {
        const ParameterSpec& spec = parameter.spec;
        if (!spec.key.is_below(entry.key)) continue;
        const ParameterKey& key = origin.command_line ? spec.key : spec.generic_key;
        if (first.empty()) first = fmt::format("; it has keys such as {}", key);
        if (!given || std::ranges::find(spec.choices, given->get()) == spec.choices.end()) continue;
        const std::string value = origin.command_line ? "=" + given->get() : " = " + to_toml(given->get());
        return fmt::format("; did you mean {}{}?", key, value);
    }
    return first;
}

[[noreturn]] void fail_unknown(const Entry& entry, const EntryOrigin& origin,
                               const Description& description) {
    if (is_group(description, entry.key) && entry.kind != Entry::Kind::table)
        fail_value(entry, origin,
                   fmt::format("expected a table, found {}{}", kind_of(*entry.node),
                               example_below(entry, origin, description)));
    for (ParameterKey key = entry.key.parent(); !key.empty(); key = key.parent()) {
        if (const Parameter* parameter = find_parameter(description, key))
            fail(entry, fmt::format("{}: expected {}, found a table",
                                    origin.command_line ? parameter->spec.key : parameter->spec.generic_key,
                                    expectation(parameter->spec)));
    }
    const ParameterKey& key = origin.command_line ? entry.key : entry.generic_key;
    fail(entry, unknown_key(shown_key(entry, origin), key, origin.layer_group));
}

/// --set may leave out the quotes; then numbers and dates are text too where text is wanted.
Value entry_value(const Entry& entry, const ParameterSpec& spec) {
    const bool textual = spec.type == ParameterType::text || spec.type == ParameterType::file ||
                         spec.type == ParameterType::pattern || spec.type == ParameterType::files;
    if (entry.raw && textual && !entry.node->is_string() && !entry.node->is_array()) return *entry.raw;
    return value_of(*entry.node);
}

/// "0,0,5" and "[depth]" as the lists they were meant to be: with brackets, and with quotes around words.
std::string as_list(std::string_view raw) {
    if (raw.starts_with('[') && raw.ends_with(']')) raw = raw.substr(1, raw.size() - 2);
    std::string list;
    while (!raw.empty()) {
        const std::size_t comma = raw.find(',');
        std::string part(raw.substr(0, comma));
        std::erase(part, ' ');
        const bool is_word = part.find_first_not_of("+-.0123456789eE") != std::string::npos;
        list += (list.empty() ? "" : ", ") + (is_word && part.front() != '"' ? to_toml(part) : part);
        raw.remove_prefix(comma == std::string_view::npos ? raw.size() : comma + 1);
    }
    return "[" + list + "]";
}

/// A hint for text typed where a list was expected, if it would do as a list.
std::string list_hint(const Entry& entry, const Parameter& parameter) {
    if (!entry.raw || !entry.node->is_string()) return "";
    const std::string list = as_list(*entry.raw);
    try {
        parameter.set(value_of(*parse_toml("value = " + list, "").get("value")));
    } catch (const InputError&) {
        return "";
    }
    return fmt::format("; did you mean --set '{}={}'?", entry.key, list);
}

void set_leaf(const Description& description, const Entry& entry, const EntryOrigin& origin) {
    const Parameter* parameter = find_parameter(description, entry.key);
    if (!parameter) fail_unknown(entry, origin, description);
    try {
        const Value value = entry_value(entry, parameter->spec);
        parameter->set(resolve_paths(value, parameter->spec, origin.folder, origin.command_line));
    } catch (const ValueError& error) {
        fail_value(entry, origin, error.what() + list_hint(entry, *parameter));
    }
}

/// Of an unknown table its first key is reported; of an empty one the table itself.
void check_table(const Description& description, const Entry& entry, const EntryOrigin& origin,
                 const std::vector<Entry>& entries) {
    if (is_group(description, full_key(description, entry.key)) || is_group(description, entry.key)) return;
    const bool has_children =
        std::ranges::any_of(entries, [&](const Entry& other) { return other.key.is_below(entry.key); });
    if (!has_children) fail_unknown(entry, origin, description);
}

void add_children(const toml::table& table, const Entry& parent, const EntryOrigin& origin,
                  std::vector<Entry>& entries) {
    for (const auto& [key, node] : table) {
        // A quoted "look.alpha" is one key with a dot in its name, which nothing has.
        const std::string name = key.str().find('.') == std::string_view::npos
                                     ? std::string(key.str())
                                     : fmt::format("\"{}\"", key.str());
        flatten(node, parent.key / name, parent.generic_key / name, origin, key.source(), entries);
    }
}

}  // namespace

std::string why_unknown(const Scene& scene, const ParameterKey& key) {
    if (!key.is_below("layer")) return unknown_key(key, key, "layer");
    const std::string name = key.layer();
    const std::vector<std::string> names = layer_names(scene);
    if (std::ranges::find(names, name) != names.end()) return unknown_key(key, key, layer_key(name));
    return fmt::format("{}: unknown layer '{}'{}", key, name, did_you_mean(name, names));
}

void flatten(const toml::node& node, const ParameterKey& key, const ParameterKey& generic_key,
             const EntryOrigin& origin, const toml::source_region& source, std::vector<Entry>& entries) {
    Entry entry{Entry::Kind::leaf, key,   generic_key, place_of(origin.name, source),
                source.begin,      &node, nullptr};
    if (node.is_table()) entry.kind = Entry::Kind::table;
    if (list_of_tables(node)) entry.kind = Entry::Kind::list;
    if (!key.empty()) entries.push_back(entry);
    if (node.is_table()) add_children(*node.as_table(), entry, origin, entries);
    if (entry.kind != Entry::Kind::list) return;
    std::size_t index = 0;
    for (const toml::node& element : *node.as_array())
        flatten(element, key / index++, generic_key, origin, element.source(), entries);
}

bool extend_lists(const Description& description, const ParameterKey& key) {
    const ParameterKey full = full_key(description, key);
    for (const ParameterList& list : description.lists) {
        if (!full.is_below(list.key)) continue;
        const std::string_view rest = full.below(list.key);
        std::size_t index = 0;
        const auto [end, problem] = std::from_chars(rest.data(), rest.data() + rest.size(), index);
        if (problem != std::errc() || index > list.size())
            throw ValueError(fmt::format("expected an index of at most {} in {}, found {}", list.size(),
                                         list.generic_key, std::string(rest.data(), end)));
        if (index < list.size()) continue;
        list.resize(index + 1);
        return true;
    }
    return false;
}

void apply_entries(std::vector<Entry> entries, const EntryOrigin& origin,
                   const std::function<Description()>& describe_target, Places& places) {
    std::ranges::stable_sort(entries, {}, &Entry::position);
    Description description = describe_target();
    for (const Entry& entry : entries) set_list_length(description, entry, origin, describe_target);
    for (const Entry& entry : entries) {
        const bool list = list_at(description, entry.key) != nullptr;
        if (entry.kind == Entry::Kind::leaf && !list) set_leaf(description, entry, origin);
        if (entry.kind != Entry::Kind::leaf && !list) check_table(description, entry, origin, entries);
        places[full_key(description, entry.key)] = entry.place;
    }
}

}  // namespace astrosplat
