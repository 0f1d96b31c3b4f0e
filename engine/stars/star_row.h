// One row of a catalogue, from its fields to a star: what every format has in common.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stars/catalogue.h"

namespace astrosplat {

enum class RowUnits { degrees, hours };  // of right ascension

/// The fields as they stand; empty ones are missing.
struct StarFields {
    std::string_view ra, dec, magnitude, distance, parallax, color_index;
};

/// Their numbers; what is missing has none.
struct StarRow {
    std::optional<double> ra_deg, dec_deg, magnitude, distance_pc, parallax_mas, color_index;

    /// The first field that is no number, as "expected ..., found ..."; empty where all are.
    std::string read(const StarFields& fields, RowUnits units);
    /// What keeps the row from being a star, likewise.
    std::string to_star(CatalogueStar& star) const;
};

/// Counts a row and adds its star where `read_row(star)` finds no problem.
template <class ReadRow>
void add_row(StarCatalogue& catalogue, std::int64_t line, const Progress& progress, const ReadRow& read_row) {
    if (catalogue.rows % 65536 == 0) progress.check();
    CatalogueStar star;
    star.row = catalogue.rows++;
    const std::string problem = read_row(star);
    if (problem.empty())
        catalogue.stars.push_back(star);
    else
        catalogue.bad.add(line, problem);
}

}  // namespace astrosplat
