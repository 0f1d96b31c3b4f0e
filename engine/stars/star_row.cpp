#include "stars/star_row.h"

#include <fmt/format.h>

#include <cmath>

#include "core/text.h"
#include "stars/text_table.h"

namespace astrosplat {
namespace {

constexpr double brightest = -60.0, faintest = 60.0;  // magnitudes: beyond, a column was taken for another
constexpr double largest_index = 20.0;                // of B-V, likewise
constexpr double sun_magnitude = -20.0;               // brighter is nothing else
constexpr double au_pc = 4.84813681e-6;               // an astronomical unit in parsec

std::string no_number(std::string_view name, std::string_view field) {
    return fmt::format("expected a number for {}, found '{}'", name, field);
}

std::string wrong(std::string_view name, std::string_view range, const std::optional<double>& found) {
    return fmt::format("expected {} for {}, found {}", range, name, found ? shortest(*found) : "none");
}

bool within(const std::optional<double>& number, double lo, double hi) {
    return number && *number >= lo && *number <= hi;
}

bool usable(const std::optional<double>& number) { return number && *number > 0.0; }

}  // namespace

std::string StarRow::read(const StarFields& fields, RowUnits units) {
    if (!read_number(fields.ra, ra_deg)) return no_number("right ascension", fields.ra);
    if (ra_deg && units == RowUnits::hours) *ra_deg *= 15.0;
    if (!read_number(fields.dec, dec_deg)) return no_number("declination", fields.dec);
    if (!read_number(fields.magnitude, magnitude)) return no_number("the magnitude", fields.magnitude);
    if (!read_number(fields.distance, distance_pc)) return no_number("the distance", fields.distance);
    if (!read_number(fields.parallax, parallax_mas)) return no_number("the parallax", fields.parallax);
    if (!read_number(fields.color_index, color_index)) return no_number("B-V", fields.color_index);
    return {};
}

std::string StarRow::to_star(CatalogueStar& star) const {
    if (!within(ra_deg, -360.0, 360.0)) return wrong("right ascension", "0 to 360 degrees", ra_deg);
    if (!within(dec_deg, -90.0, 90.0)) return wrong("declination", "-90 to 90 degrees", dec_deg);
    if (!within(magnitude, brightest, faintest)) return wrong("the magnitude", "-60 to 60", magnitude);
    if (color_index && !within(color_index, -largest_index, largest_index))
        return wrong("B-V", "-20 to 20", color_index);
    star.ra_deg = *ra_deg;
    star.dec_deg = *dec_deg;
    star.magnitude = *magnitude;
    star.color_index = color_index;
    star.distance_pc = usable(distance_pc)          ? *distance_pc
                       : usable(parallax_mas)       ? 1000.0 / *parallax_mas
                       : *magnitude < sun_magnitude ? au_pc
                                                    : 0.0;
    if (!std::isfinite(star.distance_pc)) star.distance_pc = 0.0;
    return {};
}

}  // namespace astrosplat
