// The header of a frame file, as text pairs that every format can hold: no host, user or clock.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "output/write.h"

namespace astrosplat {

using MetadataEntries = std::vector<std::pair<std::string, std::string>>;

/// "astrosplat/version", "/frameHash", "/pixelHash", "/seed", "/frame", "/fps" and, where not empty,
/// "/hashed" (hashed_text.h), "/title", "/credit", "/type".
MetadataEntries metadata_entries(const FrameMetadata& metadata);

/// The entries as lines "name=value" (line breaks in values become spaces): TIFF's ImageDescription.
std::string metadata_lines(const MetadataEntries& entries);
/// Such lines by name; the first of those with one name.
std::map<std::string, std::string> parse_metadata_lines(std::string_view lines);

/// Frames per second as a fraction: 24 is 24/1, 23.976 is 24000/1001; others to a thousandth.
struct Rational {
    int numerator, denominator;
};
Rational rational_fps(double fps);

}  // namespace astrosplat
