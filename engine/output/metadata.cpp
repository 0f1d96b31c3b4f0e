// Frame metadata as text.
#include "output/metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/text.h"
#include "output/hashed_text.h"

namespace astrosplat {
namespace {

// The value on one line, so that it cannot be mistaken for the next entry.
std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    return text;
}

}  // namespace

MetadataEntries metadata_entries(const FrameMetadata& metadata) {
    MetadataEntries entries = {
        {"astrosplat/version", ASTROSPLAT_VERSION},
        {"astrosplat/frameHash", metadata.frame_hash},
        {"astrosplat/pixelHash", metadata.pixel_hash},
        {"astrosplat/seed", std::to_string(metadata.seed)},
        {"astrosplat/frame", std::to_string(metadata.frame)},
        {"astrosplat/fps", shortest(metadata.fps)},
    };
    auto add = [&](const char* name, const std::string& value) {
        if (!value.empty()) entries.emplace_back(name, one_line(value));
    };
    if (!metadata.hashed_text.empty())
        entries.emplace_back("astrosplat/hashed", pack_hashed_text(metadata.hashed_text));
    add("astrosplat/title", metadata.provenance.title);
    add("astrosplat/credit", metadata.provenance.credit);
    add("astrosplat/type", metadata.provenance.type);
    return entries;
}

std::string metadata_lines(const MetadataEntries& entries) {
    std::string lines;
    for (const auto& [name, value] : entries) lines += fmt::format("{}={}\n", name, value);
    return lines;
}

std::map<std::string, std::string> parse_metadata_lines(std::string_view lines) {
    std::map<std::string, std::string> entries;
    while (!lines.empty()) {
        const std::string_view line = lines.substr(0, lines.find('\n'));
        lines.remove_prefix(std::min(line.size() + 1, lines.size()));
        if (const std::size_t equals = line.find('='); equals != line.npos)
            entries.emplace(line.substr(0, equals), line.substr(equals + 1));
    }
    return entries;
}

Rational rational_fps(double fps) {
    double ntsc = std::round(fps * 1.001);
    if (std::fabs(ntsc * 1000.0 / 1001.0 - fps) < 0.0005 && std::fabs(ntsc - fps) > 0.0005)
        return {static_cast<int>(ntsc) * 1000, 1001};
    int thousandths = static_cast<int>(std::round(std::fmin(fps, 1e6) * 1000.0));
    int common = std::gcd(thousandths, 1000);
    return {thousandths / common, 1000 / common};
}

}  // namespace astrosplat
