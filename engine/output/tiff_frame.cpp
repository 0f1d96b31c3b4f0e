#include "output/frame_formats.h"

#include <fmt/format.h>
#include <tiffio.h>
#include <zlib.h>

#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"

namespace astrosplat {
namespace {

using Bytes = std::vector<unsigned char>;
using Compression = OutputParams::Compression;
using Depth = OutputParams::Depth;

constexpr std::int64_t strip_rows = 32;
constexpr std::int64_t strips_at_once = 16;           // in memory, deflated
constexpr std::int64_t largest_classic = 0xf0000000;  // bytes, beyond which a TIFF has offsets of 64 bits
constexpr std::int64_t largest_strip = std::int64_t{1}
                                       << 28;  // bytes, that is read to see whether it is whole

/// The first message of libtiff.
struct TiffError {
    std::array<char, 160> text{};
};
int keep_error(TIFF*, void* user, const char*, const char* format, va_list values) {
    auto& text = static_cast<TiffError*>(user)->text;
    if (text[0] == 0) std::vsnprintf(text.data(), text.size(), format, values);
    return 1;  // handled: the library's own handler is to print nothing
}
int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

using Options =
    std::unique_ptr<TIFFOpenOptions, decltype([](TIFFOpenOptions* o) { TIFFOpenOptionsFree(o); })>;
using OpenTiff = std::unique_ptr<TIFF, decltype([](TIFF* tiff) { TIFFClose(tiff); })>;

Options options_for(TiffError& error) {
    Options options(TIFFOpenOptionsAlloc());
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &error);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, nullptr);
    return options;
}

/// A file in which libtiff goes to and fro.
struct Seekable {
    GuardedFile file;
    std::int64_t place = 0;

    static Seekable& of(thandle_t handle) { return *static_cast<Seekable*>(handle); }
    static tmsize_t read(thandle_t, void*, tmsize_t) { return -1; }
    static tmsize_t write(thandle_t handle, void* bytes, tmsize_t size) {
        Seekable& to = of(handle);
        if (!to.file.write_at(to.place, bytes, std::size_t(size))) return -1;
        to.place += size;
        return size;
    }
    static toff_t seek(thandle_t handle, toff_t offset, int whence) {
        Seekable& to = of(handle);
        const std::int64_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? to.place : to.file.size();
        to.place = from + std::int64_t(offset);
        return static_cast<toff_t>(to.place);
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t handle) { return static_cast<toff_t>(of(handle).file.size()); }
};

/// Samples of a frame as they are stored.
struct Samples {
    std::int64_t width, height;
    int channels, bytes_each;
    const unsigned char* rows;

    std::int64_t row_bytes() const { return width * channels * bytes_each; }
};

// TIFF's predictors 2 and 3 (TIFF 6.0, 14; Adobe's technical note 3): a row holds differences to the pixel on
// the left; of floats, whose bytes are put in order of weight first.
template <class Sample>
void take_differences(Sample* row, std::int64_t count, int channels) {
    for (std::int64_t i = count - 1; i >= channels; --i)
        row[i] = static_cast<Sample>(row[i] - row[i - channels]);
}

void predict_floats(unsigned char* row, std::int64_t count, int channels, Bytes& scratch) {
    scratch.resize(std::size_t(4 * count));
    for (std::int64_t i = 0; i < count; ++i) {
        std::uint32_t bits;
        std::memcpy(&bits, row + 4 * i, sizeof bits);
        for (int byte = 0; byte < 4; ++byte)
            scratch[byte * count + i] = static_cast<unsigned char>(bits >> (24 - 8 * byte));
    }
    take_differences(scratch.data(), 4 * count, channels);
    std::ranges::copy(scratch, row);
}

void predict_row(const Samples& samples, unsigned char* row, Bytes& scratch) {
    const std::int64_t count = samples.width * samples.channels;
    if (samples.bytes_each == 4)
        predict_floats(row, count, samples.channels, scratch);
    else if (samples.bytes_each == 2)
        take_differences(reinterpret_cast<std::uint16_t*>(row), count, samples.channels);
    else
        take_differences(row, count, samples.channels);
}

Bytes deflated_strip(const Samples& samples, std::int64_t begin, std::int64_t end) {
    const std::int64_t row_bytes = samples.row_bytes();
    Bytes rows(samples.rows + begin * row_bytes, samples.rows + end * row_bytes), scratch;
    for (std::int64_t y = 0; y < end - begin; ++y) predict_row(samples, rows.data() + y * row_bytes, scratch);
    uLongf size = compressBound(static_cast<uLong>(rows.size()));
    Bytes deflated(size);
    if (compress(deflated.data(), &size, rows.data(), static_cast<uLong>(rows.size())) != Z_OK)
        throw std::bad_alloc();  // the one error it has where there is room
    deflated.resize(size);
    return deflated;
}

bool write_deflated(TIFF* tiff, const Samples& samples) {
    const std::int64_t strips = (samples.height + strip_rows - 1) / strip_rows;
    for (std::int64_t first = 0; first < strips; first += strips_at_once) {
        std::vector<Bytes> group(std::size_t(std::min(strips_at_once, strips - first)));
        parallel_for(std::ssize(group), [&](std::int64_t i, int) {
            const std::int64_t begin = (first + i) * strip_rows;
            group[i] = deflated_strip(samples, begin, std::min(begin + strip_rows, samples.height));
        });
        for (std::size_t i = 0; i < group.size(); ++i)
            if (TIFFWriteRawStrip(tiff, std::uint32_t(first) + std::uint32_t(i), group[i].data(),
                                  std::ssize(group[i])) < 0)
                return false;
    }
    return true;
}

bool write_by_libtiff(TIFF* tiff, const Samples& samples) {
    for (std::int64_t y = 0; y < samples.height; y += strip_rows) {
        const std::int64_t size = std::min(strip_rows, samples.height - y) * samples.row_bytes();
        Bytes strip(samples.rows + y * samples.row_bytes(), samples.rows + y * samples.row_bytes() + size);
        if (TIFFWriteEncodedStrip(tiff, std::uint32_t(y / strip_rows), strip.data(), size) < 0) return false;
    }
    return true;
}

int tiff_compression(Compression compression) {
    if (compression == Compression::none) return COMPRESSION_NONE;
    return compression == Compression::lzw ? COMPRESSION_LZW : COMPRESSION_ADOBE_DEFLATE;
}

void set_tags(TIFF* tiff, const FrameFormat& format, const Samples& samples, const FrameMetadata& metadata) {
    const bool floats = samples.bytes_each == 4;
    const int compression = tiff_compression(format.compression);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, std::uint32_t(samples.width));
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, std::uint32_t(samples.height));
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * samples.bytes_each);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, floats ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples.channels);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, std::uint32_t(strip_rows));
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
    if (compression != COMPRESSION_NONE)
        TIFFSetField(tiff, TIFFTAG_PREDICTOR, floats ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
    if (samples.channels == 4) {
        const bool straight = format.alpha == OutputParams::Alpha::straight;
        const std::uint16_t kind = straight ? EXTRASAMPLE_UNASSALPHA : EXTRASAMPLE_ASSOCALPHA;
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
    }
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, metadata_lines(metadata_entries(metadata)).c_str());
    const std::string xmp = frame_xmp(metadata);
    TIFFSetField(tiff, TIFFTAG_XMLPACKET, std::uint32_t(xmp.size()), xmp.data());
    if (!metadata.provenance.credit.empty())
        TIFFSetField(tiff, TIFFTAG_COPYRIGHT, metadata.provenance.credit.c_str());
}

bool write_all(TIFF* tiff, const FrameFormat& format, const Samples& samples, const FrameMetadata& metadata) {
    set_tags(tiff, format, samples, metadata);
    // The directory goes before the pixels, where it is written again at the end: a file that is cut short
    // still tells what it is.
    if (!TIFFCheckpointDirectory(tiff)) return false;
    const bool deflate = tiff_compression(format.compression) == COMPRESSION_ADOBE_DEFLATE;
    return (deflate ? write_deflated : write_by_libtiff)(tiff, samples) && TIFFWriteDirectory(tiff) != 0;
}

void write_samples(const FrameFile& target, const FrameFormat& format, const Samples& samples,
                   const FrameMetadata& metadata) {
    AtomicFile file(target.file, target.existing);
    Seekable seekable{GuardedFile(file)};
    TiffError error;
    const bool written = [&] {
        const Options options = options_for(error);
        const bool large = samples.height * samples.row_bytes() > largest_classic;
        const OpenTiff tiff(TIFFClientOpenExt(
            target.file.c_str(), large ? "w8" : "w", &seekable, Seekable::read, Seekable::write,
            Seekable::seek, Seekable::close, Seekable::size, nullptr, nullptr, options.get()));
        return tiff && write_all(tiff.get(), format, samples, metadata);
    }();
    seekable.file.rethrow_failure();
    if (!written)
        throw OutputError(fmt::format("{}: cannot be written: {}", target.file.string(), error.text.data()));
    file.commit();
}

/// A TIFF file in whose first directory one can look; nothing where it is none.
OpenTiff open_tiff(const fs::path& file, TiffError& error) {
    // m: not mapped, as it may be cut short meanwhile.
    return OpenTiff(TIFFOpenExt(file.c_str(), "rm", options_for(error).get()));
}

}  // namespace

void write_tiff(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
                const FrameMetadata& metadata) {
    const int channels = stored_channels(format);
    const auto write = [&](int bytes_each, const void* rows) {
        write_samples(target, format,
                      {frame.beauty.width, frame.beauty.height, channels, bytes_each,
                       static_cast<const unsigned char*>(rows)},
                      metadata);
    };
    if (format.depth == Depth::uint8)
        write(1, encode_8bit(format, frame.beauty, target.region.x, target.region.y).data());
    else if (format.depth == Depth::uint16)
        write(2, encode_16bit(format, frame.beauty).data());
    else
        write(4, encode_float(format, frame.beauty).pixels.data());
}

std::optional<StoredHeader> read_tiff_header(const fs::path& file) {
    TiffError error;
    const OpenTiff tiff = open_tiff(file, error);
    std::uint32_t width = 0, height = 0;
    const char* description = nullptr;
    if (!tiff || !TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width) ||
        !TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height) ||
        !TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &description))
        return {};
    return StoredHeader{width, height, {}, parse_metadata_lines(description)};
}

bool tiff_is_whole(const fs::path& file) {
    TiffError error;
    const OpenTiff tiff = open_tiff(file, error);
    if (!tiff || TIFFIsTiled(tiff.get())) return false;
    const tmsize_t size = TIFFStripSize(tiff.get());
    if (size <= 0 || size > largest_strip) return false;
    Bytes strip(size);
    const std::uint32_t strips = TIFFNumberOfStrips(tiff.get());
    for (std::uint32_t i = 0; i < strips; ++i)
        if (TIFFReadEncodedStrip(tiff.get(), i, strip.data(), size) < 0 || error.text[0] != 0) return false;
    return true;
}

}  // namespace astrosplat
