// Rows of catalogues as stars, in the same way whatever the format: Hipparcos has its fields between | at
// fixed places (ESA SP-1200, volume 1, section 2.1), tables name theirs in the first line.
#include "stars/catalogue.h"

#include <fmt/format.h>

#include <map>

#include "core/error.h"
#include "core/log.h"
#include "core/packed_file.h"
#include "core/real.h"
#include "core/text.h"
#include "source/file_tables.h"
#include "source/fits.h"
#include "source/xisf.h"
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
    return fmt::format("{} of {} cannot be used, {} {}{} {} ({} {}: {})", count, counted(rows, "row"),
                       more ? "first at" : "at", place, lines.size() == 1 ? "" : "s", where, place,
                       lines.front(), printable(problem));
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

/// The fields as they stand; empty ones are missing.
struct StarFields {
    std::string_view ra, dec, magnitude, distance, parallax, color_index, blue = {}, bp_rp = {}, bp = {},
                                                                          rp = {}, kelvin = {};
};

/// What the numbers of a table are multiplied by, and what its magnitudes are.
struct RowUnits {
    double ra = 1.0, ra_clock = 15.0, dec = 1.0, distance = 1.0, parallax = 1.0;
    bool gaia_g = false;
};

/// Of dwarfs of the Sun's metals: Mucciarelli, Bellazzini & Massari 2021 (A&A 653, A90), table 1. It holds
/// from 0.39 to 1.50; beyond, where it stays within 3 % of the dwarfs of Pecaut & Mamajek 2013 down to 3100
/// K, it still tells blue stars from red ones.
double temperature_of_bp_rp(double bp_rp) {
    const double c = std::clamp(bp_rp, -0.5, 5.0);
    return 5040.0 / (0.4929 + 0.5092 * c - 0.0353 * c * c);
}

/// Gaia DR3's documentation, section 5.5.1, table 5.9 (Riello et al. 2021, A&A 649, A3, appendix C): it holds
/// from -0.5 to 5.
std::optional<double> v_minus_g(double bp_rp) {
    if (!(bp_rp >= -0.5 && bp_rp <= 5.0)) return {};
    return 0.02704 - bp_rp * (0.01424 - bp_rp * (0.2156 - bp_rp * 0.01426));
}

/// "00 00 12.80", "-16:42:58.0", "6h45m08.9s" as one number; nothing where it is no such text.
std::optional<double> sexagesimal(std::string_view text) {
    text = trim(text);
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0, share = 1.0;
    for (int part = 0; part < 3; ++part, share /= 60.0) {
        text = trim(text);
        const std::size_t end = std::min(text.find_first_of(" :hdms"), text.size());
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
    std::string read(const StarFields& fields, const RowUnits& units) {
        const bool clock = !read_number(fields.ra, ra_deg);
        if (clock) ra_deg = sexagesimal(fields.ra);
        if (clock && !ra_deg) return no_number("right ascension", fields.ra);
        if (ra_deg) *ra_deg *= clock ? units.ra_clock : units.ra;
        const bool dial = !read_number(fields.dec, dec_deg);
        if (dial) dec_deg = sexagesimal(fields.dec);
        if (dial && !dec_deg) return no_number("declination", fields.dec);
        if (dec_deg && !dial) *dec_deg *= units.dec;
        if (!read_number(fields.magnitude, magnitude)) return no_number("the magnitude", fields.magnitude);
        if (!read_number(fields.distance, distance_pc)) return no_number("the distance", fields.distance);
        if (!read_number(fields.parallax, parallax_mas)) return no_number("the parallax", fields.parallax);
        if (distance_pc) *distance_pc *= units.distance;
        if (parallax_mas) *parallax_mas *= units.parallax;
        if (!read_number(fields.color_index, color_index)) return no_number("B-V", fields.color_index);
        std::optional<double> other;
        if (!read_number(fields.blue, other)) return no_number("B", fields.blue);
        if (!color_index && other && magnitude) color_index = *other - *magnitude;
        if (!read_number(fields.bp_rp, other)) return no_number("BP-RP", fields.bp_rp);
        std::optional<double> bp, rp, kelvin;
        if (!read_number(fields.bp, bp)) return no_number("BP", fields.bp);
        if (!read_number(fields.rp, rp)) return no_number("RP", fields.rp);
        if (!read_number(fields.kelvin, kelvin)) return no_number("the temperature", fields.kelvin);
        if (!other && bp && rp) other = *bp - *rp;
        if (!color_index && other) color_index = color_index_of(temperature_of_bp_rp(*other));
        if (!color_index && usable(kelvin)) color_index = color_index_of(*kelvin);
        if (units.gaia_g && magnitude && other) *magnitude += v_minus_g(*other).value_or(0.0);
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
    std::string problem =
        row.read({field[ra], field[dec], field[v_magnitude], "", field[parallax], field[b_v]}, {});
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

struct Unit {
    double factor;
    std::string_view names;
};

constexpr double degrees_a_radian = 180.0 / real::pi, parsec_a_ly = 1.0 / 3.261563777;
constexpr Unit angles[] = {{1.0, "deg degree degrees d:m:s"},
                           {15.0, "h hr hour hours hourangle h:m:s hms"},
                           {degrees_a_radian, "rad radian radians"},
                           {1.0 / 3600.0, "arcsec"}};
constexpr Unit magnitudes[] = {{1.0, "mag magnitude"}};
constexpr Unit distances[] = {
    {1.0, "pc"}, {1e3, "kpc"}, {1e6, "mpc"}, {parsec_a_ly, "ly lyr"}, {au_pc, "au"}};
constexpr Unit parallaxes[] = {{1.0, "mas"}, {1e3, "arcsec"}, {1e-3, "uas"}, {3.6e6, "deg"}};
constexpr Unit temperatures[] = {{1.0, "k kelvin"}};

/// What a star needs: the columns that hold it, by what Gaia's archive, VizieR, SIMBAD, HYG and people call
/// them, else by how their UCDs begin (IVOA UCD1+ 1.5, and those of before), the best first.
struct Quantity {
    std::string_view name, names, ucds;
    std::span<const Unit> units;
};
enum QuantityId {
    of_ra,
    of_dec,
    of_magnitude,
    of_distance,
    of_parallax,
    of_color_index,
    of_bp_rp,
    of_kelvin
};
constexpr Quantity quantities[] = {
    {"ra", "ra ra_d _raj2000 raj2000 ra_icrs _ra.icrs _ra ra_deg radeg raicrs rarad",
     "pos.eq.ra;meta.main pos.eq.ra pos_eq_ra_main", angles},
    {"dec", "dec dec_d _dej2000 dej2000 de_icrs _de.icrs _de dec_deg dedeg deicrs derad de",
     "pos.eq.dec;meta.main pos.eq.dec pos_eq_dec_main", angles},
    {"mag", "mag vmag v flux_v phot_g_mean_mag gmag hpmag vtmag",
     "phot.mag;em.opt.v phot_jhn_v phot.mag;em.opt phot.mag", magnitudes},
    {"distance", "dist distance", "pos.distance", distances},
    {"parallax", "parallax plx plx_value", "pos.parallax pos_parlx_trig", parallaxes},
    {"B-V", "bv b_v b-v ci", "phot.color;em.opt.b;em.opt.v", magnitudes},
    {"BP-RP", "bp_rp bp-rp", "", magnitudes},
    {"the temperature", "teff teff_gspphot teff_val", "", temperatures}};

std::vector<std::string_view> words_of(std::string_view text) {
    TextRows rows(text);
    return rows.next() ? rows.fields() : std::vector<std::string_view>();
}

struct Column {
    int index = RowTable::none;
    double factor = 1.0;
    std::string unit;    // as the table says it, in lower case; empty: it does not
    std::string by_ucd;  // "k (phot.mag;em.ir.k)"; empty: its name says it
    std::string wrong;   // where there is one but of a unit of something else: "Vmag in 'Jy'"

    Column(const RowTable& table, const Quantity& quantity) {
        std::vector<int> found;
        std::map<int, std::string_view> in_name;  // units: "dist_ly"
        for (const std::string_view name : words_of(quantity.names)) {
            if (const int i = table.column({name}); i != RowTable::none) found.push_back(i);
            for (const Unit& of : quantity.units)
                for (const std::string_view word : words_of(of.names))
                    if (const int i = table.column({fmt::format("{}_{}", name, word)});
                        i != RowTable::none && in_name.try_emplace(i, word).second)
                        found.push_back(i);
        }
        const std::size_t named = found.size();
        for (const std::string_view ucd : words_of(quantity.ucds))
            for (int i = 0; i < int(table.columns().size()); ++i)
                if (const NamedColumn& c = table.columns()[std::size_t(i)];
                    !c.name.empty() && c.ucd.starts_with(ucd) &&
                    std::string_view(";.").find((c.ucd + ";")[ucd.size()]) != std::string_view::npos)
                    found.push_back(i);
        for (std::size_t k = 0; k < found.size() && index == RowTable::none; ++k) {
            const NamedColumn& column = table.columns()[std::size_t(found[k])];
            std::string said = lower_case(column.unit);
            std::erase_if(said, [](char c) { return c == '"' || c == ' ' || c == '[' || c == ']'; });
            if (const auto word = in_name.find(found[k]); said.empty() && word != in_name.end())
                said = word->second;
            if (said == "j2000" || said == "icrs") said.clear();  // a frame, and ours
            const auto known = std::ranges::find_if(quantity.units, [&](const Unit& u) {
                return std::ranges::count(words_of(u.names), said) > 0;
            });
            if (!said.empty() && known == quantity.units.end()) {
                if (wrong.empty())
                    wrong = fmt::format("{} in {}", printable(column.name), shown(column.unit));
                continue;
            }
            index = found[k];
            if (k >= named) by_ucd = fmt::format("{} ({})", printable(column.name), printable(column.ucd));
            factor = said.empty() ? 1.0 : known->factor;
            unit = std::move(said);
        }
    }
};

/// The first column for each quantity.
struct Columns {
    explicit Columns(const RowTable& table) {
        for (const Quantity& quantity : quantities) all.emplace_back(table, quantity);
        const auto is_one_of = [&](const Column& column, std::initializer_list<std::string_view> names) {
            return std::ranges::any_of(names, [&](std::string_view name) {
                return column.index != RowTable::none && column.index == table.column({name});
            });
        };
        bool hyg = true;
        for (const char* const name : {"hip", "hd", "hr", "gl", "proper"})
            hyg = hyg && table.column({name}) != RowTable::none;
        from_hyg =
            hyg || (table.column({"proper"}) != RowTable::none && table.column({"ci"}) != RowTable::none);
        constexpr std::pair<const char*, const char*> pairs[] = {
            {"v", "b"}, {"vmag", "bmag"}, {"flux_v", "flux_b"}};
        for (const auto& [v, b] : pairs)
            if (is_one_of(magnitude(), {v}) && blue == RowTable::none) blue = table.column({b});
        bp = table.column({"phot_bp_mean_mag", "bpmag"});
        rp = table.column({"phot_rp_mean_mag", "rpmag"});
        for (const char* const other : {"hpmag", "vtmag", "phot_g_mean_mag", "gmag"})
            if (is_one_of(magnitude(), {other})) band = other;
        may_be_hours = !hyg && ra().unit.empty() && is_one_of(ra(), {"ra"});
        may_be_radians = ra().unit.empty() && dec().unit.empty() && is_one_of(ra(), {"rarad"}) &&
                         is_one_of(dec(), {"derad"});
        units = {hyg && ra().unit.empty() ? 15.0 : ra().factor,
                 ra().unit.starts_with("d:") ? 1.0 : 15.0,
                 dec().factor,
                 all[of_distance].factor,
                 all[of_parallax].factor,
                 is_one_of(magnitude(), {"phot_g_mean_mag", "gmag"})};
    }

    const Column& ra() const { return all[of_ra]; }
    const Column& dec() const { return all[of_dec]; }
    const Column& magnitude() const { return all[of_magnitude]; }

    bool complete() const { return missing().empty(); }
    /// The same, or it would be if their units were others.
    bool named() const {
        return std::all_of(all.begin(), all.begin() + 3, [](const Column& column) {
            return column.index != RowTable::none || !column.wrong.empty();
        });
    }
    /// Of ra, dec and mag those that it lacks, with what is there in their place.
    std::string missing() const {
        std::string names;
        for (std::size_t i = 0; i < 3; ++i)
            if (all[i].index == RowTable::none)
                names += fmt::format("{}{}{}", names.empty() ? "" : ", ", quantities[i].name,
                                     all[i].wrong.empty() ? "" : " (but " + all[i].wrong + ")");
        return names;
    }
    void warn_of_others(const std::string& name) const {
        if (const std::string& taken = magnitude().by_ucd;
            !taken.empty() && taken.find("em.opt.v") == taken.npos && taken.find("jhn_v") == taken.npos)
            log_warning(fmt::format("{}: {} is taken for the magnitude", printable(name), taken));
        for (std::size_t i = 3; i < all.size(); ++i)
            if (all[i].index == RowTable::none && !all[i].wrong.empty())
                log_warning(fmt::format("{}: {} is not followed as {}", printable(name), all[i].wrong,
                                        quantities[i].name));
    }

    std::vector<Column> all;
    RowUnits units;
    int blue = RowTable::none, bp = RowTable::none, rp = RowTable::none;
    std::string band;  // of the magnitude, where it is not V
    bool from_hyg = false, may_be_hours = false, may_be_radians = false;
};

std::string read_table_row(const RowTable& table, const Columns& columns, CatalogueStar& star) {
    StarRow row;
    const auto field = [&](QuantityId id) { return table.field(columns.all[id].index); };
    std::string problem =
        row.read({field(of_ra), field(of_dec), field(of_magnitude), field(of_distance), field(of_parallax),
                  field(of_color_index), table.field(columns.blue), field(of_bp_rp), table.field(columns.bp),
                  table.field(columns.rp), field(of_kelvin)},
                 columns.units);
    if (columns.from_hyg && row.distance_pc && *row.distance_pc >= hyg_unknown_pc) row.distance_pc.reset();
    return problem.empty() ? row.to_star(star) : problem;
}

/// Right ascensions that no sky in degrees has are hours, or radians; `name` begins the warnings, of
/// magnitudes that stay those of another band too.
void set_units(StarCatalogue& catalogue, const Columns& columns, const std::string& name) {
    std::vector<CatalogueStar>& stars = catalogue.stars;
    if (stars.empty()) return;
    const bool to_v = columns.units.gaia_g &&
                      (columns.all[of_bp_rp].index != RowTable::none || columns.bp != RowTable::none);
    const auto others =
        columns.band.empty() ? 0 : std::ranges::count_if(stars, [&](const CatalogueStar& star) {
            return !to_v || !star.color_index;
        });
    if (others > 0)
        log_warning(fmt::format("{}: {} is taken for V, of {}", printable(name), columns.band,
                                counted(others, "star")));
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
    return std::ranges::none_of(
               std::array{columns.ra().index, columns.dec().index, columns.magnitude().index},
               [&](int column) {
                   return table.field(column).find_first_of("0123456789") != std::string_view::npos;
               }) &&
           !table.field(columns.ra().index).empty();
}

/// From the present row on, `above` lines below the first. Throws Cancelled.
void add_rows(StarCatalogue& catalogue, RowTable& table, const Columns& columns, std::int64_t above,
              const Progress& progress) {
    do {
        catalogue.add(table.line() + above, progress,
                      [&](CatalogueStar& star) { return read_table_row(table, columns, star); });
    } while (table.next());
}

/// Throws InputError where the columns of ra, dec or mag are missing; Cancelled.
StarCatalogue parse_columns(std::string_view all, const std::string& name, const Progress& progress) {
    const std::string_view text = from_header(all);
    const auto above = std::count(all.begin(), all.begin() + (text.data() - all.data()), '\n');
    TextTable table(text);
    table.take_units(all);
    Columns columns(table);
    const auto require = [&] {
        if (!columns.complete())
            bad_input(name, fmt::format("line {}", table.line()),
                      "a Hipparcos catalogue, or names of columns with ra, dec and mag among them",
                      fmt::format("no {} in '{}'", columns.missing(),
                                  printable(table.header().substr(0, most_shown))));
    };
    require();
    StarCatalogue catalogue;
    bool more = table.next();
    for (; more && is_below_header(table, columns); more = table.next()) {
        table.take_units();
        columns = Columns(table);
        require();
    }
    columns.warn_of_others(name);
    if (more) add_rows(catalogue, table, columns, above, progress);
    set_units(catalogue, columns, name);
    return catalogue;
}

/// Of the first table that has stars. Throws InputError where none has; Cancelled.
StarCatalogue parse_tables(const std::vector<FileTable>& tables, const std::string& name,
                           const Progress& progress) {
    const auto is_complete = [](const FileTable& table) { return Columns(*table.rows).complete(); };
    const auto taken = std::ranges::find_if(tables, is_complete);
    if (taken == tables.end())
        bad_input(name, "a table with ra, dec and mag among its columns",
                  tables.size() == 1 ? "no " + Columns(*tables[0].rows).missing()
                                     : fmt::format("none in {}", counted(std::ssize(tables), "table")));
    if (const auto count = std::ranges::count_if(tables, is_complete); count > 1)
        log_warning(
            fmt::format("{}: {} tables hold stars; {} is taken", printable(name), count, taken->title));
    RowTable& table = *taken->rows;
    const Columns columns(table);
    columns.warn_of_others(name);
    StarCatalogue catalogue;
    catalogue.bad.place = "row";
    if (table.next()) add_rows(catalogue, table, columns, 0, progress);
    set_units(catalogue, columns, name);
    return catalogue;
}

bool is_hipparcos(std::string_view first_line) {
    const std::string_view line = trim(first_line);
    return line.starts_with('H') && trim(line.substr(1)).starts_with('|');
}

StarCatalogue with_stars(StarCatalogue catalogue, const std::string& name) {
    if (catalogue.stars.empty())
        bad_input(name, "at least one star",
                  catalogue.rows == 0 ? "none" : "none: " + catalogue.bad.text(catalogue.rows));
    return catalogue;
}

}  // namespace

bool is_catalogue(std::string_view text) {
    TextRows rows(text);
    return is_votable(text) ||
           (rows.next() && (is_hipparcos(rows.text()) || Columns(TextTable(from_header(text))).complete()));
}

bool is_fits_catalogue(const fs::path& file) {
    if (!is_fits(file) || is_xisf(file) || has_fits_picture(file)) return false;
    return std::ranges::any_of(fits_tables(file),
                               [](const FileTable& table) { return Columns(*table.rows).named(); });
}

StarCatalogue parse_catalogue(std::string text, const std::string& name, const Progress& progress) {
    if (is_votable(text))
        return with_stars(parse_tables(votables(std::move(text), name, progress), name, progress), name);
    TextRows first(text, name);
    if (!first.next()) bad_input(name, "a star catalogue", "an empty file");
    return with_stars(
        is_hipparcos(first.text()) ? parse_hipparcos(text, progress) : parse_columns(text, name, progress),
        name);
}

StarCatalogue read_catalogue(const fs::path& file, const Progress& progress) {
    if (is_fits(file) && !is_xisf(file))
        return with_stars(parse_tables(fits_tables(file, progress), file.string(), progress), file.string());
    return parse_catalogue(read_unpacked(file, progress, table_bounds), file.string(), progress);
}

}  // namespace astrosplat
