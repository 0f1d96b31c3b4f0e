// Star catalogues. In: the Hipparcos main catalogue (ESA SP-1200, hip_main.dat) or a table with a line of
// names, HYG's among them; both may be gzip-compressed. Out: a list of stars as they stand there, with the
// rows that cannot be used counted and named.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"

namespace astrosplat {

struct CatalogueStar {
    std::int64_t row = 0;               // of the catalogue's rows, bad ones too, from 0
    double ra_deg = 0.0;                // right ascension
    double dec_deg = 0.0;               // declination, -90..90
    double distance_pc = 0.0;           // parsec; 0: not known
    double magnitude = 0.0;             // apparent, V
    std::optional<double> color_index;  // B-V, magnitudes
};

/// Rows that could not be read.
struct BadRows {
    std::int64_t count = 0;
    std::vector<std::int64_t> lines;  // of the first three
    std::string problem;              // of the first: "expected ..., found ..."

    void add(std::int64_t line, const std::string& what);
    /// "3 of 120 rows cannot be used, at lines 4, 9 and 12 (line 4: expected ..., found ...)"
    std::string text(std::int64_t rows) const;
};

struct StarCatalogue {
    std::vector<CatalogueStar> stars;  // in the order of their rows
    std::int64_t rows = 0;             // with the bad ones
    BadRows bad;
};

/// Tables name their columns, in capitals or not, in any order: ra and dec (degrees; HYG's ra, known by its
/// columns hip, hd, hr, gl and proper, in hours), mag or vmag, and where there are such dist or distance
/// (parsec) or parallax or plx (milliarcseconds), and bv, b_v, b-v or ci. No distance is known where it or
/// the parallax is missing, 0 or below, and in HYG from 100000 pc on. What is brighter than magnitude -20 is
/// the Sun: where it lacks a distance, that is 1 au, for which its magnitude holds. Throws InputError where
/// no row can be used; Cancelled.
StarCatalogue read_catalogue(const std::filesystem::path& file, const Progress& progress = {});

/// The same of its text; `name` begins messages.
StarCatalogue parse_catalogue(std::string_view text, const std::string& name, const Progress& progress = {});

/// Whether a first line is that of a catalogue which read_catalogue() takes.
bool is_catalogue(std::string_view first_line);

}  // namespace astrosplat
