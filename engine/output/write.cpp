// EXR through write_exr.h, the bytes of encode.h elsewhere through OpenImageIO. What comes out depends on the
// arguments alone: OpenImageIO would add the time, so its field is written empty.
#include "output/write.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/sha256.h"
#include "output/encode.h"
#include "output/format.h"
#include "output/metadata.h"
#include "output/write_exr.h"
#include "source/picture_file.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using Depth = OutputParams::Depth;

void check_finite(const Image& image, const char* what) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (!std::isfinite(image.pixels[i]))
            throw std::logic_error(fmt::format("a value of the {} image is not finite (value {})", what, i));
}

OIIO::TypeDesc type_of(Depth depth) {
    switch (depth) {
        case Depth::float32:
            return OIIO::TypeDesc::FLOAT;
        case Depth::uint16:
            return OIIO::TypeDesc::UINT16;
        default:
            return OIIO::TypeDesc::UINT8;
    }
}

const char* oiio_name(OutputParams::Compression compression) {
    using Compression = OutputParams::Compression;
    switch (compression) {
        case Compression::lzw:
            return "lzw";
        case Compression::none:
            return "none";
        default:
            return "zip";  // deflate, in OpenImageIO's words
    }
}

void set_text(OIIO::ImageSpec& spec, const FrameFormat& format, const FrameMetadata& metadata) {
    MetadataEntries entries = metadata_entries(metadata);
    for (const auto& [name, value] : entries)
        if (format.kind != FrameKind::tif) spec.attribute(name, value);
    if (format.kind == FrameKind::tif) spec.attribute("ImageDescription", metadata_lines(entries));
    if (!metadata.provenance.credit.empty()) spec.attribute("Copyright", metadata.provenance.credit);
    spec.attribute("DateTime", "");
}

OIIO::ImageSpec make_spec(const FrameFormat& format, const Image& beauty, const FrameMetadata& metadata) {
    OIIO::ImageSpec spec(static_cast<int>(beauty.width), static_cast<int>(beauty.height),
                         stored_channels(format), type_of(format.depth));
    spec.channelnames = {"R", "G", "B"};
    if (stored_channels(format) == 4) spec.channelnames.push_back("A");
    spec.alpha_channel = stored_channels(format) == 4 ? 3 : -1;
    spec.attribute("compression", oiio_name(format.compression));
    // Told that alpha is unassociated, OpenImageIO stores the numbers as they are; else it would divide
    // PNG's.
    bool as_is = format.kind == FrameKind::png || format.alpha == OutputParams::Alpha::straight;
    if (as_is) spec.attribute("oiio:UnassociatedAlpha", 1);
    // TIFF would hold it as EXIF, which OpenImageIO 2.4 writes wrongly unless it opens the file itself; 8 and
    // 16 bit TIFF is taken for sRGB anyway.
    const bool linear = format.view == OutputParams::View::linear;
    // What a display of a configuration is, nothing here knows.
    if (format.kind != FrameKind::tif && !format.ocio)
        spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    set_text(spec, format, metadata);
    return spec;
}

void write_flat(const FrameFile& target, const FrameFormat& format, const Image& beauty,
                const FrameMetadata& metadata) {
    const OIIO::ImageSpec spec = make_spec(format, beauty, metadata);
    PictureFile file(target.file, format.kind == FrameKind::png ? "png" : "tiff", spec, target.existing);
    if (format.depth == Depth::uint8)
        file.write_all(OIIO::TypeDesc::UINT8,
                       encode_8bit(format, beauty, target.region.x, target.region.y).data());
    else if (format.depth == Depth::uint16)
        file.write_all(OIIO::TypeDesc::UINT16, encode_16bit(format, beauty).data());
    else
        file.write_all(OIIO::TypeDesc::FLOAT, encode_float(format, beauty).pixels.data());
    file.commit();
}

void check_frame(const RenderedFrame& frame, const OutputParams& output) {
    check_finite(frame.beauty, "beauty");
    if (output.holds("depth")) check_finite(frame.depth, "depth");
    if (output.holds("coverage")) check_finite(frame.coverage, "coverage");
    if (output.holds("count")) check_finite(frame.count, "count");
    if (!output.holds("layers")) return;
    for (const Image& layer : frame.layers) check_finite(layer, "layer");
}

void make_folder(const fs::path& file) {
    std::error_code error;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
    if (error)
        throw OutputError(fmt::format("{}: its folder cannot be made: {}", file.string(), error.message()));
}

}  // namespace

void write_frame(const FrameFile& target, const RenderedFrame& frame, const FrameMetadata& metadata) {
    const FrameFormat format = resolve_format(target.output, target.file);
    check_frame(frame, target.output);
    make_folder(target.file);
    if (format.kind == FrameKind::exr)
        write_exr(target, format, frame, metadata);
    else
        write_flat(target, format, frame.beauty, metadata);
}

std::string pixel_hash(const Image& image) {
    return Sha256().add(image.pixels.data(), image.pixels.size() * sizeof(float)).hex();
}

}  // namespace astrosplat
