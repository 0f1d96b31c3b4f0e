// Entries into parameters, with every message a wrong entry can cause.
#include "scene/entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "core/error.h"
#include "scene/describe.h"
#include "scene/path_text.h"
#include "scene/suggest.h"

namespace astrosplat {
namespace {

bool begins_with(const std::string& text, const std::string& head) { return text.rfind(head, 0) == 0; }

std::vector<std::string> known_keys(const std::string& layer_prefix) {
    std::vector<std::string> keys;
    for (const ParameterRow& row : parameter_rows()) {
        const bool layer = begins_with(row.spec.key, "layer.");
        if (layer)
            keys.push_back(layer_prefix + row.spec.key.substr(6));
        else if (!layer_prefix.empty())
            keys.push_back(row.spec.key);
    }
    return keys;
}

/// As written below its [section]: 'alpha.powr'.
std::string shown_key(const Entry& entry, const EntryOrigin& origin) {
    if (origin.command_line) return entry.key;
    const std::string section = section_of(entry.generic_key);
    return section.empty() ? entry.generic_key : entry.generic_key.substr(section.size() + 1);
}

[[noreturn]] void fail(const Entry& entry, const std::string& message) {
    throw InputError(fmt::format("{}: {}", entry.place, message));
}

[[noreturn]] void fail_value(const Entry& entry, const EntryOrigin& origin, const std::string& message) {
    fail(entry, fmt::format("{}: {}", origin.command_line ? entry.key : entry.generic_key, message));
}

const ParameterList* list_at(const Description& description, const std::string& key) {
    for (const ParameterList& list : description.lists)
        if (list.key == key) return &list;
    return nullptr;
}

/// Whether `key` names something that has parameters below it, such as layer.look.alpha.
bool is_group(const Description& description, const std::string& key) {
    const auto below = [&](const std::string& known) {
        return known == key || begins_with(known, key + ".");
    };
    return std::any_of(description.parameters.begin(), description.parameters.end(),
                       [&](const Parameter& p) { return below(p.spec.key); }) ||
           std::any_of(description.lists.begin(), description.lists.end(),
                       [&](const ParameterList& l) { return below(l.key); });
}

void set_list_length(const Description& description, const Entry& entry, const EntryOrigin& origin) {
    const ParameterList* list = list_at(description, entry.key);
    if (list && entry.kind == Entry::Kind::list) {
        list->resize(0);  // a list replaces what a preset said
        list->resize(entry.node->as_array()->size());
    } else if (list && entry.kind == Entry::Kind::leaf) {
        const toml::array* array = entry.node->as_array();
        if (!array || !array->empty())
            fail_value(entry, origin,
                       fmt::format("expected a table or a list of tables, found {}", kind_of(*entry.node)));
        list->resize(0);
    } else if (entry.kind != Entry::Kind::list) {
        try {
            extend_lists(description, entry.kind == Entry::Kind::table ? entry.key + "." : entry.key);
        } catch (const ValueError& error) {
            fail_value(entry, origin, error.what());
        }
    }
}

[[noreturn]] void fail_unknown(const Entry& entry, const EntryOrigin& origin,
                               const Description& description) {
    if (is_group(description, entry.key) && entry.kind != Entry::Kind::table)
        fail_value(entry, origin, fmt::format("expected a table, found {}", kind_of(*entry.node)));
    for (std::size_t dot = entry.key.rfind('.'); dot != std::string::npos && dot > 0;
         dot = entry.key.rfind('.', dot - 1)) {
        if (const Parameter* parameter = find_parameter(description, entry.key.substr(0, dot)))
            fail(entry, fmt::format("{}: expected {}, found a table",
                                    origin.command_line ? parameter->spec.key : parameter->spec.generic_key,
                                    expectation(parameter->spec)));
    }
    const std::string& key = origin.command_line ? entry.key : entry.generic_key;
    fail(entry, unknown_key(shown_key(entry, origin), key, origin.layer_prefix));
}

/// --set may leave out the quotes; then numbers and dates are text too where text is wanted.
Value entry_value(const Entry& entry, const ParameterSpec& spec) {
    const bool textual = spec.type == ParameterType::text || spec.type == ParameterType::file ||
                         spec.type == ParameterType::pattern || spec.type == ParameterType::files;
    if (entry.raw && textual && !entry.node->is_string() && !entry.node->is_array()) return *entry.raw;
    return value_of(*entry.node);
}

void set_leaf(const Description& description, const Entry& entry, const EntryOrigin& origin) {
    const Parameter* parameter = find_parameter(description, entry.key);
    if (!parameter) fail_unknown(entry, origin, description);
    try {
        const Value value = entry_value(entry, parameter->spec);
        parameter->set(resolve_paths(value, parameter->spec, origin.folder, origin.command_line));
    } catch (const ValueError& error) {
        fail_value(entry, origin, error.what());
    }
}

/// Of an unknown table its first key is told; an empty one is told itself.
void check_table(const Description& description, const Entry& entry, const EntryOrigin& origin,
                 const std::vector<Entry>& entries) {
    if (is_group(description, full_key(description, entry.key)) || is_group(description, entry.key)) return;
    const bool has_children = std::any_of(entries.begin(), entries.end(), [&](const Entry& other) {
        return begins_with(other.key, entry.key + ".");
    });
    if (!has_children) fail_unknown(entry, origin, description);
}

void add_children(const toml::table& table, const Entry& parent, const EntryOrigin& origin,
                  std::vector<Entry>& entries) {
    const auto below = [](const std::string& head, std::string_view name) {
        return head.empty() ? std::string(name) : head + "." + std::string(name);
    };
    for (const auto& [key, node] : table) {
        // A quoted "look.alpha" is one key with a dot in its name, which nothing has.
        const std::string name = key.str().find('.') == std::string_view::npos
                                     ? std::string(key.str())
                                     : fmt::format("\"{}\"", key.str());
        flatten(node, below(parent.key, name), below(parent.generic_key, name), origin, key.source(),
                entries);
    }
}

}  // namespace

std::string unknown_key(const std::string& shown, const std::string& key, const std::string& layer_prefix) {
    const std::string hint = did_you_mean(key, known_keys(layer_prefix));
    return fmt::format("unknown key '{}'{}", shown,
                       hint.empty() ? "; 'astrosplat parameters' lists all keys" : hint);
}

void flatten(const toml::node& node, const std::string& key, const std::string& generic_key,
             const EntryOrigin& origin, const toml::source_region& source, std::vector<Entry>& entries) {
    Entry entry{Entry::Kind::leaf, key,   generic_key, place_of(origin.name, source),
                source.begin,      &node, nullptr};
    if (node.is_table()) entry.kind = Entry::Kind::table;
    if (list_of_tables(node)) entry.kind = Entry::Kind::list;
    if (!key.empty()) entries.push_back(entry);
    if (node.is_table()) add_children(*node.as_table(), entry, origin, entries);
    if (entry.kind != Entry::Kind::list) return;
    std::size_t index = 0;
    for (const toml::node& element : *node.as_array()) {
        const std::string part = fmt::format(".{}", index++);
        flatten(element, key + part, generic_key, origin, element.source(), entries);
    }
}

void extend_lists(const Description& description, const std::string& key) {
    const std::string full = full_key(description, key);
    for (const ParameterList& list : description.lists) {
        if (!begins_with(full, list.key + ".")) continue;
        const char* digits = full.c_str() + list.key.size() + 1;
        std::size_t index = 0;
        const auto [end, problem] = std::from_chars(digits, full.c_str() + full.size(), index);
        if (problem != std::errc() || index > list.size())
            throw ValueError(fmt::format("expected an index of at most {} in {}, found {}", list.size(),
                                         list.generic_key, std::string(digits, end)));
        if (index == list.size()) list.resize(index + 1);
    }
}

void apply_entries(std::vector<Entry> entries, const EntryOrigin& origin,
                   const std::function<Description()>& describe_target, Places& places) {
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.position.line, a.position.column) < std::tie(b.position.line, b.position.column);
    });
    const Description lists = describe_target();
    for (const Entry& entry : entries) set_list_length(lists, entry, origin);
    const Description description = describe_target();
    for (const Entry& entry : entries) {
        const bool list = list_at(description, entry.key) != nullptr;
        if (entry.kind == Entry::Kind::leaf && !list) set_leaf(description, entry, origin);
        if (entry.kind != Entry::Kind::leaf && !list) check_table(description, entry, origin, entries);
        places[full_key(description, entry.key)] = entry.place;
    }
}

}  // namespace astrosplat
