// TOML files into tables with line numbers, and TOML nodes into Values. Include in .cpp files only: toml++ is
// large.
#pragma once

#include <toml++/toml.h>
#include <string>

#include "scene/value.h"

namespace astrosplat {

/// Parses TOML; `name` and the line begin every message. Throws InputError.
toml::table parse_toml(const std::string& text, const std::string& name);

/// A leaf as a Value. Throws ValueError for tables and dates.
Value value_of(const toml::node& node);

/// "a table", "a date", or as kind_of(Value).
std::string kind_of(const toml::node& node);

/// An array that lists tables ([[x]] or [ {...}, ... ]); an empty array does not.
const toml::array* list_of_tables(const toml::node& node);

/// "FILE:LINE" of a node or key.
std::string place_of(const std::string& name, const toml::source_region& source);

}  // namespace astrosplat
