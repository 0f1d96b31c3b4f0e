// Rows of catalogues for tests, written here after the formats' descriptions.
#pragma once

#include <fmt/format.h>

#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace astrosplat::test {

struct HipparcosRow {
    std::string magnitude = "6.53", ra = "000.05331696", dec = "+38.30408636", parallax = "4.12",
                color_index = "0.955", hms = "00 00 12.80", dms = "+38 18 14.7";
};

/// The luminance of a colour, in double.
inline double flux_of(const glm::vec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

/// A line of 78 fields, most of them empty, as wide as the catalogue's.
inline std::string hipparcos_line(const HipparcosRow& row) {
    std::vector<std::string> fields(78, " ");
    fields[0] = "H";
    fields[3] = row.hms;
    fields[4] = row.dms;
    fields[5] = fmt::format("{:>5}", row.magnitude);
    fields[8] = fmt::format("{:>12}", row.ra);
    fields[9] = fmt::format("{:>12}", row.dec);
    fields[11] = fmt::format("{:>7}", row.parallax);
    fields[37] = fmt::format("{:>6}", row.color_index);
    std::string line;
    for (std::size_t i = 0; i < fields.size(); ++i) line += (i == 0 ? "" : "|") + fields[i];
    return line + "\n";
}

inline const char* const hyg_header =
    "\"id\",\"hip\",\"hd\",\"hr\",\"gl\",\"bf\",\"proper\",\"ra\",\"dec\",\"dist\",\"pmra\",\"pmdec\",\"rv\","
    "\"mag\",\"absmag\",\"spect\",\"ci\",\"x\",\"y\",\"z\"\n";

}  // namespace astrosplat::test
