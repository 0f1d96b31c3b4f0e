// CFITSIO calls, each checked, behind two functions.
#include "source/fits.h"

#include <fitsio.h>
#include <fmt/format.h>
#include <zlib.h>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/memory.h"
#include "core/real.h"
#include "core/text.h"

namespace astrosplat {
namespace {

struct Close {
    void operator()(fitsfile* file) const {
        int status = 0;
        fits_close_file(file, &status);
    }
};
using Handle = std::unique_ptr<fitsfile, Close>;

// Throws where CFITSIO did not succeed.
void check(const fs::path& file, std::string_view doing, int status) {
    if (status == 0) return;
    std::array<char, FLEN_ERRMSG> reason{};
    fits_get_errstatus(status, reason.data());
    fits_clear_errmsg();
    throw InputError(fmt::format("{}: FITS {} failed: {}", file.string(), doing, reason.data()));
}

// The plain name: brackets and blanks in it mean nothing special.
Handle open_fits(const fs::path& file) {
    require_readable(file);
    check_fits_headers(file);
    fitsfile* handle = nullptr;
    int status = 0;
    fits_open_diskfile(&handle, file.c_str(), READONLY, &status);
    check(file, "opening", status);
    return Handle(handle);
}

// False where the header has none.
bool read_keyword(fitsfile* in, int type, const char* keyword, void* value) {
    int status = 0;
    fits_read_key(in, type, keyword, value, nullptr, &status);
    fits_clear_errmsg();
    return status == 0;
}

std::string text_keyword(fitsfile* in, const char* keyword) {
    std::array<char, FLEN_VALUE> value{};
    return read_keyword(in, TSTRING, keyword, value.data()) ? std::string(trim(value.data())) : "";
}

// DISTANCE with its unit in brackets at the beginning of the comment (FITS 4.0, section 4.3): light years.
// Without one, or with another, it could be anything.
std::optional<double> distance_ly_of(fitsfile* in) {
    constexpr std::array<std::pair<std::string_view, double>, 6> units{{{"[Mpc]", 1e6 * parsec_ly},
                                                                        {"[kpc]", 1e3 * parsec_ly},
                                                                        {"[pc]", parsec_ly},
                                                                        {"[Mlyr]", 1e6},
                                                                        {"[klyr]", 1e3},
                                                                        {"[lyr]", 1.0}}};
    double value = 0.0;
    std::array<char, FLEN_COMMENT> comment{};
    int status = 0;
    fits_read_key(in, TDOUBLE, "DISTANCE", &value, comment.data(), &status);
    fits_clear_errmsg();
    const auto unit = std::ranges::find_if(
        units, [&](const auto& known) { return std::string_view(comment.data()).starts_with(known.first); });
    if (status != 0 || !(value > 0.0) || !std::isfinite(value) || unit == units.end()) return {};
    return value * unit->second;
}

int hdu_count(const fs::path& file, fitsfile* in) {
    int count = 0, status = 0;
    fits_get_num_hdus(in, &count, &status);
    check(file, "reading the headers", status);
    return count;
}

// Axes as they matter for pictures: those of length 1 dropped while more than two are left.
std::vector<std::int64_t> picture_axes(std::vector<std::int64_t> axes) {
    for (std::size_t i = axes.size(); i-- > 0 && axes.size() > 2;)
        if (axes[i] == 1) axes.erase(axes.begin() + std::ptrdiff_t(i));
    return axes;
}

// Moves there and describes it, without statistics.
FitsHdu go_to_hdu(const fs::path& file, fitsfile* in, int number) {
    FitsHdu hdu;
    hdu.number = number;
    int type = 0, status = 0;
    fits_movabs_hdu(in, number + 1, &type, &status);
    check(file, fmt::format("moving to HDU {}", number), status);
    hdu.name = text_keyword(in, "EXTNAME");
    hdu.kind = "table";
    if (type != IMAGE_HDU) return hdu;
    int naxis = 0;
    std::array<LONGLONG, 99> axes{};
    fits_get_img_paramll(in, int(axes.size()), &hdu.bitpix, &naxis, axes.data(), &status);
    check(file, fmt::format("reading the header of HDU {}", number), status);
    hdu.axes.assign(axes.begin(), axes.begin() + naxis);
    const bool empty = naxis == 0 || std::ranges::find(hdu.axes, 0) != hdu.axes.end();
    int ignored = 0;
    hdu.kind = empty ? "empty" : fits_is_compressed_image(in, &ignored) ? "compressed image" : "image";
    hdu.picture = !empty && naxis >= 2;
    return hdu;
}

std::int64_t product(const fs::path& file, const std::vector<std::int64_t>& axes) {
    std::int64_t count = 1;
    for (const std::int64_t n : axes)
        if (n < 0 || __builtin_mul_overflow(count, n, &count))
            bad_input(file, "axes of a picture", fmt::format("{}", fmt::join(axes, " x ")));
    return count;
}

// `count` physical values of the current HDU from element `first` (from 0) on; NaN where undefined.
void read_into(const fs::path& file, fitsfile* in, std::int64_t first, std::int64_t count,
               const Progress& progress, double* values) {
    double undefined = std::numeric_limits<double>::quiet_NaN();
    int any_undefined = 0, status = 0;
    constexpr std::int64_t portion = std::int64_t{1} << 22;
    for (std::int64_t done = 0; done < count && status == 0; done += portion) {
        progress.check();
        fits_read_img(in, TDOUBLE, first + done + 1, std::min(portion, count - done), &undefined,
                      values + done, &any_undefined, &status);
    }
    check(file, "reading the pixels", status);
}

constexpr std::int64_t most_bytes_a_pixel = 8;

// Of one tile, as the header says.
std::int64_t tile_pixels(fitsfile* in) {
    int axes = 0;
    read_keyword(in, TINT, "ZNAXIS", &axes);
    std::int64_t pixels = 1;
    for (int i = 1; i <= axes; ++i) {
        LONGLONG side = 1;
        const bool tiled = read_keyword(in, TLONGLONG, fmt::format("ZTILE{}", i).c_str(), &side);
        if (!tiled && i == 1) read_keyword(in, TLONGLONG, "ZNAXIS1", &side);  // rows of the picture
        pixels *= side;
    }
    return pixels;
}

// Whether `bytes` are one gzip stream of at most `most` bytes.
bool inflates(std::vector<unsigned char>& bytes, std::int64_t most) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 32) != Z_OK) return false;
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
    stream.next_in = bytes.data();
    stream.avail_in = static_cast<uInt>(bytes.size());
    std::array<unsigned char, 1 << 16> out;
    int result = Z_OK;
    while (result == Z_OK && std::int64_t(stream.total_out) <= most) {
        stream.next_out = out.data();
        stream.avail_out = out.size();
        result = inflate(&stream, Z_NO_FLUSH);
    }
    return result == Z_STREAM_END && std::int64_t(stream.total_out) <= most;
}

void check_column(const fs::path& file, fitsfile* in, const char* name, std::int64_t most) {
    int column = 0, status = 0;
    char* const wanted = const_cast<char*>(name);  // CFITSIO reads it only
    if (fits_get_colnum(in, CASEINSEN, wanted, &column, &status) != 0) return fits_clear_errmsg();
    LONGLONG rows = 0;
    fits_get_num_rowsll(in, &rows, &status);
    std::vector<unsigned char> bytes;
    for (LONGLONG row = 1; row <= rows && status == 0; ++row) {
        LONGLONG length = 0, offset = 0;
        fits_read_descriptll(in, column, row, &length, &offset, &status);
        if (status != 0 || length == 0) continue;
        const bool possible = length > 0 && length <= 2 * most + 1024;  // gzip itself adds a few bytes
        if (possible) {
            bytes.resize(std::size_t(length));
            fits_read_col(in, TBYTE, column, row, 1, length, nullptr, bytes.data(), nullptr, &status);
        }
        if (!possible || status != 0 || !inflates(bytes, most)) {
            fits_clear_errmsg();
            bad_input(file, fmt::format("tile {}", row), fmt::format("gzip data of at most {} bytes", most),
                      "something else");
        }
    }
}

// Inflates every gzip tile of the current HDU into nothing: on a damaged one CFITSIO asks for more and more
// memory without end. Throws InputError "FILE: tile n: expected ..." for one that ends early, holds anything
// else or more than its pixels. Pictures compressed otherwise pass.
void check_gzip_tiles(const fs::path& file, fitsfile* in) {
    const std::int64_t most = most_bytes_a_pixel * tile_pixels(in);
    if (text_keyword(in, "ZCMPTYPE").starts_with("GZIP")) check_column(file, in, "COMPRESSED_DATA", most);
    check_column(file, in, "GZIP_COMPRESSED_DATA", most);  // where another method would have lost something
}

void check_tiles(const fs::path& file, fitsfile* in) {
    int ignored = 0;
    if (fits_is_compressed_image(in, &ignored)) check_gzip_tiles(file, in);
}

// Memory for so many values, announced.
Buffer<double> room_for(const fs::path& file, std::int64_t count) {
    if (count > std::numeric_limits<std::int64_t>::max() / 64)
        bad_input(file, "a picture that fits into memory", fmt::format("{} values", count));
    claim_memory(count * 8, fmt::format("reading {}", file.string()));
    return Buffer<double>(std::size_t(count));
}

FitsHdu find_hdu(const fs::path& file, fitsfile* in, const std::string& wanted) {
    const int count = hdu_count(file, in);
    const std::optional<std::int64_t> number = parse_int64(wanted);
    if (number && (*number < 0 || *number >= count))
        bad_input(file, fmt::format("an HDU from 0 to {}", count - 1), fmt::format("hdu = {}", wanted));
    for (int i = 0; i < count; ++i) {
        const FitsHdu hdu = go_to_hdu(file, in, i);
        const bool asked = wanted == "auto" ? hdu.picture
                           : number         ? *number == i
                                            : lower_case(hdu.name) == lower_case(wanted);
        if (!asked) continue;
        if (!hdu.picture) bad_input(file, fmt::format("HDU {}", i), "a picture", "none (" + hdu.kind + ")");
        return hdu;
    }
    if (wanted == "auto") bad_input(file, "an HDU with a picture", fmt::format("none in {} HDUs", count));
    bad_input(file, fmt::format("an HDU named '{}'", wanted), fmt::format("none in {} HDUs", count));
}

// A plane's rows lie from its lowest one on.
void swap_rows(std::int64_t width, std::int64_t rows, double* values) {
    for (std::int64_t y = 0; y < rows / 2; ++y)
        std::swap_ranges(values + y * width, values + (y + 1) * width, values + (rows - 1 - y) * width);
}

std::optional<double> number_keyword(fitsfile* in, const std::string& keyword) {
    double value = 0.0;
    if (!read_keyword(in, TDOUBLE, keyword.c_str(), &value) || !std::isfinite(value)) return {};
    return value;
}

// CD, or CDELT with PC or CROTA2 (Greisen and Calabretta 2002, A&A 395, 1061).
std::optional<std::array<double, 4>> degrees_per_pixel(fitsfile* in) {
    constexpr std::array axes{"1_1", "1_2", "2_1", "2_2"};
    std::array<double, 4> cd{};
    bool any = false;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::optional<double> value = number_keyword(in, fmt::format("CD{}", axes[i]));
        any = any || value;
        cd[i] = value.value_or(0.0);
    }
    if (any) return cd;
    const auto across = number_keyword(in, "CDELT1"), up = number_keyword(in, "CDELT2");
    if (!across || !up || *across == 0.0 || *up == 0.0) return {};
    const double turn = real::radians(number_keyword(in, "CROTA2").value_or(0.0));
    const std::array<double, 4> turned{real::cos(turn), -real::sin(turn) * *up / *across,
                                       real::sin(turn) * *across / *up, real::cos(turn)};
    for (std::size_t i = 0; i < 4; ++i)
        cd[i] =
            (i < 2 ? *across : *up) * number_keyword(in, fmt::format("PC{}", axes[i])).value_or(turned[i]);
    return cd;
}

std::optional<FitsSky> sky_of(fitsfile* in) {
    if (text_keyword(in, "CTYPE1").substr(0, 8) != "RA---TAN" ||
        text_keyword(in, "CTYPE2").substr(0, 8) != "DEC--TAN")
        return {};
    const auto x = number_keyword(in, "CRPIX1"), y = number_keyword(in, "CRPIX2");
    const auto ra = number_keyword(in, "CRVAL1"), dec = number_keyword(in, "CRVAL2");
    const auto cd = degrees_per_pixel(in);
    if (!x || !y || !ra || !dec || !cd) return {};
    const double whole = (*cd)[0] * (*cd)[3] - (*cd)[1] * (*cd)[2];
    if (!(std::fabs(whole) > 0.0)) return {};
    return FitsSky{{*x, *y}, {*ra, *dec}, *cd};
}

}  // namespace

bool is_fits(const fs::path& file) {
    const FileFormat* const format = format_of_file(file);
    return format && format->id == "fits";
}

void require_fits_picture(const fs::path& file) {
    const Handle in = open_fits(file);
    find_hdu(file, in.get(), "auto");
}

std::vector<FitsHdu> describe_fits(const fs::path& file, const Progress& progress) {
    const Handle in = open_fits(file);
    std::vector<FitsHdu> hdus;
    const int count = hdu_count(file, in.get());
    for (int i = 0; i < count; ++i) {
        FitsHdu hdu = go_to_hdu(file, in.get(), i);
        if (hdu.kind == "image" || hdu.kind == "compressed image") {
            Buffer<double> values = room_for(file, product(file, hdu.axes));
            check_tiles(file, in.get());
            read_into(file, in.get(), 0, std::ssize(values), progress, values.data());
            hdu.range = value_range(values);
            hdu.nan_count = std::ranges::count_if(values, [](double v) { return std::isnan(v); });
        }
        hdus.push_back(std::move(hdu));
    }
    return hdus;
}

FitsRows open_fits_rows(const fs::path& file, const std::string& hdu, int plane, const Progress& progress) {
    const std::shared_ptr<fitsfile> in(open_fits(file));
    const FitsHdu found = find_hdu(file, in.get(), hdu);
    const std::vector<std::int64_t> axes = picture_axes(found.axes);
    const std::int64_t pixels = product(file, {axes[0], axes[1]});
    const std::int64_t planes = product(file, found.axes) / pixels;
    if (plane < 0 || plane >= planes)
        bad_input(file, fmt::format("HDU {}", found.number), fmt::format("a plane from 0 to {}", planes - 1),
                  fmt::format("plane = {}", plane));
    FitsRows rows;
    rows.plane.width = axes[0];
    rows.plane.height = axes[1];
    rows.plane.hdu = found.number;
    rows.plane.name = found.name;
    rows.plane.credit = text_keyword(in.get(), "AUTHOR");
    if (rows.plane.credit.empty()) rows.plane.credit = text_keyword(in.get(), "ORIGIN");
    rows.plane.object = text_keyword(in.get(), "OBJECT");
    rows.plane.distance_ly = distance_ly_of(in.get());
    rows.plane.sky = sky_of(in.get());
    check_tiles(file, in.get());
    rows.read = [=, width = axes[0], height = axes[1]](std::int64_t begin, std::int64_t end, double* values) {
        read_into(file, in.get(), pixels * plane + (height - end) * width, (end - begin) * width, progress,
                  values);
        swap_rows(width, end - begin, values);
    };
    return rows;
}

FitsPlane read_fits(const fs::path& file, const std::string& hdu, int plane, const Progress& progress) {
    FitsRows rows = open_fits_rows(file, hdu, plane, progress);
    FitsPlane result = std::move(rows.plane);
    result.values = room_for(file, result.width * result.height);
    rows.read(0, result.height, result.values.data());
    return result;
}

}  // namespace astrosplat
