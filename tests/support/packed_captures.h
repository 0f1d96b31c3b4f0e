// The small captures of capture.h as the files that hold them in a few bytes each, by the formats' own words:
// SPZ, SuperSplat's compressed PLY, .splat, SOG.
#pragma once

#include <webp/encode.h>
#include <zlib.h>
#include <zstd.h>

#include <glm/gtc/packing.hpp>

#include "support/capture.h"

namespace astrosplat::test {

inline std::string number_bytes(std::uint64_t n, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += char(n >> 8 * i & 255);
    return text;
}

inline char code_of(double value) { return char(std::lround(std::clamp(value, 0.0, 255.0))); }

/// Deflated; `window_bits` are deflateInit2's.
inline std::string deflated(const std::string& bytes, int window_bits) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

inline std::string zstandard(const std::string& bytes) {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
    return out;
}

/// x y z w as `bits` bits each but the largest, whose number comes first; `of` puts a number of at most
/// sqrt(1/2) into the bits.
template <class Put>
std::uint32_t smallest_three(glm::dvec4 q, const Put& of) {
    int largest = 0;
    for (int k = 1; k < 4; ++k)
        if (std::fabs(q[k]) > std::fabs(q[largest])) largest = k;
    if (q[largest] < 0.0) q = -q;
    auto bits = std::uint32_t(largest);
    for (int k = 0; k < 4; ++k)
        if (k != largest) bits = bits << 10 | of(q[k]);
    return bits;
}

/// The sign that coefficient j beyond degree 0 takes where y and z change theirs: -1 for functions that are
/// odd in y and z together.
inline double turned_sign(std::size_t j) {
    constexpr std::string_view odd = "oo.o..o.o.oo.o.";  // y z x, xy yz zz xz xx, and seven of degree 3
    return odd[j] == 'o' ? -1.0 : 1.0;
}

/// SPZ of version 1 to 4: numbers of a kind after the other. `extensions`: records, of which the flags tell.
inline std::string spz_of(const std::vector<Trained>& all, int degree, int version,
                          const std::string& extensions = "", int fraction_bits = 12) {
    std::array<std::string, 6> streams;
    auto& [positions, alphas, colors, scales, rotations, harmonics] = streams;
    for (const Trained& g : all) {
        const glm::dvec3 p(g.position.x, -g.position.y, -g.position.z);
        glm::dvec4 q(g.rotation.x, -g.rotation.y, -g.rotation.z, g.rotation.w);
        for (int k = 0; k < 3; ++k) {
            positions += version == 1
                             ? number_bytes(glm::packHalf1x16(float(p[k])), 2)
                             : number_bytes(std::uint64_t(std::llround(std::ldexp(p[k], fraction_bits))), 3);
            colors += code_of((g.harmonics[0][k] * 0.15 + 0.5) * 255.0);
            scales += code_of((std::log(g.scale[k]) + 10.0) * 16.0);
        }
        alphas += code_of(g.opacity * 255.0);
        if (version < 3) {
            if (q.w < 0.0) q = -q;
            for (int k = 0; k < 3; ++k) rotations += code_of(q[k] * 127.5 + 127.5);
        } else {
            rotations += number_bytes(
                smallest_three(q,
                               [](double v) {
                                   return std::uint32_t(std::lround(std::fabs(v) * std::sqrt(2.0) * 511.0)) |
                                          (v < 0.0 ? 512u : 0u);
                               }),
                4);
        }
        for (int j = 1; j < (degree + 1) * (degree + 1); ++j)
            for (int k = 0; k < 3; ++k)
                harmonics +=
                    code_of(turned_sign(std::size_t(j - 1)) * g.harmonics[std::size_t(j)][k] * 128.0 + 128.0);
    }
    std::string header = "NGSP" + number_bytes(std::uint64_t(version), 4) + number_bytes(all.size(), 4) +
                         char(degree) + char(fraction_bits) + char(extensions.empty() ? 0 : 2);
    if (version < 4) {
        header += '\0';
        for (const std::string& stream : streams) header += stream;
        return deflated(header + extensions, 31);
    }
    std::string table, data;
    int kinds = 0;
    for (const std::string& stream : streams) {
        if (stream.empty()) continue;
        const std::string packed = zstandard(stream);
        table += number_bytes(packed.size(), 8) + number_bytes(stream.size(), 8);
        data += packed;
        ++kinds;
    }
    return header + char(kinds) + number_bytes(32 + extensions.size(), 4) + std::string(12, '\0') +
           extensions + table + data;
}

inline std::string dot_splat_of(const std::vector<Trained>& all) {
    std::string bytes;
    for (const Trained& g : all) {
        for (int k = 0; k < 3; ++k) put(bytes, g.position[k]);
        for (int k = 0; k < 3; ++k) put(bytes, g.scale[k]);
        for (int k = 0; k < 3; ++k) bytes += code_of((0.5 + 0.28209479177387814 * g.harmonics[0][k]) * 255.0);
        bytes += code_of(g.opacity * 255.0);
        for (const int k : {3, 0, 1, 2}) bytes += code_of(g.rotation[k] * 128.0 + 128.0);
    }
    return bytes;
}

/// `colors`: chunks have bounds of colours, as since 2024.
inline std::string compressed_ply_of(const std::vector<Trained>& all, int degree, bool colors = true) {
    constexpr std::size_t chunk = 256;
    const auto color_of = [](const Trained& g, int k) {
        return 0.5 + 0.28209479177387814 * g.harmonics[0][k];
    };
    std::string chunks, vertices, harmonics;
    const int rest = (degree + 1) * (degree + 1) - 1;
    for (std::size_t first = 0; first < all.size(); first += chunk) {
        const std::size_t end = std::min(all.size(), first + chunk);
        std::array<glm::dvec3, 6> bounds;  // least and most of positions, logarithms of scales, colours
        for (std::size_t b = 0; b < 3; ++b)
            bounds[2 * b] = glm::dvec3(1e9), bounds[2 * b + 1] = glm::dvec3(-1e9);
        const auto value = [&](std::size_t i, std::size_t b, int k) {
            const Trained& g = all[i];
            return b == 0 ? g.position[k] : b == 1 ? std::log(g.scale[k]) : color_of(g, k);
        };
        for (std::size_t i = first; i < end; ++i)
            for (std::size_t b = 0; b < 3; ++b)
                for (int k = 0; k < 3; ++k) {
                    bounds[2 * b][k] = std::min(bounds[2 * b][k], value(i, b, k));
                    bounds[2 * b + 1][k] = std::max(bounds[2 * b + 1][k], value(i, b, k));
                }
        if (!colors) bounds[4] = glm::dvec3(0.0), bounds[5] = glm::dvec3(1.0);
        for (std::size_t b = 0; b < (colors ? 6 : 4); ++b)
            for (int k = 0; k < 3; ++k) put(chunks, bounds[b][k]);
        for (std::size_t i = first; i < end; ++i) {
            const auto part = [&](std::size_t b, int k, double most) {
                const double least = bounds[2 * b][k],
                             t = (value(i, b, k) - least) / (bounds[2 * b + 1][k] - least);
                return std::uint64_t(std::lround(std::clamp(t, 0.0, 1.0) * most));
            };
            const auto three = [&](std::size_t b) {
                return number_bytes(part(b, 0, 2047.0) << 21 | part(b, 1, 1023.0) << 11 | part(b, 2, 2047.0),
                                    4);
            };
            const Trained& g = all[i];
            const glm::dvec4 w_first(g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z);
            vertices += three(0);
            vertices += number_bytes(
                smallest_three(
                    w_first,
                    [](double v) { return std::uint32_t(std::lround((v * std::sqrt(0.5) + 0.5) * 1023.0)); }),
                4);
            vertices += three(1);
            vertices +=
                number_bytes(part(2, 0, 255.0) << 24 | part(2, 1, 255.0) << 16 | part(2, 2, 255.0) << 8 |
                                 std::uint64_t(std::lround(g.opacity * 255.0)),
                             4);
            for (int k = 0; k < 3; ++k)
                for (int j = 1; j <= rest; ++j)
                    harmonics += char(
                        int(std::clamp((g.harmonics[std::size_t(j)][k] / 8.0 + 0.5) * 256.0, 0.0, 255.0)));
        }
    }
    const auto element = [](const char* name, std::size_t count, const std::string& type,
                            const std::vector<std::string>& names) {
        std::string text = std::string("element ") + name + " " + std::to_string(count) + "\n";
        for (const std::string& property : names) text += "property " + type + " " + property + "\n";
        return text;
    };
    std::vector<std::string> chunk_names, rest_names;
    for (const char* what : {"", "scale_", ""})
        for (const char* side : {"min_", "max_"})
            for (int k = 0; k < 3; ++k)
                chunk_names.push_back(std::string(side) + what +
                                      (chunk_names.size() < 12 ? "xyz"[k] : "rgb"[k]));
    if (!colors) chunk_names.resize(12);
    for (int i = 0; i < 3 * rest; ++i) rest_names.push_back("f_rest_" + std::to_string(i));
    std::string header = "ply\nformat binary_little_endian 1.0\n" +
                         element("chunk", (all.size() + chunk - 1) / chunk, "float", chunk_names) +
                         element("vertex", all.size(), "uint",
                                 {"packed_position", "packed_rotation", "packed_scale", "packed_color"});
    if (rest > 0) header += element("sh", all.size(), "uchar", rest_names);
    return header + "end_header\n" + chunks + vertices + harmonics;
}

/// A ZIP archive; files are stored, or deflated.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files, bool deflate) {
    std::string bytes, directory;
    for (const auto& [name, content] : files) {
        const std::string packed = deflate ? deflated(content, -15) : content;
        const std::string facts = number_bytes(deflate ? 8 : 0, 2) + std::string(8, '\0') +
                                  number_bytes(packed.size(), 4) + number_bytes(content.size(), 4) +
                                  number_bytes(name.size(), 2) + number_bytes(0, 2);
        directory += "PK\1\2" + number_bytes(20, 2) + number_bytes(20, 2) + number_bytes(0, 2) + facts +
                     std::string(10, '\0') + number_bytes(bytes.size(), 4) + name;
        bytes += "PK\3\4" + number_bytes(20, 2) + number_bytes(0, 2) + facts + name + packed;
    }
    return bytes + directory + "PK\5\6" + std::string(4, '\0') + number_bytes(files.size(), 2) +
           number_bytes(files.size(), 2) + number_bytes(directory.size(), 4) + number_bytes(bytes.size(), 4) +
           std::string(2, '\0');
}

/// SOG of version 2, whose codebooks are even steps from -4 to 4 of colours and harmonics and from -10 to 6
/// of scales' logarithms; each splat has its own place in the palette.
inline std::string sog_of(const std::vector<Trained>& all, int degree, bool deflate = false,
                          const std::string& version = "\"version\":2,") {
    const auto side = int(std::ceil(std::sqrt(double(all.size()))));
    const auto webp = [](const std::string& rgba, int width) {
        std::uint8_t* out = nullptr;
        const std::size_t size = WebPEncodeLosslessRGBA(reinterpret_cast<const std::uint8_t*>(rgba.data()),
                                                        width, int(rgba.size()) / 4 / width, 4 * width, &out);
        const std::string bytes(reinterpret_cast<const char*>(out), size);
        WebPFree(out);
        return bytes;
    };
    std::string low, high, turns, sizes, colors, places;
    const int rest = (degree + 1) * (degree + 1) - 1;
    std::string palette(std::size_t(4 * 64 * rest) * ((all.size() + 63) / 64), '\xff');
    constexpr double most = 2.0;  // ln(1 + 6.4)
    for (std::size_t i = 0; i < std::size_t(side * side); ++i) {
        const Trained& g = all[std::min(i, all.size() - 1)];
        for (int k = 0; k < 3; ++k) {
            const double place = std::copysign(std::log(1.0 + std::fabs(g.position[k])), g.position[k]);
            const long step = std::lround((place + most) / (2.0 * most) * 65535.0);
            low += char(step & 255);
            high += char(step >> 8);
            sizes += code_of((std::log(g.scale[k]) + 10.0) / 16.0 * 255.0);
            colors += code_of((g.harmonics[0][k] + 4.0) / 8.0 * 255.0);
        }
        const glm::dvec4 q(g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z);
        std::string bytes;
        const std::uint32_t largest = smallest_three(q, [&](double v) {
            bytes += code_of((v * std::sqrt(2.0) + 1.0) * 127.5);
            return 0u;
        });
        turns += bytes + char(252 + (largest >> 30));
        colors += code_of(g.opacity * 255.0);
        for (std::string* picture : {&low, &high, &sizes}) *picture += '\xff';
        places += number_bytes(i, 2) + std::string("\0\xff", 2);
        if (i >= all.size()) continue;
        const std::size_t first = (i / 64 * 64 * std::size_t(rest) + i % 64 * std::size_t(rest)) * 4;
        for (int j = 0; j < rest; ++j)
            for (int k = 0; k < 3; ++k)
                palette[first + std::size_t(4 * j + k)] =
                    code_of((g.harmonics[std::size_t(j + 1)][k] + 4.0) / 8.0 * 255.0);
    }
    const auto book = [](double least, double width) {
        std::string text = "\"codebook\":[";
        for (int i = 0; i < 256; ++i) text += (i ? "," : "") + std::to_string(least + width * i / 255.0);
        return text + "]";
    };
    std::string meta = "{" + version + "\"count\":" + std::to_string(all.size()) +
                       R"(,"means":{"mins":[-2,-2,-2],"maxs":[2,2,2],"files":["low.webp","high.webp"]},)"
                       R"("quats":{"files":["turns.webp"]},"scales":{"files":["sizes.webp"],)" +
                       book(-10.0, 16.0) + R"(},"sh0":{"files":["colors.webp"],)" + book(-4.0, 8.0) + "}";
    std::vector<std::pair<std::string, std::string>> files = {{"low.webp", webp(low, side)},
                                                              {"high.webp", webp(high, side)},
                                                              {"turns.webp", webp(turns, side)},
                                                              {"sizes.webp", webp(sizes, side)},
                                                              {"colors.webp", webp(colors, side)}};
    if (rest > 0) {
        meta += ",\"shN\":{\"count\":" + std::to_string(all.size()) + ",\"bands\":" + std::to_string(degree) +
                R"(,"files":["palette.webp","places.webp"],)" + book(-4.0, 8.0) + "}";
        files.emplace_back("palette.webp", webp(palette, 64 * rest));
        files.emplace_back("places.webp", webp(places, side));
    }
    files.emplace_back("meta.json", meta + "}");
    return zip_of(files, deflate);
}

}  // namespace astrosplat::test
