// PLY, byte by byte, so that the file is little-endian on every machine.
#include "splat_rows.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace astrosplat::assets {
namespace {

void append(std::string& data, float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int shift = 0; shift < 32; shift += 8) data += static_cast<char>((bits >> shift) & 255u);
}

}  // namespace

void save_ply(const std::vector<SplatRow>& rows, const std::filesystem::path& file, const std::string& what) {
    std::string data = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment {}; made by astrosplat_make_assets\nelement vertex "
        "{}\n",
        what, rows.size());
    for (const char* name : {"x", "y", "z", "red", "green", "blue", "alpha", "radius"})
        data += fmt::format("property float {}\n", name);
    data += "end_header\n";
    for (const SplatRow& r : rows)
        for (const float value :
             {r.place.x, r.place.y, r.place.z, r.color.x, r.color.y, r.color.z, r.alpha, r.radius})
            append(data, value);
    std::ofstream out(file, std::ios::binary);
    out << data;
    if (!out.flush()) throw OutputError(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace astrosplat::assets
