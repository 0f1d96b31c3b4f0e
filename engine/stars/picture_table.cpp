#include "stars/catalogue.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"
#include "core/packed_file.h"
#include "core/sorting.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr std::size_t most_header_shown = 60;  // characters of a line in a message
constexpr double most_light = 1e18;            // squares and sums stay finite in 32 bits
constexpr double farthest_uv = 100.0;          // pictures away: beyond, a column was taken for another
constexpr double widest_px = 1e6;

struct TableColumns {
    explicit TableColumns(const TextTable& table)
        : u(table.column({"u"})),
          v(table.column({"v"})),
          light{table.column({"flux_r"}), table.column({"flux_g"}), table.column({"flux_b"})},
          sigma(table.column({"sigma_px"})) {}
    bool complete() const {
        return std::ranges::min({u, v, light[0], light[1], light[2]}) != TextTable::none;
    }

    int u, v, light[3], sigma;
};

// The fault that keeps a row from being a star, as "expected ..., found ..."; empty where nothing does.
std::string read_star(const TextTable& table, const TableColumns& columns, TableStar& star) {
    std::string problem;
    const auto number = [&](int column, const char* name, double lo, double hi) {
        std::optional<double> value;
        const std::string_view field = table.field(column);
        const bool good = read_number(field, value) && value && *value >= lo && *value <= hi;
        if (!good && problem.empty())
            problem = fmt::format("expected a number from {} to {} for {}, found '{}'", shortest(lo),
                                  shortest(hi), name, printable(field.substr(0, most_header_shown)));
        return good ? *value : 0.0;
    };
    star.uv = {number(columns.u, "u", -farthest_uv, farthest_uv),
               number(columns.v, "v", -farthest_uv, farthest_uv)};
    constexpr const char* names[] = {"flux_r", "flux_g", "flux_b"};
    for (int c = 0; c < 3; ++c)
        star.light[c] = std::max(0.0, number(columns.light[c], names[c], -most_light, most_light));
    if (columns.sigma != TextTable::none) star.sigma_px = number(columns.sigma, "sigma_px", 0.0, widest_px);
    if (problem.empty() && !(star.luminance() > 0.0)) problem = "expected light, found none";
    return problem;
}

bool is_picture_table(std::string_view first_line) { return TableColumns(TextTable(first_line)).complete(); }

constexpr std::size_t beginning_bytes = 1 << 16;  // VizieR writes pages of comments first

std::string beginning_of(const fs::path& file) {
    const std::string bytes = read_beginning(file, beginning_bytes);
    return is_packed(bytes) ? read_unpacked(file, {}, {.enough = beginning_bytes}) : bytes;
}

}  // namespace

PictureTable parse_picture_table(std::string_view text, const std::string& name, const Progress& progress) {
    TextTable table(text);
    const TableColumns columns(table);
    if (!columns.complete())
        bad_input(name, fmt::format("line {}", table.line()),
                  "the stars of a picture: names of columns with u, v, flux_r, flux_g and flux_b among them",
                  fmt::format("'{}'", printable(table.header().substr(0, most_header_shown))));
    PictureTable result;
    while (table.next())
        result.add(table.line(), progress, [&](TableStar& star) { return read_star(table, columns, star); });
    if (result.stars.empty() && result.rows > 0) bad_input(name, "stars", result.bad.text(result.rows));
    return result;
}

PictureTable read_picture_table(const fs::path& file, const Progress& progress) {
    return parse_picture_table(read_unpacked(file, progress, table_bounds), file.string(), progress);
}

double median_sigma_px(const PictureTable& table) {
    std::vector<double> widths;
    for (const TableStar& star : table.stars)
        if (star.sigma_px > 0.0) widths.push_back(star.sigma_px);
    return widths.empty() ? 0.0 : median(widths);
}

CatalogueKind kind_of_catalogue(const fs::path& file) {
    if (is_fits_catalogue(file)) return CatalogueKind::sky;
    const std::string text = beginning_of(file);
    TextRows rows(text, file.string());
    if (!rows.next() || text.find('\0') != text.npos) return CatalogueKind::none;
    if (is_picture_table(rows.text())) return CatalogueKind::picture;
    return is_catalogue(text) ? CatalogueKind::sky : CatalogueKind::none;
}

}  // namespace astrosplat
