// CFITSIO calls, each checked, behind two functions.
#include "source/fits.h"

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/packed_file.h"
#include "core/real.h"
#include "core/text.h"
#include "source/fits_file.h"
#include "source/value_layout.h"
#include "source/xisf.h"

namespace astrosplat {
namespace {

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
    check_fits(file, fmt::format("moving to HDU {}", number), status);
    hdu.name = fits_text(in, "EXTNAME");
    hdu.kind = "table";
    if (type != IMAGE_HDU) return hdu;
    int naxis = 0;
    std::array<LONGLONG, 99> axes{};
    fits_get_img_paramll(in, int(axes.size()), &hdu.bitpix, &naxis, axes.data(), &status);
    check_fits(file, fmt::format("reading the header of HDU {}", number), status);
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
    check_fits(file, "reading the pixels", status);
}

constexpr std::int64_t most_bytes_a_pixel = 8;

// Of one tile, as the header says.
std::int64_t tile_pixels(fitsfile* in) {
    int axes = 0;
    read_fits_keyword(in, TINT, "ZNAXIS", &axes);
    std::int64_t pixels = 1;
    for (int i = 1; i <= axes; ++i) {
        LONGLONG side = 1;
        const bool tiled = read_fits_keyword(in, TLONGLONG, fmt::format("ZTILE{}", i).c_str(), &side);
        if (!tiled && i == 1) read_fits_keyword(in, TLONGLONG, "ZNAXIS1", &side);  // rows of the picture
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
    if (fits_text(in, "ZCMPTYPE").starts_with("GZIP")) check_column(file, in, "COMPRESSED_DATA", most);
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

// Names that observatories give to what is no picture of the sky.
bool is_auxiliary(const FitsHdu& hdu) {
    constexpr std::array names{"dq",   "err",   "error",       "wht",        "weight",   "con",
                               "ctx",  "var",   "var_poisson", "var_rnoise", "var_flat", "mask",
                               "stat", "sigma", "uncert",      "bpm"};
    return std::ranges::find(names, lower_case(hdu.name)) != names.end();
}

// Whether `count` values from `first` on are all the same, or none.
bool is_blank(const fs::path& file, fitsfile* in, std::int64_t first, std::int64_t count,
              const Progress& progress) {
    constexpr std::int64_t portion = std::int64_t{1} << 18;
    Buffer<double> values(std::size_t(std::min(portion, count)));
    double known = std::numeric_limits<double>::quiet_NaN();
    for (std::int64_t done = 0; done < count; done += portion) {
        const std::int64_t n = std::min(portion, count - done);
        read_into(file, in, first + done, n, progress, values.data());
        for (std::int64_t i = 0; i < n; ++i) {
            if (!std::isfinite(values[i])) continue;
            if (!std::isnan(known) && values[i] != known) return false;
            known = values[i];
        }
    }
    return true;
}

FitsHdu automatic_hdu(const fs::path& file, fitsfile* in, int count, const Progress& progress) {
    std::vector<FitsHdu> pictures;
    for (int i = 0; i < count; ++i)
        if (FitsHdu hdu = go_to_hdu(file, in, i); hdu.picture) pictures.push_back(std::move(hdu));
    if (pictures.empty()) bad_input(file, "an HDU with a picture", fmt::format("none in {} HDUs", count));
    const auto is_science = [](const FitsHdu& hdu) { return lower_case(hdu.name) == "sci"; };
    auto taken = std::ranges::find_if(pictures, is_science);
    const bool named = taken != pictures.end();
    const auto shows = [&](const FitsHdu& hdu) {
        if (is_auxiliary(hdu)) return false;
        if (pictures.size() == 1) return true;
        go_to_hdu(file, in, hdu.number);
        check_tiles(file, in);
        return !is_blank(file, in, 0, product(file, hdu.axes), progress);
    };
    if (!named) taken = std::ranges::find_if(pictures, shows);
    if (taken == pictures.end()) taken = pictures.begin();
    if (pictures.size() > 1 && (!named || std::ranges::count_if(pictures, is_science) > 1))
        log_warning(fmt::format(
            "{}: {} HDUs hold pictures; HDU {}{}{} is taken (hdu = NAME or NUMBER takes another)",
            file.string(), pictures.size(), taken->number, taken->name.empty() ? "" : " ", taken->name));
    return go_to_hdu(file, in, taken->number);
}

FitsHdu find_hdu(const fs::path& file, fitsfile* in, const std::string& wanted, const Progress& progress) {
    const int count = fits_hdu_count(file, in);
    if (wanted == "auto") return automatic_hdu(file, in, count, progress);
    const std::optional<std::int64_t> number = parse_int64(wanted);
    if (number && (*number < 0 || *number >= count))
        bad_input(file, fmt::format("an HDU from 0 to {}", count - 1), fmt::format("hdu = {}", wanted));
    for (int i = 0; i < count; ++i) {
        const FitsHdu hdu = go_to_hdu(file, in, i);
        if (number ? *number != i : lower_case(hdu.name) != lower_case(wanted)) continue;
        if (!hdu.picture) bad_input(file, fmt::format("HDU {}", i), "a picture", "none (" + hdu.kind + ")");
        return hdu;
    }
    bad_input(file, fmt::format("an HDU named '{}'", wanted), fmt::format("none in {} HDUs", count));
}

// Of the current HDU, as cards of 80 characters. Of compressed pictures the table's: what lies on the sky it
// says with the picture's own keywords (FITS 4.0, section 10.1.2). CFITSIO 4.2's conversion of such a header
// fails where the picture was an extension.
std::string cards_of(const fs::path& file, fitsfile* in) {
    char* cards = nullptr;
    int count = 0, status = 0;
    fits_hdr2str(in, 1, nullptr, 0, &cards, &count, &status);
    check_fits(file, "reading the header", status);
    std::string text(cards, std::size_t(count) * 80);
    fits_free_memory(cards, &status);
    return text;
}

// Of an axis of three: not those of a spectrum, of polarisation or of time.
bool is_of_colors(fitsfile* in, std::size_t axis) {
    const std::string type = lower_case(fits_text(in, fmt::format("CTYPE{}", axis + 1).c_str()));
    constexpr std::array others{"freq", "velo", "vrad", "vopt", "wave",   "awav", "ener",
                                "wavn", "zopt", "beta", "felo", "stokes", "time", "utc"};
    return std::ranges::none_of(others, [&](const char* other) { return type.starts_with(other); });
}

// The letters belong to a picture as a camera stores it, from its top on. What says that it was turned over
// begins with the other row; of what says nothing the rows are as the camera's.
std::optional<std::array<int, 4>> bayer_pattern(fitsfile* in, const std::string& letters, bool bottom_up) {
    int x = 0, y = 0;
    read_fits_keyword(in, TINT, "XBAYROFF", &x);
    read_fits_keyword(in, TINT, "YBAYROFF", &y);
    return bayer_channels(letters, x, bottom_up ? y + 1 : y);
}

// As most cameras' programs write it, or MaxIm and those after it, which have other words there too.
std::string bayer_letters(fitsfile* in) {
    const std::string letters = fits_text(in, "BAYERPAT"), older = fits_text(in, "COLORTYP");
    return letters.empty() && bayer_channels(older, 0, 0) ? older : letters;
}

ValueLayout layout_of(const fs::path& file, fitsfile* in, const FitsHdu& hdu, std::optional<int> plane,
                      const Progress& progress) {
    const std::vector<std::int64_t> axes = picture_axes(hdu.axes);
    ValueLayout layout;
    using Values = ValueLayout::Values;
    const std::string order = fits_text(in, "ROWORDER");
    layout.top_down = order == "TOP-DOWN";
    if (!order.empty() && !layout.top_down && order != "BOTTOM-UP")
        log_warning(fmt::format("{}: ROWORDER = '{}' is not followed: the first row is the lowest",
                                file.string(), order));
    const bool by_pixel =
        axes.size() == 3 && axes[0] == 3 && axes[1] > 3 && axes[2] > 3 && is_of_colors(in, 0);
    layout.width = axes[by_pixel ? 1 : 0];
    layout.height = axes[by_pixel ? 2 : 1];
    const std::int64_t pixels = product(file, {layout.width, layout.height});
    const std::int64_t planes = product(file, hdu.axes) / pixels;
    if (plane && (*plane < 0 || *plane >= planes))
        bad_input(file, fmt::format("HDU {}", hdu.number), fmt::format("a plane from 0 to {}", planes - 1),
                  fmt::format("plane = {}", *plane));
    layout.stride = by_pixel ? 3 : 1;
    if (plane || planes == 1) {
        layout.first = plane.value_or(0) * (by_pixel ? 1 : pixels);
        const std::string letters = bayer_letters(in);
        const auto pattern = plane ? std::nullopt : bayer_pattern(in, letters, order == "BOTTOM-UP");
        if (pattern && layout.width > 1 && layout.height > 1) {
            layout.values = Values::bayer;
            layout.pattern = *pattern;
            layout.what = fmt::format("Bayer's mosaic {}", letters);
        } else if (!plane && !letters.empty()) {
            log_warning(fmt::format("{}: BAYERPAT = '{}' is not followed: the picture stays grey",
                                    file.string(), letters));
        }
        return layout;
    }
    if (by_pixel) {
        layout.values = Values::by_pixel;
        return layout;
    }
    if (planes == 3 && axes.size() == 3 && is_of_colors(in, 2)) {
        layout.values = Values::planes;
        layout.what = "3 planes as red, green and blue";
        return layout;
    }
    std::int64_t taken = 0;
    while (taken < planes && is_blank(file, in, taken * pixels, pixels, progress)) ++taken;
    if (taken == planes) taken = 0;
    layout.first = taken * pixels;
    layout.what = fmt::format("plane {} of {}", taken, planes);
    log_warning(fmt::format("{}: it has {} planes; plane {} is taken{} (plane = N takes another)",
                            file.string(), planes, taken, taken > 0 ? ", the first that is not blank" : ""));
    return layout;
}

}  // namespace

void check_fits(const fs::path& file, std::string_view doing, int status) {
    if (status == 0) return;
    std::array<char, FLEN_ERRMSG> reason{};
    fits_get_errstatus(status, reason.data());
    fits_clear_errmsg();
    throw InputError(fmt::format("{}: FITS {} failed: {}", file.string(), doing, reason.data()));
}

void FitsClose::operator()(fitsfile* file) const {
    int status = 0;
    fits_close_file(file, &status);
}

FitsFile open_fits(const fs::path& file, const Progress& progress) {
    require_readable(file);
    fitsfile* handle = nullptr;
    int status = 0;
    if (!is_packed(read_beginning(file, 4))) {
        check_fits_headers(file);
        fits_open_diskfile(&handle, file.c_str(), READONLY, &status);
        check_fits(file, "opening", status);
        return FitsFile(handle);
    }
    FitsClose close{std::make_unique<FitsClose::Memory>()};
    FitsClose::Memory& memory = *close.memory;
    memory.bytes = read_unpacked(file, progress);
    check_fits_headers(file, &memory.bytes);
    memory.begin = memory.bytes.data();
    memory.size = memory.bytes.size();
    fits_open_memfile(&handle, "unpacked", READONLY, &memory.begin, &memory.size, 0, nullptr, &status);
    check_fits(file, "opening", status);
    return FitsFile(handle, std::move(close));
}

bool read_fits_keyword(fitsfile* in, int type, const char* keyword, void* value) {
    int status = 0;
    fits_read_key(in, type, keyword, value, nullptr, &status);
    fits_clear_errmsg();
    return status == 0;
}

std::string fits_text(fitsfile* in, const char* keyword) {
    std::array<char, FLEN_VALUE> value{};
    return read_fits_keyword(in, TSTRING, keyword, value.data()) ? std::string(trim(value.data())) : "";
}

int fits_hdu_count(const fs::path& file, fitsfile* in) {
    int count = 0, status = 0;
    fits_get_num_hdus(in, &count, &status);
    check_fits(file, "reading the headers", status);
    return count;
}

bool is_fits(const fs::path& file) {
    const FileFormat* const format = format_of_file(file);
    return format && (format->id == "fits" || format->id == "xisf");
}

bool has_fits_picture(const fs::path& file) {
    const FitsFile in = open_fits(file);
    const int count = fits_hdu_count(file, in.get());
    for (int i = 0; i < count; ++i)
        if (go_to_hdu(file, in.get(), i).picture) return true;
    return false;
}

void require_fits_picture(const fs::path& file) {
    if (is_xisf(file)) return void(open_xisf_rows(file, "auto", {}, {}));
    const FitsFile in = open_fits(file);
    find_hdu(file, in.get(), "auto", {});
}

std::vector<FitsHdu> describe_fits(const fs::path& file, const Progress& progress) {
    if (is_xisf(file)) return describe_xisf(file, progress);
    const FitsFile in = open_fits(file, progress);
    std::vector<FitsHdu> hdus;
    const int count = fits_hdu_count(file, in.get());
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

FitsRows open_fits_rows(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                        const Progress& progress) {
    if (is_xisf(file)) return open_xisf_rows(file, hdu, plane, progress);
    const std::shared_ptr<fitsfile> in(open_fits(file, progress));
    const FitsHdu found = find_hdu(file, in.get(), hdu, progress);
    check_tiles(file, in.get());
    const ValueLayout layout = layout_of(file, in.get(), found, plane, progress);
    FitsRows rows;
    FitsPlane& picture = rows.plane;
    picture.width = layout.width;
    picture.height = layout.height;
    picture.channels = layout.channels();
    picture.hdu = found.number;
    picture.name = found.name;
    picture.what = layout.what;
    const auto text = [&](const char* keyword) { return fits_text(in.get(), keyword); };
    picture.credit = text("AUTHOR");
    if (picture.credit.empty()) picture.credit = text("ORIGIN");
    picture.object = text("OBJECT");
    picture.exposure = {text("TELESCOP"), text("INSTRUME"), "", "", text("FILTER"), ""};
    picture.distance_ly = distance_ly_of(in.get());
    picture.sky = read_fits_sky(file, cards_of(file, in.get()), layout.height, layout.top_down);
    rows.read = rows_of_values(layout, [=](std::int64_t first, std::int64_t count, double* values) {
        read_into(file, in.get(), first, count, progress, values);
    });
    return rows;
}

FitsPlane read_fits(const fs::path& file, const std::string& hdu, std::optional<int> plane,
                    const Progress& progress) {
    return whole_plane(open_fits_rows(file, hdu, plane, progress), file);
}

FitsPlane whole_plane(FitsRows rows, const fs::path& file) {
    FitsPlane result = std::move(rows.plane);
    result.values = room_for(file, result.width * result.height * result.channels);
    rows.read(0, result.height, result.values.data());
    return result;
}

}  // namespace astrosplat
