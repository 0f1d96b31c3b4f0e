// The Hipparcos main catalogue: fields between | at fixed places (ESA SP-1200, volume 1, section 2.1). In:
// its text. Out: the stars of its rows.
#pragma once

#include <string_view>

#include "stars/catalogue.h"

namespace astrosplat {

bool is_hipparcos(std::string_view first_line);

/// Fields H5 (V), H8 and H9 (right ascension and declination at J1991.25, degrees; where these are missing H3
/// and H4, sexagesimal), H11 (parallax, milliarcseconds) and H37 (B-V). Throws Cancelled.
StarCatalogue parse_hipparcos(std::string_view text, const Progress& progress = {});

}  // namespace astrosplat
