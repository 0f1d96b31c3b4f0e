// The rules of which depth, compression and extra channels each file format knows, as one table.
#include "output/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/file_format.h"
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

const KindRules& rules_for(const std::filesystem::path& file) {
    const FileFormat* const format = format_by_name(file);
    for (const KindRules& rule : rules())
        if (format && format->id == rule.format) return rule;
    throw InputError(
        fmt::format("output.path: expected a file ending in .exr, .tif or .png, found '{}'", file.string()));
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

FrameFormat resolve_format(const OutputParams& output, const std::filesystem::path& file) {
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
        const auto found = places.find(error.key);
        if (found == places.end()) throw;
        throw InputError(fmt::format("{}: {}", found->second, error.what()));
    }
}

}  // namespace astrosplat
