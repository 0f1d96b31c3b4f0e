#include "stars/catalogue.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "stars/catalogue_text.h"
#include "stars/hipparcos.h"
#include "stars/named_columns.h"
#include "stars/text_table.h"

namespace astrosplat {
namespace {

constexpr std::size_t lines_named = 3;

}  // namespace

void BadRows::add(std::int64_t line, const std::string& what) {
    if (count++ == 0) problem = what;
    if (lines.size() < lines_named) lines.push_back(line);
}

std::string BadRows::text(std::int64_t rows) const {
    std::string where;
    for (std::size_t i = 0; i < lines.size(); ++i)
        where += (i == 0 ? "" : i + 1 == lines.size() ? " and " : ", ") + fmt::format("{}", lines[i]);
    const bool more = count > static_cast<std::int64_t>(lines.size());
    return fmt::format("{} of {} cannot be used, {} line{} {} (line {}: {})", count, counted(rows, "row"),
                       more ? "first at" : "at", lines.size() == 1 ? "" : "s", where, lines.front(),
                       printable(problem));
}

StarCatalogue parse_catalogue(std::string_view text, const std::string& name, const Progress& progress) {
    TextLines first(text);
    if (!first.next()) bad_input(name, "", "a star catalogue", "an empty file");
    StarCatalogue catalogue =
        is_hipparcos(first.line()) ? parse_hipparcos(text, progress) : parse_columns(text, name, progress);
    if (catalogue.stars.empty())
        bad_input(name, "", "at least one star",
                  catalogue.rows == 0 ? "none" : "none: " + catalogue.bad.text(catalogue.rows));
    return catalogue;
}

StarCatalogue read_catalogue(const std::filesystem::path& file, const Progress& progress) {
    return parse_catalogue(read_catalogue_text(file, progress), file.string(), progress);
}

}  // namespace astrosplat
