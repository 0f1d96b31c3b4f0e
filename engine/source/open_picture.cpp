// The plug-in is chosen by our table of formats and not by asking each in turn, because some of OpenImageIO's
// accept files that are no pictures. JPEG's segments are skipped by their length, so that the end marker of a
// thumbnail inside one is not taken for the picture's own; compressed data are searched for the next marker.
#include <fmt/format.h>
// (This line keeps clang-format from sorting the two.)
#include "source/open_picture.h"

#include <OpenImageIO/tiffutils.h>
#include <tiffio.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <mutex>
#include <sstream>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/text.h"

namespace astrosplat {
namespace {

thread_local int quiet_depth = 0;

// The stream's write function: everything "written" where a QuietStderr lives in this thread.
ssize_t write_unless_quiet(void*, const char* text, std::size_t size) {
    return quiet_depth > 0 ? static_cast<ssize_t>(size) : ::write(STDERR_FILENO, text, size);
}

// Replaces the stream stderr, which glibc allows, before main() and thus before other threads use it. An
// unbuffered stream writes each message at once, as the original does.
[[maybe_unused]] const bool stderr_is_filtered = [] {
    std::FILE* const filtered = ::fopencookie(nullptr, "w", {nullptr, write_unless_quiet, nullptr, nullptr});
    if (!filtered) return false;
    std::setvbuf(filtered, nullptr, _IONBF, 0);
    stderr = filtered;
    return true;
}();

constexpr unsigned char start_of_image = 0xD8, end_of_image = 0xD9, first_restart = 0xD0;

unsigned char byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

// FF 00 is a data byte, FF D0 to D7 are restarts within the data, FF FF is padding.
bool begins_segment(unsigned char code) {
    return code != 0x00 && code != 0xFF && !(code >= first_restart && code < start_of_image);
}

// Where the next marker's code stands, npos where none follows.
std::size_t next_marker(std::string_view bytes, std::size_t at) {
    while ((at = bytes.find('\xFF', at)) != std::string_view::npos) {
        ++at;
        if (at < bytes.size() && begins_segment(byte_at(bytes, at))) return at;
    }
    return std::string_view::npos;
}

// OpenJPEG decodes a picture where its file is opened, four bytes a value, and tries to hold any size. The
// marker SIZ (ISO/IEC 15444-1, A.5.1) has it.
void claim_jpeg2000(const fs::path& file) {
    const std::string bytes = read_beginning(file, std::size_t{1} << 16);
    const std::size_t at = bytes.find("\xff\x4f\xff\x51");
    constexpr std::size_t sides = 8, origins = 16, channels = 40, end = 42;
    if (at == bytes.npos || bytes.size() < at + end) return;
    const auto number = [&](std::size_t from, std::size_t size) {
        double value = 0.0;
        for (std::size_t i = 0; i < size; ++i) value = 256.0 * value + byte_at(bytes, at + from + i);
        return value;
    };
    double size = 4.0 * number(channels, 2);
    for (const std::size_t side : {0, 4})
        size *= std::fmax(0.0, number(sides + side, 4) - number(origins + side, 4));
    claim_memory(std::int64_t(std::fmin(size, 9e18)), fmt::format("reading {}", file.string()));
}

}  // namespace

QuietStderr::QuietStderr() { ++quiet_depth; }
QuietStderr::~QuietStderr() { --quiet_depth; }

bool read_rows(OIIO::ImageInput& picture, int begin, int end, OIIO::TypeDesc format, void* values) {
    const QuietStderr quiet;
    const OIIO::ImageSpec& spec = picture.spec();
    const bool read =
        picture.read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, 0, spec.nchannels, format, values);
    // The reader of TIFF says that it has read strips that are cut short, but has a message about them.
    return picture.geterror().empty() && read;
}

void fail_picture(const fs::path& file, const std::string& reason) {
    const std::string_view line = trim(std::string_view(reason).substr(0, reason.find('\n')));
    throw InputError(
        fmt::format("{}: cannot be read as a picture: {}", file.string(),
                    line.empty() ? "its pixels end early, or are not as its header has them" : line));
}

std::unique_ptr<OIIO::ImageInput> open_picture(const fs::path& file) {
    require_readable(file);
    const FileFormat* const format = format_of_file(file);
    if (kind_of(format) != FileKind::picture)
        fail_picture(file, fmt::format("it is not {}", names_of(FileKind::picture)));
    const QuietStderr quiet;
    std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(std::string(format->id));
    if (!in) {
        const std::string reason = OIIO::geterror();
        fail_picture(file, fmt::format("this OpenImageIO reads no {}{}", format->name,
                                       format->converter.empty() ? ": " + reason
                                                                 : fmt::format("; {}", format->converter)));
    }
    if (format->id == "jpeg2000") claim_jpeg2000(file);
    if (format->id == "pnm") largest_of_pnm(file);
    OIIO::ImageSpec spec, wish;
    wish.attribute("oiio:UnassociatedAlpha", 1);
    static std::mutex profiles;  // OpenImageIO 2.4.7 fills a table of theirs as it goes (its issue 3756)
    if (const std::lock_guard lock(profiles); in->open(file.string(), spec, wish)) return in;
    const std::string reason = in->geterror();
    if (reason.find("Subsampled channels") != std::string::npos)
        fail_picture(
            file, "its colour is stored at a lower resolution (subsampled luminance/chroma); save it as RGB");
    fail_picture(file, reason.empty() ? fmt::format("it is no {} file", format->name) : reason);
}

bool jpeg_is_whole(const fs::path& file) {
    const std::string text = read_file(file);
    const std::string_view bytes = text;
    if (bytes.substr(0, 3) != "\xFF\xD8\xFF") return true;
    std::size_t at = 2;
    while ((at = next_marker(bytes, at)) != std::string_view::npos) {
        if (byte_at(bytes, at) == end_of_image) return true;
        if (at + 2 >= bytes.size()) return false;
        at += 1 + (std::size_t{byte_at(bytes, at + 1)} << 8U) + byte_at(bytes, at + 2);
    }
    return false;
}

double largest_of_pnm(const fs::path& file) {
    std::istringstream in(read_beginning(file, 4096));
    std::string word;
    in >> word;
    if (word.size() != 2 || std::string_view("2356").find(word[1]) == std::string_view::npos) return 0.0;
    for (int left = 3; left > 0 && in >> word;)
        if (word[0] == '#')
            std::getline(in, word);
        else
            --left;
    const std::int64_t largest = parse_int64(word).value_or(0);
    if (largest < 1 || (largest > 32768 && largest != 65535))
        fail_picture(
            file, fmt::format("its largest value is {}; save it with at most 32768, or with 65535", largest));
    return double(largest);
}

void add_webp_exif(const fs::path& file, OIIO::ImageSpec& spec) {
    const std::string text = read_file(file);
    std::string_view bytes = text;
    for (bytes.remove_prefix(std::min<std::size_t>(12, bytes.size())); bytes.size() >= 8;) {
        std::size_t size = 0;
        for (std::size_t i = 8; i-- > 4;) size = size << 8U | byte_at(bytes, i);
        std::string_view chunk = bytes.substr(8, size);
        if (chunk.starts_with(std::string_view("Exif\0\0", 6))) chunk.remove_prefix(6);
        if (bytes.starts_with("EXIF")) OIIO::decode_exif(OIIO::string_view(chunk.data(), chunk.size()), spec);
        bytes.remove_prefix(std::min(bytes.size(), 8 + size + size % 2));
    }
}

std::array<float, 3> radiance_factors(const fs::path& file) {
    std::array<double, 3> factors{1.0, 1.0, 1.0};
    std::ifstream in(file, std::ios::binary);
    for (std::string line; std::getline(in, line) && !trim(line).empty();) {
        const std::size_t equals = line.find('=');
        const std::string_view key = trim(std::string_view(line).substr(0, equals));
        const bool corrects = key == "COLORCORR", exposes = key == "EXPOSURE";
        std::istringstream words(equals == std::string::npos ? "" : line.substr(equals + 1));
        std::array<double, 3> values{};
        std::size_t count = 0;
        for (std::string word; count < (corrects ? 3u : 1u) && words >> word; ++count)
            values[count] = parse_double(word).value_or(0.0);
        const bool whole =
            std::all_of(values.begin(), values.begin() + count, [](double v) { return v > 0.0; });
        if ((corrects && count == 3 && whole) || (exposes && count == 1 && whole))
            for (std::size_t c = 0; c < 3; ++c) factors[c] *= values[corrects ? c : 0];
        else if (corrects || exposes || key == "PRIMARIES" || line.find("_xyze") != std::string::npos ||
                 (key == "PIXASPECT" && values[0] != 1.0))
            log_warning(fmt::format("{}: its {} is not followed", file.string(), trim(line)));
    }
    return {float(factors[0]), float(factors[1]), float(factors[2])};
}

std::optional<double> check_tiff(const fs::path& file, int page) {
    const QuietStderr quiet;
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(file.c_str(), "r"), TIFFClose);
    if (!tiff || !TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(page))) return {};
    std::uint16_t bits = 0;
    if (TIFFGetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits) != 1)
        fail_picture(file, "it does not say how many bits a value has (BitsPerSample); save it with 8");
    const std::uint64_t size = fs::file_size(file);
    const bool tiled = TIFFIsTiled(tiff.get()) != 0;
    const std::uint32_t parts = tiled ? TIFFNumberOfTiles(tiff.get()) : TIFFNumberOfStrips(tiff.get());
    for (std::uint32_t i = 0; i < parts; ++i) {
        const std::uint64_t at = TIFFGetStrileOffset(tiff.get(), i);
        if (at > size || TIFFGetStrileByteCount(tiff.get(), i) > size - at)
            fail_picture(file, "the file ends before the picture does");
    }
    constexpr std::uint32_t gdal_no_data = 42113;
    std::uint32_t size_of_text = 0;
    const char* text = nullptr;
    if (TIFFGetField(tiff.get(), gdal_no_data, &size_of_text, &text) != 1 || !text) return {};
    const std::string_view number = trim(std::string_view(text, ::strnlen(text, size_of_text)));
    std::uint16_t kind = SAMPLEFORMAT_UINT;
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SAMPLEFORMAT, &kind);
    const std::optional<double> value = parse_double(number);
    if (kind == SAMPLEFORMAT_IEEEFP && value) return value;
    log_warning(fmt::format("{}: its GDAL_NODATA {} is not followed", file.string(), printable(number)));
    return {};
}

TiffColors colors_of_tiff(const fs::path& file, int page) {
    constexpr std::array d65_white{0.3127f, 0.3290f};
    TiffColors found;
    const QuietStderr quiet;
    const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(TIFFOpen(file.c_str(), "r"), TIFFClose);
    if (!tiff || !TIFFSetDirectory(tiff.get(), static_cast<tdir_t>(page))) return found;
    const float *primaries = nullptr, *white = nullptr;
    if (TIFFGetField(tiff.get(), TIFFTAG_PRIMARYCHROMATICITIES, &primaries) == 1) {
        std::array<float, 8>& all = found.primaries.emplace();
        std::copy_n(primaries, 6, all.begin());
        const bool has_white = TIFFGetField(tiff.get(), TIFFTAG_WHITEPOINT, &white) == 1;
        std::copy_n(has_white ? white : d65_white.data(), 2, all.begin() + 6);
    }
    std::array<const std::uint16_t*, 3> curves{};
    std::uint16_t bits = 0;
    if (TIFFGetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, &bits) == 1 && bits <= 16 &&
        TIFFGetField(tiff.get(), TIFFTAG_TRANSFERFUNCTION, &curves[0], &curves[1], &curves[2]) == 1)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < std::size_t{1} << bits; ++i)
                found.transfer[c].push_back(float((curves[c] ? curves[c] : curves[0])[i]) / 65535.0f);
    return found;
}

bool bmp_has_alpha(const fs::path& file) {
    const std::string bytes = read_beginning(file, 70);
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 4; i-- > 0;) value = value << 8U | byte_at(bytes, at + i);
        return value;
    };
    constexpr std::size_t header_size = 14, compression = 30, alpha_mask = 66;
    return bytes.size() == 70 && number(header_size) >= 56 && number(compression) != 0 &&
           number(alpha_mask) != 0;
}

}  // namespace astrosplat
