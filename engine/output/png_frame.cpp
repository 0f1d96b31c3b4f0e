#include "output/frame_formats.h"

#include <fmt/format.h>
#include <png.h>

#include <cstdio>
#include <new>

#include "core/atomic_file.h"
#include "core/error.h"

namespace astrosplat {
namespace {

/// The message of libpng before it jumps back.
struct PngError {
    std::array<char, 128> text{};
};

[[noreturn]] void jump_back(png_structp png, png_const_charp text) {
    auto* const error = static_cast<PngError*>(png_get_error_ptr(png));
    std::snprintf(error->text.data(), error->text.size(), "%s", text);
    png_longjmp(png, 1);
}
void ignore(png_structp, png_const_charp) {}

/// One of libpng's pairs of structs.
template <auto create, auto destroy>
class Png {
  public:
    Png() : png_(create(PNG_LIBPNG_VER_STRING, &error_, jump_back, ignore)) {
        info_ = png_ ? png_create_info_struct(png_) : nullptr;
        if (info_) return;
        destroy_both();
        throw std::bad_alloc();
    }
    ~Png() { destroy_both(); }
    Png(const Png&) = delete;
    Png& operator=(const Png&) = delete;

    png_structp png() const { return png_; }
    png_infop info() const { return info_; }
    const char* error() const { return error_.text.data(); }

  private:
    void destroy_both() { destroy(&png_, &info_); }

    PngError error_;
    png_structp png_;
    png_infop info_;
};
void destroy_reader(png_structpp png, png_infopp info) { png_destroy_read_struct(png, info, nullptr); }
using PngWriter = Png<png_create_write_struct, png_destroy_write_struct>;
using PngReader = Png<png_create_read_struct, destroy_reader>;

/// Where the bytes of a PNG go, one after the other.
struct Appended {
    GuardedFile file;
    static void write(png_structp png, png_bytep bytes, std::size_t size) {
        GuardedFile& file = static_cast<Appended*>(png_get_io_ptr(png))->file;
        if (!file.write_at(file.size(), bytes, size)) png_error(png, "");
    }
    static void flush(png_structp) {}
};

/// A tEXt chunk, which holds Latin 1, or an iTXt chunk for what needs UTF-8.
png_text text_of(const std::string& name, const std::string& value) {
    const bool ascii = std::ranges::all_of(value, [](unsigned char c) { return c < 0x80; });
    png_text text{};
    text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    // libpng copies both, and changes neither.
    text.key = const_cast<char*>(name.c_str());
    text.text = const_cast<char*>(value.c_str());
    (ascii ? text.text_length : text.itxt_length) = value.size();
    return text;
}

struct PngFrame {
    std::int64_t width, height;
    int channels, bits;
    const unsigned char* rows;
    const FrameFormat* format;
    const std::vector<png_text>* texts;
};

// libpng jumps over the frames of this function: nothing in it has a destructor.
bool write_all(png_structp png, png_infop info, const PngFrame& frame) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_IHDR(png, info, static_cast<png_uint_32>(frame.width), static_cast<png_uint_32>(frame.height),
                 frame.bits, frame.channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // Nothing here knows the display of a configuration.
    if (!frame.format->ocio && frame.format->view == OutputParams::View::linear)
        png_set_gAMA(png, info, 1.0);
    else if (!frame.format->ocio)
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_text(png, info, frame.texts->data(), int(frame.texts->size()));
    png_write_info(png, info);
    if (frame.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    const std::int64_t row_bytes = frame.width * frame.channels * frame.bits / 8;
    for (std::int64_t y = 0; y < frame.height; ++y) png_write_row(png, frame.rows + y * row_bytes);
    png_write_end(png, nullptr);
    return true;
}

using OpenFile = std::unique_ptr<std::FILE, decltype([](std::FILE* file) { std::fclose(file); })>;

bool read_info(png_structp png, png_infop info, std::FILE* file) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_read_info(png, info);
    return true;
}

bool read_png_rows(png_structp png, png_infop info, png_bytep row) {
    if (setjmp(png_jmpbuf(png))) return false;
    const png_uint_32 height = png_get_image_height(png, info);
    for (png_uint_32 y = 0; y < height; ++y) png_read_row(png, row, nullptr);
    png_read_end(png, nullptr);
    return true;
}

/// A PNG file with its header read; nothing where it is none.
struct OpenPng {
    OpenFile file;
    PngReader reader;
};
std::unique_ptr<OpenPng> open_png(const fs::path& path) {
    OpenFile file(std::fopen(path.c_str(), "rbe"));
    if (!file) return nullptr;
    auto opened = std::make_unique<OpenPng>(std::move(file));
    const PngReader& reader = opened->reader;
    return read_info(reader.png(), reader.info(), opened->file.get()) ? std::move(opened) : nullptr;
}

}  // namespace

void write_png(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               const FrameMetadata& metadata) {
    MetadataEntries entries = metadata_entries(metadata);
    if (!metadata.provenance.credit.empty()) entries.emplace_back("Copyright", metadata.provenance.credit);
    entries.emplace_back("XML:com.adobe.xmp", frame_xmp(metadata));  // iTXt: its mark of order is not ASCII
    std::vector<png_text> texts;
    for (const auto& [name, value] : entries) texts.push_back(text_of(name, value));
    PngFrame png{
        frame.beauty.width, frame.beauty.height, stored_channels(format), 8, nullptr, &format, &texts};
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> words;
    if (format.depth == OutputParams::Depth::uint8) {
        bytes = encode_8bit(format, frame.beauty, target.region.x, target.region.y);
        png.rows = bytes.data();
    } else {
        words = encode_16bit(format, frame.beauty);
        png.bits = 16;
        png.rows = reinterpret_cast<const unsigned char*>(words.data());
    }
    AtomicFile file(target.file, target.existing);
    Appended appended{GuardedFile(file)};
    const PngWriter writer;
    png_set_write_fn(writer.png(), &appended, Appended::write, Appended::flush);
    const bool written = write_all(writer.png(), writer.info(), png);
    appended.file.rethrow_failure();
    if (!written)
        throw OutputError(fmt::format("{}: cannot be written: {}", target.file.string(), writer.error()));
    file.commit();
}

std::optional<StoredHeader> read_png_header(const fs::path& file) {
    const auto opened = open_png(file);
    if (!opened) return {};
    const png_structp png = opened->reader.png();
    const png_infop info = opened->reader.info();
    StoredHeader header;
    header.whole_width = png_get_image_width(png, info);
    header.whole_height = png_get_image_height(png, info);
    png_textp texts = nullptr;
    const int count = png_get_text(png, info, &texts, nullptr);
    for (const png_text& text : std::span(texts, std::size_t(count)))
        header.texts.emplace(text.key, text.text);
    return header;
}

bool png_is_whole(const fs::path& file) {
    const auto opened = open_png(file);
    if (!opened) return false;
    const png_structp png = opened->reader.png();
    const png_infop info = opened->reader.info();
    if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) return false;
    std::vector<png_byte> row(png_get_rowbytes(png, info));
    return read_png_rows(png, info, row.data());
}

}  // namespace astrosplat
