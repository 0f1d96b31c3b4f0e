// Writing frames through OpenImageIO: one part, per-channel formats in EXR, the bytes of encode.h
// elsewhere. What comes out depends on the arguments alone: OpenImageIO would add the time, so its field is
// written empty.
#include "output/write.h"

#include <fmt/format.h>
// fmt first: OpenImageIO brings a copy of it with other settings.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/error.h"
#include "core/parallel.h"
#include "core/primaries.h"
#include "core/sha256.h"
#include "output/encode.h"
#include "output/format.h"
#include "output/metadata.h"
#include "source/picture_file.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;
using Depth = OutputParams::Depth;

constexpr float largest_half = 65504.0f;
constexpr std::int64_t band_rows = 256;  // a multiple of every EXR compression's block height

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
            throw std::logic_error(fmt::format("a value of the {} image is not finite (value {})", what, i));
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
    for (const auto& [name, value] : entries)
        if (format.kind != FrameKind::tif) spec.attribute(name, value);
    if (format.kind == FrameKind::tif) spec.attribute("ImageDescription", metadata_lines(entries));
    if (!metadata.provenance.credit.empty()) spec.attribute("Copyright", metadata.provenance.credit);
    spec.attribute("DateTime", "");
}

void set_chromaticities(OIIO::ImageSpec& spec, OutputParams::Primaries primaries) {
    const bool acescg = primaries == OutputParams::Primaries::acescg;
    const Chromaticities& set = acescg ? acescg_chromaticities : rec709_chromaticities;
    float values[8];  // r g b white, x y
    for (int i = 0; const glm::dvec2& each : {set.red, set.green, set.blue, set.white})
        for (int c = 0; c < 2; ++c) values[i++] = static_cast<float>(each[c]);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), values);
}

void set_exr_attributes(OIIO::ImageSpec& spec, const FrameMetadata& metadata) {
    Rational fps = rational_fps(metadata.fps);
    const int rational[2] = {fps.numerator, fps.denominator};
    spec.attribute("framesPerSecond", OIIO::TypeRational, rational);
    if (metadata.eye != Eye::centre) spec.attribute("view", std::string(name_of(metadata.eye)));
    if (!metadata.matrices) return;
    spec.attribute("worldToCamera", OIIO::TypeMatrix44, metadata.matrices->world_to_camera);
    spec.attribute("worldToNDC", OIIO::TypeMatrix44, metadata.matrices->world_to_ndc);
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
    if (as_is && format.kind != FrameKind::exr) spec.attribute("oiio:UnassociatedAlpha", 1);
    // TIFF would hold it as EXIF, which OpenImageIO 2.4 writes wrongly unless it opens the file itself; 8 and
    // 16 bit TIFF is taken for sRGB anyway.
    const bool linear = format.view == OutputParams::View::linear;
    // What a display of a configuration is, nothing here knows.
    if (format.kind != FrameKind::tif && !format.ocio)
        spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    set_text(spec, format, metadata);
    return spec;
}

std::vector<Channel> exr_channels(const Image& beauty, const std::vector<Image>& layers,
                                  const RenderedFrame& frame, const FrameFile& target, bool half) {
    const OutputParams& output = target.output;
    static const char* const names[4] = {"R", "G", "B", "A"};
    std::vector<Channel> channels;
    for (int c = 0; c < beauty.channels; ++c) channels.push_back({names[c], &beauty, c, half});
    if (output.holds("depth")) channels.push_back({"Z", &frame.depth, 0, false});
    if (output.holds("coverage")) channels.push_back({"coverage", &frame.coverage, 0, half});
    if (output.holds("count")) channels.push_back({"count", &frame.count, 0, false});
    for (std::size_t i = 0; i < layers.size(); ++i)
        for (int c = 0; c < layers[i].channels; ++c)
            channels.push_back({fmt::format("{}.{}", target.layer_names[i], names[c]), &layers[i], c, half});
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

void name_channels(OIIO::ImageSpec& spec, const std::vector<Channel>& channels) {
    spec.nchannels = static_cast<int>(channels.size());
    spec.channelnames.clear();
    for (const Channel& channel : channels) {
        spec.channelnames.push_back(channel.name);
        spec.channelformats.push_back(channel.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    }
}

void set_windows(OIIO::ImageSpec& spec, const FrameFile& target) {
    spec.x = static_cast<int>(target.region.x);
    spec.y = static_cast<int>(target.region.y);
    spec.full_width = static_cast<int>(target.whole_width);
    spec.full_height = static_cast<int>(target.whole_height);
}

void write_exr(const FrameFile& target, const FrameFormat& format, const RenderedFrame& frame,
               OIIO::ImageSpec spec, const FrameMetadata& metadata) {
    const Image beauty = encode_float(format, frame.beauty);
    std::vector<Image> layers;
    if (target.output.holds("layers"))
        for (const Image& layer : frame.layers) layers.push_back(encode_float(format, layer));
    assert(layers.size() <= target.layer_names.size());
    const std::vector<Channel> channels =
        exr_channels(beauty, layers, frame, target, format.depth == Depth::half_float);
    name_channels(spec, channels);
    set_windows(spec, target);
    set_chromaticities(spec, format.primaries);
    set_exr_attributes(spec, metadata);
    OIIO::attribute("exr_threads", thread_count());
    PictureFile file(target.file, "openexr", spec, target.existing);
    std::vector<float> band;
    for (std::int64_t y = 0; y < beauty.height; y += band_rows) {
        const std::int64_t end = std::min(y + band_rows, beauty.height);
        interleave(channels, y, end, band);
        file.write_rows(y + target.region.y, end + target.region.y, OIIO::TypeDesc::FLOAT, band.data());
    }
    file.commit();
}

void write_flat(const FrameFile& target, const FrameFormat& format, const Image& beauty,
                const OIIO::ImageSpec& spec) {
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
    const OIIO::ImageSpec spec = make_spec(format, frame.beauty, metadata);
    if (format.kind == FrameKind::exr)
        write_exr(target, format, frame, spec, metadata);
    else
        write_flat(target, format, frame.beauty, spec);
}

std::string pixel_hash(const Image& image) {
    return Sha256().add(image.pixels.data(), image.pixels.size() * sizeof(float)).hex();
}

}  // namespace astrosplat
