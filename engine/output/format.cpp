// The rules of which depth, compression and extra channels each file format knows, as one table; then alpha
// rule, exposure, view transform, dither and rounding of the numbers.
#include "output/format.h"

#include <fmt/format.h>

#include "core/color.h"
#include "core/error.h"
#include "core/file_format.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/text.h"

namespace astrosplat {
namespace {

using Depth = OutputParams::Depth;
using Compression = OutputParams::Compression;
using Alpha = OutputParams::Alpha;
using View = OutputParams::View;

struct KindRules {
    FrameKind kind;
    const char* name;
    std::string_view format;                // of core/file_format.h
    std::vector<Depth> depths;              // the first is "auto"
    std::vector<Compression> compressions;  // the first is "auto"
    Alpha automatic_alpha;
    const char* depths_text;
    const char* compressions_text;
};

const std::array<KindRules, 3>& rules() {
    static const std::array<KindRules, 3> table = {{
        {FrameKind::exr,
         "exr",
         "openexr",
         {Depth::half_float, Depth::float32},
         {Compression::zip, Compression::zips, Compression::piz, Compression::dwaa, Compression::none},
         Alpha::premultiplied,
         "half or float",
         "zip, zips, piz, dwaa or none"},
        {FrameKind::tif,
         "tif",
         "tiff",
         {Depth::uint16, Depth::uint8, Depth::float32},
         {Compression::deflate, Compression::lzw, Compression::none},
         Alpha::premultiplied,
         "8, 16 or float",
         "deflate, lzw or none"},
        {FrameKind::png,
         "png",
         "png",
         {Depth::uint8, Depth::uint16},
         {Compression::deflate},
         Alpha::none,
         "8 or 16",
         "auto"},
    }};
    return table;
}

const KindRules& rules_for(const fs::path& file) {
    const FileFormat* const format = format_by_name(file);
    for (const KindRules& rule : rules())
        if (format && format->id == rule.format) return rule;
    throw InputError(fmt::format("output.path: expected a file ending in {}, found '{}'",
                                 alternatives(endings_of({FileKind::picture}, FileUse::written)),
                                 file.string()));
}

template <class T>
bool contains(const std::vector<T>& list, T value) {
    return std::ranges::find(list, value) != list.end();
}

void check_aovs(const OutputParams& output, const KindRules& rule) {
    const auto& known = OutputParams::known_aovs;
    for (const std::string& aov : output.aovs)
        if (std::ranges::find(known, aov) == known.end())
            throw InputError(fmt::format("output.aovs: expected {}, found '{}'",
                                         alternatives({known.begin(), known.end()}), aov));
    if (!output.aovs.empty() && rule.kind != FrameKind::exr)
        throw InputError(
            fmt::format("output.aovs: expected none in {} files (extra channels need exr), found '{}'",
                        rule.name, output.aovs.front()));
}

}  // namespace

FrameFormat resolve_format(const OutputParams& output, const fs::path& file) {
    const KindRules& rule = rules_for(file);
    FrameFormat format;
    format.kind = rule.kind;
    format.depth = output.depth == Depth::automatic ? rule.depths.front() : output.depth;
    if (!contains(rule.depths, format.depth))
        throw InputError(fmt::format("output.depth: expected {} in {} files, found {}", rule.depths_text,
                                     rule.name, name_of(output.depth)));
    bool automatic = output.compression == Compression::automatic;
    format.compression = automatic ? rule.compressions.front() : output.compression;
    if (!contains(rule.compressions, format.compression))
        throw InputError(fmt::format("output.compression: expected {} in {} files, found {}",
                                     rule.compressions_text, rule.name, name_of(output.compression)));
    check_aovs(output, rule);
    format.alpha = output.alpha == Alpha::automatic ? rule.automatic_alpha : output.alpha;
    if (format.holds_view()) {
        format.view = output.view == View::automatic ? View::srgb : output.view;
        format.exposure = output.exposure;
        if (output.ocio.wanted()) format.ocio = display_transform(output.ocio);
    } else if (format.kind == FrameKind::exr) {
        format.primaries = output.primaries;
    } else if (output.primaries != OutputParams::Primaries::rec709) {
        // Float tif has no place to say so.
        throw InputError(fmt::format("output.primaries: expected rec709 in float {} files, found {}",
                                     rule.name, name_of(output.primaries)));
    }
    return format;
}

void check_output(const OutputParams& output, const Places& places) {
    if (output.width < 1 || output.height < 1)
        throw InputError(fmt::format("output.resolution: expected at least 1 x 1 px, found {} x {}",
                                     output.width, output.height));
    try {
        resolve_format(output, output.path);
    } catch (const OcioError& error) {
        const std::string place = place_of(places, error.key, "");
        if (place.empty()) throw;
        throw InputError(fmt::format("{}: {}", place, error.what()));
    }
}

namespace {

using Alpha = OutputParams::Alpha;
using View = OutputParams::View;

float clamp01(float x) { return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; }

float soft_curve(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

float gain_of(const FrameFormat& format) { return float(real::pow(2.0, format.exposure)); }

/// Colour over black, or divided by alpha where the format says so.
void unpremultiply(const FrameFormat& format, const float* rgba, float* rgb) {
    const bool divide =
        format.alpha != Alpha::none && (format.holds_view() || format.alpha == Alpha::straight);
    for (int c = 0; c < 3; ++c) {
        rgb[c] = rgba[c];
        if (divide) rgb[c] = rgba[3] > 0.0f ? rgb[c] / rgba[3] : 0.0f;
    }
}

/// A format's view of `pixels` straight colours, in place.
void to_view(const FrameFormat& format, float gain, float* rgb, std::int64_t pixels) {
    if (!format.holds_view()) return;
    for (float* value = rgb; value != rgb + 3 * pixels; ++value)
        *value = format.ocio ? *value * gain : apply_view(format.view, *value * gain);
    if (format.ocio) format.ocio->apply(rgb, pixels);
}

/// The stored value of a straight colour.
void store(const FrameFormat& format, const float* rgb, float own_alpha, float* stored) {
    const bool view = format.holds_view();
    const float alpha = view ? clamp01(own_alpha) : own_alpha;
    const bool multiply = view && format.alpha == Alpha::premultiplied;
    for (int c = 0; c < 3; ++c) stored[c] = multiply ? rgb[c] * alpha : rgb[c];
    if (format.alpha != Alpha::none) stored[3] = alpha;
}

// Rows of channels that put(x, y, encoded, out) makes of every pixel, on all threads.
template <class T, class Put>
std::vector<T> encode_rows(const FrameFormat& format, const Image& image, const Put& put) {
    const int channels = stored_channels(format);
    const float gain = gain_of(format);
    std::vector<T> samples(std::size_t(image.width * image.height * channels));
    parallel_each(image.height, 16, [&](std::int64_t y) {
        T* out = samples.data() + y * image.width * channels;
        std::vector<float> colors(std::size_t(3 * image.width));
        for (std::int64_t x = 0; x < image.width; ++x)
            unpremultiply(format, image.at(x, y), colors.data() + 3 * x);
        to_view(format, gain, colors.data(), image.width);
        for (std::int64_t x = 0; x < image.width; ++x, out += channels) {
            float stored[4] = {0.0f, 0.0f, 0.0f, 1.0f};
            store(format, colors.data() + 3 * x, image.at(x, y)[3], stored);
            put(x, y, stored, out);
        }
    });
    return samples;
}

}  // namespace

float apply_view(View view, float value) {
    if (!(value > 0.0f)) return 0.0f;
    // Beyond 1e6 the soft curve has long met its limit; its squares would overflow.
    float x = view == View::soft ? soft_curve(std::fmin(value, 1e6f)) : value;
    return view == View::linear ? clamp01(x) : display_srgb(x);
}

float dither(std::int64_t x, std::int64_t y, int channel) {
    // 2^32 over the plastic number and over its square: M. Roberts, "The unreasonable effectiveness of
    // quasirandom sequences" (2018). The third factor, 2^32 over the golden ratio, takes the channels apart.
    std::uint32_t lattice = std::uint32_t(x) * 0xC13FA9A9u + std::uint32_t(y) * 0x91E10DA5u +
                            std::uint32_t(channel) * 0x9E3779B9u;
    // 255 levels at -127/256 .. 127/256: a value that is a multiple of 1/255 can never be rounded to
    // another one.
    std::uint64_t level = (std::uint64_t{lattice} * 255u) >> 32;
    return (float(level) - 127.0f) / 256.0f;
}

int stored_channels(const FrameFormat& format) { return format.alpha == Alpha::none ? 3 : 4; }

void encode_pixel(const FrameFormat& format, float gain, const float* rgba, float* stored) {
    float rgb[3];
    unpremultiply(format, rgba, rgb);
    to_view(format, gain, rgb, 1);
    store(format, rgb, rgba[3], stored);
}

std::vector<std::uint8_t> encode_8bit(const FrameFormat& format, const Image& image, std::int64_t x0,
                                      std::int64_t y0) {
    const int channels = stored_channels(format);
    const auto put = [&](std::int64_t x, std::int64_t y, const float* stored, std::uint8_t* out) {
        for (int c = 0; c < channels; ++c) {
            float code = std::floor(stored[c] * 255.0f + 0.5f + dither(x0 + x, y0 + y, c));
            out[c] = std::uint8_t(std::clamp(code, 0.0f, 255.0f));
        }
        if (format.alpha == Alpha::premultiplied)
            for (int c = 0; c < 3; ++c) out[c] = std::min(out[c], out[3]);
    };
    return encode_rows<std::uint8_t>(format, image, put);
}

std::vector<std::uint16_t> encode_16bit(const FrameFormat& format, const Image& image) {
    const int channels = stored_channels(format);
    return encode_rows<std::uint16_t>(
        format, image, [=](std::int64_t, std::int64_t, const float* stored, std::uint16_t* out) {
            for (int c = 0; c < channels; ++c) out[c] = std::uint16_t(stored[c] * 65535.0f + 0.5f);
        });
}

Image encode_float(const FrameFormat& format, const Image& image) {
    const bool converted = format.primaries == OutputParams::Primaries::acescg;
    const glm::dmat3 matrix = primaries_matrix(rec709_chromaticities, acescg_chromaticities);
    Image result{image.width, image.height, stored_channels(format), {}};
    result.pixels.resize(image.width * image.height * result.channels);
    parallel_each(image.height, 16, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < image.width; ++x) {
            float* const stored = result.at(x, y);
            encode_pixel(format, 1.0f, image.at(x, y), stored);
            if (!converted) continue;
            const glm::dvec3 light = matrix * glm::dvec3(stored[0], stored[1], stored[2]);
            for (int c = 0; c < 3; ++c) stored[c] = float(light[c]);
        }
    });
    return result;
}

}  // namespace astrosplat
