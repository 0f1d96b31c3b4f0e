// Rows of catalogues as stars, in the same way whatever the format: Hipparcos has its fields between | at
// fixed places (ESA SP-1200, volume 1, section 2.1), tables name theirs in the first line.
#include "stars/catalogue.h"

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/real.h"
#include "core/text.h"
#include "stars/star_set.h"

namespace astrosplat {

void BadRows::add(std::int64_t line, const std::string& what) {
    if (count++ == 0) problem = what;
    constexpr std::size_t lines_named = 3;
    if (lines.size() < lines_named) lines.push_back(line);
}

std::string BadRows::text(std::int64_t rows) const {
    std::string where;
    for (std::size_t i = 0; i < lines.size(); ++i)
        where += (i == 0 ? "" : i + 1 == lines.size() ? " and " : ", ") + fmt::format("{}", lines[i]);
    const bool more = count > std::int64_t(lines.size());
    return fmt::format("{} of {} cannot be used, {} line{} {} (line {}: {})", count, counted(rows, "row"),
                       more ? "first at" : "at", lines.size() == 1 ? "" : "s", where, lines.front(),
                       printable(problem));
}

namespace {

// ---- one row, from its fields to a star

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

enum class RowUnits { degrees, hours };  // of right ascension

/// The fields as they stand; empty ones are missing.
struct StarFields {
    std::string_view ra, dec, magnitude, distance, parallax, color_index, blue = {}, bp_rp = {};
};

/// Of dwarfs of the Sun's metals: Mucciarelli, Bellazzini & Massari 2021 (A&A 653, A90), table 1. It holds
/// from 0.39 to 1.50; beyond, where it stays within 3 % of the dwarfs of Pecaut & Mamajek 2013 down to 3100
/// K, it still tells blue stars from red ones.
double temperature_of_bp_rp(double bp_rp) {
    const double c = std::clamp(bp_rp, -0.5, 5.0);
    return 5040.0 / (0.4929 + 0.5092 * c - 0.0353 * c * c);
}

/// "00 00 12.80", "-16:42:58.0" as one number; nothing where it is no such text.
std::optional<double> sexagesimal(std::string_view text) {
    text = trim(text);
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0, share = 1.0;
    for (int part = 0; part < 3; ++part, share /= 60.0) {
        text = trim(text);
        const std::size_t end = std::min(text.find_first_of(" :"), text.size());
        const std::optional<double> number = parse_double(text.substr(0, end));
        if (!number || !(*number >= 0.0 && *number <= 360.0)) return std::nullopt;
        value += *number * share;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (!trim(text).empty()) return std::nullopt;
    return negative ? -value : value;
}

/// Their numbers; what is missing has none.
struct StarRow {
    std::optional<double> ra_deg, dec_deg, magnitude, distance_pc, parallax_mas, color_index;

    /// The first field that is no number, as "expected ..., found ..."; empty where all are.
    std::string read(const StarFields& fields, RowUnits units) {
        const bool clock = !read_number(fields.ra, ra_deg);
        if (clock) ra_deg = sexagesimal(fields.ra);
        if (clock && !ra_deg) return no_number("right ascension", fields.ra);
        if (ra_deg && (clock || units == RowUnits::hours)) *ra_deg *= 15.0;
        const bool dial = !read_number(fields.dec, dec_deg);
        if (dial) dec_deg = sexagesimal(fields.dec);
        if (dial && !dec_deg) return no_number("declination", fields.dec);
        if (!read_number(fields.magnitude, magnitude)) return no_number("the magnitude", fields.magnitude);
        if (!read_number(fields.distance, distance_pc)) return no_number("the distance", fields.distance);
        if (!read_number(fields.parallax, parallax_mas)) return no_number("the parallax", fields.parallax);
        if (!read_number(fields.color_index, color_index)) return no_number("B-V", fields.color_index);
        std::optional<double> other;
        if (!read_number(fields.blue, other)) return no_number("B", fields.blue);
        if (!color_index && other && magnitude) color_index = *other - *magnitude;
        if (!read_number(fields.bp_rp, other)) return no_number("BP-RP", fields.bp_rp);
        if (!color_index && other) color_index = color_index_of(temperature_of_bp_rp(*other));
        return {};
    }

    /// The fault that keeps the row from being a star, likewise.
    std::string to_star(CatalogueStar& star) const {
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
};

// ---- Hipparcos

enum HipparcosField {
    ra_hms = 3,
    dec_dms = 4,
    v_magnitude = 5,
    ra = 8,
    dec = 9,
    parallax = 11,
    b_v = 37,
    fields
};

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

/// Fields H5 (V), H8 and H9 (right ascension and declination at J1991.25, degrees; where these are missing H3
/// and H4, sexagesimal), H11 (parallax, milliarcseconds) and H37 (B-V). Throws Cancelled.
StarCatalogue parse_hipparcos(std::string_view text, const Progress& progress) {
    StarCatalogue catalogue;
    for (TextRows rows(text); rows.next();)
        catalogue.add(rows.line(), progress,
                      [&](CatalogueStar& star) { return read_row(rows.fields('|'), star); });
    return catalogue;
}

// ---- tables whose first line names the columns

constexpr double hyg_unknown_pc = 100000.0;  // how HYG writes that it knows no distance
constexpr std::size_t most_shown = 60;       // characters of a line in a message

/// By what Gaia's archive, VizieR, SIMBAD, HYG and people call them; the first that a table has.
struct Columns {
    explicit Columns(const TextTable& table)
        : ra(table.column({"ra", "ra_d", "_raj2000", "raj2000", "ra_icrs", "_ra.icrs", "_ra", "ra_deg",
                           "radeg", "raicrs", "rarad"})),
          dec(table.column({"dec", "dec_d", "_dej2000", "dej2000", "de_icrs", "_de.icrs", "_de", "dec_deg",
                            "dedeg", "deicrs", "derad", "de"})),
          magnitude(
              table.column({"mag", "vmag", "v", "flux_v", "phot_g_mean_mag", "gmag", "hpmag", "vtmag"})),
          distance(table.column({"dist", "distance"})),
          parallax(table.column({"parallax", "plx", "plx_value"})),
          color_index(table.column({"bv", "b_v", "b-v", "ci"})),
          bp_rp(table.column({"bp_rp", "bp-rp"})) {
        hyg = true;
        for (const char* const name : {"hip", "hd", "hr", "gl", "proper"})
            hyg = hyg && table.column({name}) != TextTable::none;
        from_hyg =
            hyg || (table.column({"proper"}) != TextTable::none && table.column({"ci"}) != TextTable::none);
        constexpr std::pair<const char*, const char*> pairs[] = {
            {"v", "b"}, {"vmag", "bmag"}, {"flux_v", "flux_b"}};
        for (const auto& [v, b] : pairs)
            if (magnitude == table.column({v}) && blue == TextTable::none) blue = table.column({b});
        may_be_hours = !hyg && ra == table.column({"ra"});
        may_be_radians = ra == table.column({"rarad"}) && dec == table.column({"derad"});
    }

    bool complete() const { return std::ranges::min({ra, dec, magnitude}) != TextTable::none; }
    /// Of ra, dec and mag those that it lacks.
    std::string missing() const {
        std::string names;
        for (const auto& [column, name] :
             {std::pair(ra, "ra"), std::pair(dec, "dec"), std::pair(magnitude, "mag")})
            if (column == TextTable::none) names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
        return names;
    }

    int ra, dec, magnitude, distance, parallax, color_index, bp_rp, blue = TextTable::none;
    bool hyg, from_hyg, may_be_hours, may_be_radians;
};

std::string read_table_row(const TextTable& table, const Columns& columns, CatalogueStar& star) {
    StarRow row;
    std::string problem =
        row.read({table.field(columns.ra), table.field(columns.dec), table.field(columns.magnitude),
                  table.field(columns.distance), table.field(columns.parallax),
                  table.field(columns.color_index), table.field(columns.blue), table.field(columns.bp_rp)},
                 columns.hyg ? RowUnits::hours : RowUnits::degrees);
    if (columns.from_hyg && row.distance_pc && *row.distance_pc >= hyg_unknown_pc) row.distance_pc.reset();
    return problem.empty() ? row.to_star(star) : problem;
}

/// Right ascensions that no sky in degrees has are hours, or radians; `name` begins the warning.
void set_units(StarCatalogue& catalogue, const Columns& columns, const std::string& name) {
    std::vector<CatalogueStar>& stars = catalogue.stars;
    if (stars.empty()) return;
    const auto [first, last] = std::ranges::minmax(stars, {}, &CatalogueStar::ra_deg);
    const auto [south, north] = std::ranges::minmax(stars, {}, &CatalogueStar::dec_deg);
    constexpr std::size_t a_few = 8;  // of which none of a sky in degrees lies beyond 24 once in 10^9
    const bool whole_sky = stars.size() >= a_few && north.dec_deg - south.dec_deg > 90.0;
    const bool radians = columns.may_be_radians && last.ra_deg <= 2.0 * real::pi + 1e-6 &&
                         std::fmax(-south.dec_deg, north.dec_deg) <= 0.5 * real::pi + 1e-6;
    const bool hours =
        columns.may_be_hours && first.ra_deg >= 0.0 && last.ra_deg <= 24.0 && (whole_sky || columns.from_hyg);
    if (!radians && !hours) return;
    for (CatalogueStar& star : stars) {
        star.ra_deg = radians ? real::degrees(star.ra_deg) : 15.0 * star.ra_deg;
        if (radians) star.dec_deg = real::degrees(star.dec_deg);
    }
    log_warning(fmt::format("{}: {} at most: taken for {}", printable(name),
                            radians ? "RArad and DErad are 2 pi and pi / 2" : "its ra is 24",
                            radians ? "radians" : "hours"));
}

/// The text from its line of names on: the first line, or a comment above it where that has them and it has
/// not.
std::string_view from_header(std::string_view text) {
    TextRows rows(text);
    rows.next();
    if (Columns(TextTable(rows.text())).complete()) return text;
    for (std::size_t at = 0; at < text.size(); at = std::min(text.find('\n', at), text.size() - 1) + 1) {
        const std::string_view rest = text.substr(at);
        const std::string_view line = rest.substr(0, rest.find('\n'));
        if (rest.data() >= rows.text().data()) break;
        if (line.starts_with('#') && Columns(TextTable(line.substr(1))).complete()) return rest.substr(1);
    }
    return text;
}

/// Units or dashes, as VizieR has them below the names.
bool is_below_header(const TextTable& table, const Columns& columns) {
    return std::ranges::none_of(std::array{columns.ra, columns.dec, columns.magnitude},
                                [&](int column) {
                                    return table.field(column).find_first_of("0123456789") !=
                                           std::string_view::npos;
                                }) &&
           !table.field(columns.ra).empty();
}

/// Throws InputError where the columns of ra, dec or mag are missing; Cancelled.
StarCatalogue parse_columns(std::string_view all, const std::string& name, const Progress& progress) {
    const std::string_view text = from_header(all);
    const auto above = std::count(all.begin(), all.begin() + (text.data() - all.data()), '\n');
    TextTable table(text);
    const Columns columns(table);
    if (!columns.complete())
        bad_input(
            name, fmt::format("line {}", table.line()),
            "a Hipparcos catalogue, or names of columns with ra, dec and mag among them",
            fmt::format("no {} in '{}'", columns.missing(), printable(table.header().substr(0, most_shown))));
    StarCatalogue catalogue;
    while (table.next())
        if (catalogue.rows > 0 || !is_below_header(table, columns))
            catalogue.add(table.line() + above, progress,
                          [&](CatalogueStar& star) { return read_table_row(table, columns, star); });
    set_units(catalogue, columns, name);
    return catalogue;
}

bool is_hipparcos(std::string_view first_line) {
    const std::string_view line = trim(first_line);
    return line.starts_with('H') && trim(line.substr(1)).starts_with('|');
}

// ---- text that may be packed

constexpr std::size_t block_bytes = std::size_t{1} << 22;
constexpr int any_gzip = 15 + 16;  // zlib: the largest window, and gzip's own header

// A gzip file may be several of them one after the other.
class Inflater {
  public:
    Inflater(std::string_view packed, std::string name) : name_(std::move(name)) {
        stream_.next_in =
            reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // which zlib only reads
        left_ = packed.size();
    }

    /// Adds the next block to `text`; false at the end. Throws InputError.
    bool add_block(std::string& text) {
        if (done_) return false;
        feed();
        const std::size_t have = text.size();
        text.resize(have + block_bytes);
        stream_.next_out = reinterpret_cast<Bytef*>(text.data() + have);
        stream_.avail_out = static_cast<uInt>(block_bytes);
        while (!done_ && stream_.avail_out > 0) step();
        text.resize(text.size() - stream_.avail_out);
        return true;
    }

  private:
    void feed() {
        if (stream_.avail_in > 0) return;
        stream_.avail_in = static_cast<uInt>(std::min<std::size_t>(left_, 1u << 30));
        left_ -= stream_.avail_in;
    }

    void step() {
        if (!open_) {
            if (inflateInit2(&stream_, any_gzip) != Z_OK) throw std::bad_alloc();
            open_.reset(&stream_);
        }
        feed();
        const int result = inflate(&stream_, Z_NO_FLUSH);
        if (result == Z_STREAM_END) {
            open_.reset();
            feed();
            const bool more = stream_.avail_in >= 2 && stream_.next_in[0] == 0x1f;
            done_ = !more;
        } else if (result != Z_OK) {
            bad_input(name_, "a whole gzip file", "damaged data");
        }
    }

    std::string name_;
    z_stream stream_{};
    std::unique_ptr<z_stream, int (*)(z_stream*)> open_{nullptr, inflateEnd};
    std::size_t left_ = 0;
    bool done_ = false;
};

}  // namespace

bool is_catalogue(std::string_view text) {
    TextRows rows(text);
    return rows.next() && (is_hipparcos(rows.text()) || Columns(TextTable(from_header(text))).complete());
}

StarCatalogue parse_catalogue(std::string_view text, const std::string& name, const Progress& progress) {
    TextRows first(text);
    if (!first.next()) bad_input(name, "a star catalogue", "an empty file");
    StarCatalogue catalogue =
        is_hipparcos(first.text()) ? parse_hipparcos(text, progress) : parse_columns(text, name, progress);
    if (catalogue.stars.empty())
        bad_input(name, "at least one star",
                  catalogue.rows == 0 ? "none" : "none: " + catalogue.bad.text(catalogue.rows));
    return catalogue;
}

std::string read_catalogue_text(const fs::path& file, const Progress& progress) {
    const std::string bytes = read_file(file, progress);
    if (!bytes.starts_with("\x1f\x8b")) return bytes;
    std::string text;
    for (Inflater inflater(bytes, file.string()); inflater.add_block(text);) {
        progress.check();
        claim_memory(std::int64_t(text.size()), fmt::format("reading {}", file.string()));
    }
    return text;
}

StarCatalogue read_catalogue(const fs::path& file, const Progress& progress) {
    return parse_catalogue(read_catalogue_text(file, progress), file.string(), progress);
}

}  // namespace astrosplat
