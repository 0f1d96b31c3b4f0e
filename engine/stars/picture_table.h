// The stars of a picture as `prepare` lists them (prepare/star_removal.h), and which files hold stars at all.
// In: a table's text, or a file of any kind. Out: places and light, with the rows that cannot be used counted
// and named; or which reader would take it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/color.h"
#include "core/progress.h"
#include "stars/catalogue.h"

namespace astrosplat {

struct TableStar {
    std::int64_t row = 0;   // of the table's rows, bad ones too, from 0
    glm::dvec2 uv{0.0};     // on the picture; v = 0 is its lower edge
    glm::dvec3 light{0.0};  // linear, >= 0, over all pixels of the picture
    double sigma_px = 0.0;  // of the picture's pixels; 0: not known
    double luminance() const { return astrosplat::luminance(light.x, light.y, light.z); }
};

struct PictureTable {
    std::vector<TableStar> stars;  // in the order of their rows
    std::int64_t rows = 0;         // with the bad ones
    BadRows bad;
};

/// Columns u, v and flux_r, flux_g, flux_b, in any order, and sigma_px where there is one; .gz too. Rows
/// without light are bad ones. Throws InputError where a column is missing or no row of many can be used;
/// Cancelled.
PictureTable read_picture_table(const std::filesystem::path& file, const Progress& progress = {});

/// The same of its text; `name` begins messages.
PictureTable parse_picture_table(std::string_view text, const std::string& name,
                                 const Progress& progress = {});

/// The middle one of the stars' widths, px of the picture; 0 where none is known.
double median_sigma_px(const PictureTable& table);

enum class CatalogueKind {
    none,
    sky,     // read_catalogue() takes it
    picture  // read_picture_table() does
};

/// By its first line, whatever its name. Of gzip data only where it begins as such; none for what cannot be
/// read. Throws InputError for damaged gzip data.
CatalogueKind kind_of_catalogue(const std::filesystem::path& file);

}  // namespace astrosplat
