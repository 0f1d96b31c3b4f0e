// Star catalogues whose first line names the columns. In: their text. Out: the stars of their rows.
#pragma once

#include <string>
#include <string_view>

#include "stars/catalogue.h"

namespace astrosplat {

/// The names are read_catalogue's. Throws InputError where those of ra, dec or mag are missing; Cancelled.
StarCatalogue parse_columns(std::string_view text, const std::string& name, const Progress& progress = {});

}  // namespace astrosplat
