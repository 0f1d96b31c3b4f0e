// Star catalogues. In: the Hipparcos main catalogue (ESA SP-1200, hip_main.dat) or a table with a line of
// names, HYG's among them; or the stars of a picture as `prepare` lists them (prepare/star_removal.h). All
// may be gzip-compressed. Out: a list of stars as they stand there, with the rows that cannot be used counted
// and named. Also which files hold stars at all.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/color.h"
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
    std::string place = "line";       // what they count
    std::string problem;              // of the first: "expected ..., found ..."

    void add(std::int64_t line, const std::string& what);
    /// "3 of 120 rows cannot be used, at lines 4, 9 and 12 (line 4: expected ..., found ...)"
    std::string text(std::int64_t rows) const;
};

/// The stars of a file's rows.
template <class Star>
struct StarRows {
    std::vector<Star> stars;  // in the order of their rows
    std::int64_t rows = 0;    // with the bad ones
    BadRows bad;

    /// Counts a row and adds its star where read(star) finds no problem. Throws Cancelled.
    template <class Read>
    void add(std::int64_t line, const Progress& progress, const Read& read) {
        if (rows % 65536 == 0) progress.check();
        Star star;
        star.row = rows++;
        const std::string problem = read(star);
        if (problem.empty())
            stars.push_back(star);
        else
            bad.add(line, problem);
    }
};
using StarCatalogue = StarRows<CatalogueStar>;

/// Tables name their columns as Gaia, VizieR, SIMBAD and HYG do (the lists are in catalogue.cpp), in capitals
/// or not, in any order: ra and dec (degrees, or hours, minutes and seconds), a magnitude, and where there
/// are such a distance (parsec) or parallax (milliarcseconds), and B-V, B beside V, or Gaia's bp_rp, which
/// becomes B-V of the same temperature. HYG's ra, known by its columns hip, hd, hr, gl and proper, is in
/// hours; so is what goes to 24 at most where dec spans the sky or columns are HYG's, and radians are what
/// hip2's RArad and DErad may be: both are told. A header may be a comment; rows of units below it are
/// skipped. No distance is known where it or the parallax is missing, 0 or below, and in HYG from 100000 pc
/// on. What is brighter than magnitude -20 is the Sun: where it lacks a distance, that is 1 au, for which its
/// magnitude holds. Throws InputError where no row can be used; Cancelled.
StarCatalogue read_catalogue(const fs::path& file, const Progress& progress = {});

/// The same of its text; `name` begins messages.
StarCatalogue parse_catalogue(std::string text, const std::string& name, const Progress& progress = {});

/// Whether a text begins as a catalogue does which read_catalogue() takes.
bool is_catalogue(std::string_view text);

/// Whether a FITS file without a picture has a table which read_catalogue() takes. Throws InputError.
bool is_fits_catalogue(const fs::path& file);

// ---- the stars of a picture

struct TableStar {
    std::int64_t row = 0;   // of the table's rows, bad ones too, from 0
    glm::dvec2 uv{0.0};     // on the picture; v = 0 is its lower edge
    glm::dvec3 light{0.0};  // linear, >= 0, over all pixels of the picture
    double sigma_px = 0.0;  // of the picture's pixels; 0: not known
    double luminance() const { return astrosplat::luminance(light.x, light.y, light.z); }
};

using PictureTable = StarRows<TableStar>;

/// Columns u, v and flux_r, flux_g, flux_b, in any order, and sigma_px where there is one; .gz too. Rows
/// without light are bad ones. Throws InputError where a column is missing or no row of many can
/// be used; Cancelled.
PictureTable read_picture_table(const fs::path& file, const Progress& progress = {});

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
CatalogueKind kind_of_catalogue(const fs::path& file);

}  // namespace astrosplat
