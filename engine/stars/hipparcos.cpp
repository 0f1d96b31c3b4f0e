#include "stars/hipparcos.h"

#include <fmt/format.h>

#include <cmath>

#include "core/text.h"
#include "stars/star_row.h"
#include "stars/text_table.h"

namespace astrosplat {
namespace {

enum Field { ra_hms = 3, dec_dms = 4, v_magnitude = 5, ra = 8, dec = 9, parallax = 11, b_v = 37, fields };

// "00 00 12.80", "-16 42 58.0" as one number; nothing where it is no such text.
std::optional<double> sexagesimal(std::string_view text) {
    text = trim(text);
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0, share = 1.0;
    for (int part = 0; part < 3; ++part, share /= 60.0) {
        text = trim(text);
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::optional<double> number = parse_double(text.substr(0, end));
        if (!number || !(*number >= 0.0 && *number <= 360.0)) return std::nullopt;
        value += *number * share;
        text.remove_prefix(end);
    }
    if (!text.empty()) return std::nullopt;
    return negative ? -value : value;
}

std::string read_row(const std::vector<std::string_view>& field, CatalogueStar& star) {
    if (field.size() < fields) return fmt::format("expected {} fields, found {}", +fields, field.size());
    StarRow row;
    std::string problem = row.read(
        {field[ra], field[dec], field[v_magnitude], "", field[parallax], field[b_v]}, RowUnits::degrees);
    if (!row.ra_deg && !row.dec_deg) {
        row.ra_deg = sexagesimal(field[ra_hms]);
        if (row.ra_deg) *row.ra_deg *= 15.0;
        row.dec_deg = sexagesimal(field[dec_dms]);
    }
    return problem.empty() ? row.to_star(star) : problem;
}

}  // namespace

bool is_hipparcos(std::string_view first_line) {
    const std::string_view line = trim(first_line);
    return line.starts_with('H') && trim(line.substr(1)).starts_with('|');
}

StarCatalogue parse_hipparcos(std::string_view text, const Progress& progress) {
    StarCatalogue catalogue;
    std::vector<std::string_view> field;
    for (TextLines lines(text); lines.next();) {
        split_fields(lines.line(), '|', field);
        add_row(catalogue, lines.number(), progress,
                [&](CatalogueStar& star) { return read_row(field, star); });
    }
    return catalogue;
}

}  // namespace astrosplat
