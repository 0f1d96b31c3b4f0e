#include "source/fits_tiles.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/error.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t most_bytes_a_pixel = 8;

// Of one tile, as the header says.
std::int64_t tile_pixels(fitsfile* in) {
    int status = 0, axes = 0;
    fits_read_key(in, TINT, "ZNAXIS", &axes, nullptr, &status);
    std::int64_t pixels = 1;
    for (int i = 1; status == 0 && i <= axes; ++i) {
        LONGLONG side = 1;
        fits_read_key(in, TLONGLONG, fmt::format("ZTILE{}", i).c_str(), &side, nullptr, &status);
        if (status == KEY_NO_EXIST) {  // rows of the picture
            status = 0;
            if (i == 1) fits_read_key(in, TLONGLONG, "ZNAXIS1", &side, nullptr, &status);
        }
        pixels *= side;
    }
    fits_clear_errmsg();
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
    while (result == Z_OK && static_cast<std::int64_t>(stream.total_out) <= most) {
        stream.next_out = out.data();
        stream.avail_out = out.size();
        result = inflate(&stream, Z_NO_FLUSH);
    }
    return result == Z_STREAM_END && static_cast<std::int64_t>(stream.total_out) <= most;
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
            bytes.resize(static_cast<std::size_t>(length));
            fits_read_col(in, TBYTE, column, row, 1, length, nullptr, bytes.data(), nullptr, &status);
        }
        if (!possible || status != 0 || !inflates(bytes, most)) {
            fits_clear_errmsg();
            bad_input(file.string(), fmt::format("tile {}", row),
                      fmt::format("gzip data of at most {} bytes", most), "something else");
        }
    }
}

}  // namespace

void check_gzip_tiles(const fs::path& file, fitsfile* in) {
    std::array<char, FLEN_VALUE> method{};
    int status = 0;
    fits_read_key(in, TSTRING, "ZCMPTYPE", method.data(), nullptr, &status);
    fits_clear_errmsg();
    const std::int64_t most = most_bytes_a_pixel * tile_pixels(in);
    if (std::string_view(method.data()).starts_with("GZIP")) check_column(file, in, "COMPRESSED_DATA", most);
    check_column(file, in, "GZIP_COMPRESSED_DATA", most);  // where another method would have lost something
}

}  // namespace astrosplat
