#include "stars/named_columns.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "stars/star_row.h"
#include "stars/text_table.h"

namespace astrosplat {
namespace {

constexpr double hyg_unknown_pc = 100000.0;  // how HYG writes that it knows no distance
constexpr std::size_t most_shown = 60;       // characters of a line in a message

struct Columns {
    explicit Columns(const TextTable& table)
        : ra(table.column({"ra"})),
          dec(table.column({"dec"})),
          magnitude(table.column({"mag", "vmag"})),
          distance(table.column({"dist", "distance"})),
          parallax(table.column({"parallax", "plx"})),
          color_index(table.column({"bv", "b_v", "b-v", "ci"})) {
        hyg = true;
        for (const char* const name : {"hip", "hd", "hr", "gl", "proper"})
            hyg = hyg && table.column({name}) != TextTable::none;
    }

    int ra, dec, magnitude, distance, parallax, color_index;
    bool hyg;
};

std::string read_table_row(const TextTable& table, const Columns& columns, CatalogueStar& star) {
    StarRow row;
    std::string problem = row.read(
        {table.field(columns.ra), table.field(columns.dec), table.field(columns.magnitude),
         table.field(columns.distance), table.field(columns.parallax), table.field(columns.color_index)},
        columns.hyg ? RowUnits::hours : RowUnits::degrees);
    if (columns.hyg && row.distance_pc && *row.distance_pc >= hyg_unknown_pc) row.distance_pc.reset();
    return problem.empty() ? row.to_star(star) : problem;
}

}  // namespace

StarCatalogue parse_columns(std::string_view text, const std::string& name, const Progress& progress) {
    TextTable table(text);
    const Columns columns(table);
    for (const int needed : {columns.ra, columns.dec, columns.magnitude})
        if (needed == TextTable::none)
            bad_input(name, fmt::format("line {}", table.line()),
                      "a Hipparcos catalogue, or names of columns with ra, dec and mag among them",
                      fmt::format("'{}'", printable(table.header().substr(0, most_shown))));
    StarCatalogue catalogue;
    while (table.next())
        add_row(catalogue, table.line(), progress,
                [&](CatalogueStar& star) { return read_table_row(table, columns, star); });
    return catalogue;
}

}  // namespace astrosplat
