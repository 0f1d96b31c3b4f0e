// Writing frames through OpenImageIO: one part, per-channel formats in EXR, the bytes of encode.h elsewhere.
// What comes out depends on the arguments alone: OpenImageIO would add the time, so its field is written
// empty.
#include "output/write.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/sha256.h"
#include "output/encode.h"
#include "output/format.h"
#include "output/metadata.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using Depth = OutputParams::Depth;

constexpr float largest_half = 65504.0f;
constexpr std::int64_t band_rows = 256;  // a multiple of every EXR compression's block height

/// An open file and what it is called in messages.
struct Writer {
    std::unique_ptr<OIIO::ImageOutput> out;
    OIIO::ImageSpec spec;
    fs::path file;       // what messages name
    fs::path temporary;  // what is written

    [[noreturn]] void fail() const {
        std::string reason = out ? out->geterror() : OIIO::geterror();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        std::size_t at = reason.find(temporary.string());
        if (at != std::string::npos) reason.replace(at, temporary.string().size(), file.string());
        throw OutputError(fmt::format("{}: cannot be written: {}", file.string(),
                                      reason.empty() ? std::string("unknown reason") : reason));
    }
};

/// One channel of an EXR file: where its floats lie and how they are stored.
struct Channel {
    std::string name;
    const Image* image;
    int index;
    bool half;
};

void check_finite(const Image& image, const char* what) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (!std::isfinite(image.pixels[i]))
            throw std::logic_error(
                fmt::format("a value of the {} picture is not finite (value {})", what, i));
}

OIIO::TypeDesc type_of(Depth depth) {
    switch (depth) {
        case Depth::half_float:
            return OIIO::TypeDesc::HALF;
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
        case Compression::zips:
            return "zips";
        case Compression::piz:
            return "piz";
        case Compression::dwaa:
            return "dwaa";
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
    for (const auto& [key, value] : entries)
        if (format.kind != FileKind::tif) spec.attribute(key, value);
    if (format.kind == FileKind::tif) spec.attribute("ImageDescription", metadata_lines(entries));
    if (!metadata.provenance.credit.empty()) spec.attribute("Copyright", metadata.provenance.credit);
    spec.attribute("DateTime", "");
}

void set_exr_attributes(OIIO::ImageSpec& spec, const FrameMetadata& metadata) {
    const float rec709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};  // r g b white, x y
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709);
    Rational fps = rational_fps(metadata.fps);
    const int rational[2] = {fps.numerator, fps.denominator};
    spec.attribute("framesPerSecond", OIIO::TypeRational, rational);
    if (!metadata.matrices) return;
    spec.attribute("worldToCamera", OIIO::TypeMatrix44, metadata.matrices->world_to_camera);
    spec.attribute("worldToNDC", OIIO::TypeMatrix44, metadata.matrices->world_to_ndc);
}

OIIO::ImageSpec make_spec(const FrameFormat& format, int channels, const Region& region,
                          const FrameMetadata& metadata) {
    OIIO::ImageSpec spec(static_cast<int>(region.width), static_cast<int>(region.height), channels,
                         type_of(format.depth));
    spec.channelnames = {"R", "G", "B"};
    if (stored_channels(format) == 4) spec.channelnames.push_back("A");
    spec.alpha_channel = stored_channels(format) == 4 ? 3 : -1;
    spec.attribute("compression", oiio_name(format.compression));
    // Told that alpha is unassociated, OpenImageIO stores the numbers as they are; else it would divide
    // PNG's.
    bool as_is = format.kind == FileKind::png || format.alpha == OutputParams::Alpha::straight;
    if (as_is && format.kind != FileKind::exr) spec.attribute("oiio:UnassociatedAlpha", 1);
    bool linear = format.view == OutputParams::View::linear;
    spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    set_text(spec, format, metadata);
    return spec;
}

void open(Writer& writer, const char* plugin) {
    OIIO::attribute("exr_threads", thread_count());
    writer.out = OIIO::ImageOutput::create(plugin);
    if (!writer.out || !writer.out->open(writer.temporary.string(), writer.spec)) writer.fail();
}

bool asked(const OutputParams& output, const char* aov) {
    return std::find(output.aovs.begin(), output.aovs.end(), aov) != output.aovs.end();
}

std::vector<Channel> exr_channels(const Image& beauty, const std::vector<Image>& layers,
                                  const RenderedFrame& frame, const std::vector<std::string>& layer_names,
                                  const OutputParams& output, bool half) {
    static const char* const names[4] = {"R", "G", "B", "A"};
    std::vector<Channel> channels;
    for (int c = 0; c < beauty.channels; ++c) channels.push_back({names[c], &beauty, c, half});
    if (asked(output, "depth")) channels.push_back({"Z", &frame.depth, 0, false});
    if (asked(output, "coverage")) channels.push_back({"coverage", &frame.coverage, 0, half});
    if (asked(output, "count")) channels.push_back({"count", &frame.count, 0, false});
    for (std::size_t i = 0; i < layers.size(); ++i)
        for (int c = 0; c < layers[i].channels; ++c)
            channels.push_back({fmt::format("{}.{}", layer_names[i], names[c]), &layers[i], c, half});
    return channels;
}

// Rows y0 .. y1 of all channels side by side; light beyond half's range stays finite.
void interleave(const std::vector<Channel>& channels, std::int64_t y0, std::int64_t y1,
                std::vector<float>& band) {
    std::int64_t width = channels[0].image->width;
    std::size_t n = channels.size();
    band.resize(static_cast<std::size_t>((y1 - y0) * width) * n);
    parallel_for(y1 - y0, [&](std::int64_t row, int) {
        for (std::size_t c = 0; c < n; ++c) {
            const Channel& channel = channels[c];
            float limit = channel.half ? largest_half : std::numeric_limits<float>::max();
            const float* from = channel.image->at(0, y0 + row) + channel.index;
            float* to = band.data() + static_cast<std::size_t>(row * width) * n + c;
            for (std::int64_t x = 0; x < width; ++x)
                to[static_cast<std::size_t>(x) * n] =
                    std::clamp(from[x * channel.image->channels], -limit, limit);
        }
    });
}

void write_exr(Writer& writer, const std::vector<Channel>& channels) {
    writer.spec.nchannels = static_cast<int>(channels.size());
    writer.spec.channelnames.clear();
    writer.spec.channelformats.clear();
    for (const Channel& channel : channels) {
        writer.spec.channelnames.push_back(channel.name);
        writer.spec.channelformats.push_back(channel.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    }
    open(writer, "openexr");
    std::int64_t height = channels[0].image->height;
    std::vector<float> band;
    for (std::int64_t y = 0; y < height; y += band_rows) {
        std::int64_t end = std::min(y + band_rows, height);
        interleave(channels, y, end, band);
        int top = writer.spec.y;
        if (!writer.out->write_scanlines(static_cast<int>(y) + top, static_cast<int>(end) + top, 0,
                                         OIIO::TypeDesc::FLOAT, band.data()))
            writer.fail();
    }
}

void write_exr_frame(Writer& writer, const FrameFormat& format, const RenderedFrame& frame,
                     const std::vector<std::string>& layer_names, const OutputParams& output,
                     std::int64_t whole_width, std::int64_t whole_height, const Region& region,
                     const FrameMetadata& metadata) {
    Image beauty = encode_float(format, frame.beauty);
    std::vector<Image> layers;
    if (asked(output, "layers"))
        for (const Image& layer : frame.layers) layers.push_back(encode_float(format, layer));
    if (layers.size() > layer_names.size()) throw std::logic_error("a frame has more layers than names");
    writer.spec.x = static_cast<int>(region.x);
    writer.spec.y = static_cast<int>(region.y);
    writer.spec.full_width = static_cast<int>(whole_width);
    writer.spec.full_height = static_cast<int>(whole_height);
    set_exr_attributes(writer.spec, metadata);
    write_exr(writer,
              exr_channels(beauty, layers, frame, layer_names, output, format.depth == Depth::half_float));
}

void write_flat_frame(Writer& writer, const FrameFormat& format, const Image& beauty, const Region& region) {
    open(writer, format.kind == FileKind::png ? "png" : "tiff");
    bool written = false;
    if (format.depth == Depth::uint8)
        written = writer.out->write_image(OIIO::TypeDesc::UINT8,
                                          encode_8bit(format, beauty, region.x, region.y).data());
    else if (format.depth == Depth::uint16)
        written = writer.out->write_image(OIIO::TypeDesc::UINT16, encode_16bit(format, beauty).data());
    else
        written = writer.out->write_image(OIIO::TypeDesc::FLOAT, encode_float(format, beauty).pixels.data());
    if (!written) writer.fail();
}

void check_frame(const RenderedFrame& frame, const OutputParams& output) {
    check_finite(frame.beauty, "beauty");
    if (asked(output, "depth")) check_finite(frame.depth, "depth");
    if (asked(output, "coverage")) check_finite(frame.coverage, "coverage");
    if (asked(output, "count")) check_finite(frame.count, "count");
    if (!asked(output, "layers")) return;
    for (const Image& layer : frame.layers) check_finite(layer, "layer");
}

void make_folder(const fs::path& file) {
    std::error_code error;
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
    if (error)
        throw OutputError(fmt::format("{}: its folder cannot be made: {}", file.string(), error.message()));
}

}  // namespace

void write_frame(const fs::path& file, const RenderedFrame& frame,
                 const std::vector<std::string>& layer_names, const OutputParams& output,
                 std::int64_t whole_width, std::int64_t whole_height, const Region& region,
                 const FrameMetadata& metadata) {
    FrameFormat format = resolve_format(output, file);
    check_frame(frame, output);
    Region part{region.x, region.y, frame.beauty.width, frame.beauty.height};
    make_folder(file);
    AtomicFile target(file);
    Writer writer{nullptr, make_spec(format, stored_channels(format), part, metadata), file,
                  target.temporary()};
    if (format.kind == FileKind::exr)
        write_exr_frame(writer, format, frame, layer_names, output, whole_width, whole_height, part,
                        metadata);
    else
        write_flat_frame(writer, format, frame.beauty, part);
    if (!writer.out->close()) writer.fail();
    target.commit();
}

std::string pixel_hash(const Image& image) {
    return Sha256().add(image.pixels.data(), image.pixels.size() * sizeof(float)).hex();
}

}  // namespace astrosplat
