// Gaussians of compressed files (SPZ, SuperSplat's PLY, .splat, SOG). In: a file's bytes and what it says of
// itself. Out: numbers of a few bits as they are meant, bytes behind zlib, and sets filled row by row.
#pragma once

#include <cstring>
#include <glm/vec4.hpp>

#include "core/parallel.h"
#include "splat_files/gaussian_rows.h"

namespace astrosplat {

/// The little-endian number at `p`, on any alignment.
template <class T>
T number_at(const char* p) {
    static_assert(std::endian::native == std::endian::little);
    T value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

inline int byte_at(const char* p) { return static_cast<unsigned char>(*p); }
/// 0..1.
inline float fraction_at(const char* p) { return float(byte_at(p)) / 255.0f; }

/// A unit quaternion x y z w of three of its numbers, in this order, the one at `largest` left out and not
/// negative.
glm::vec4 quaternion_without(int largest, const glm::vec3& others);

/// Decompresses what it takes from the start of `from` until `to` is full or nothing more comes; how many
/// bytes came. `window_bits` are inflateInit2's: 31 for gzip, -15 for the streams of a ZIP.
std::size_t inflate_to(std::string_view& from, std::span<char> to, int window_bits);

/// Throws InputError where a file of so many bytes cannot hold `count` Gaussians. No byte of zlib's stands
/// for more than 1032, and no reader of SPZ takes more of Zstandard's; the positions of one take 6 or more.
/// Beyond two million, which are read within a second, a byte holds two: captures take ten bytes for one.
std::int64_t demand_plausible_count(const fs::path& file, std::string_view place, std::uint64_t count,
                                    std::size_t bytes);

/// One line where bytes follow that no reader knows.
void warn_of_rest(const fs::path& file, std::size_t bytes);

/// A set of `count` Gaussians: put(set, i) sets position, scale (no logarithm), rotation, alpha, and
/// harmonics or, where they are not `directional`, the coefficients of degree 0 in color; display values.
/// Throws InputError where there is no memory for it, Cancelled.
template <class Put>
SplatSet packed_gaussians(std::int64_t count, bool directional, const fs::path& file,
                          const Progress& progress, const Put& put) {
    SplatSet set = room_for_gaussians(count, directional, "splats of " + file.string());
    constexpr std::int64_t rows_at_once = 1 << 14;
    parallel_chunks(count, rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
        progress.check();
        for (auto i = std::size_t(begin); i < std::size_t(end); ++i) put(set, i);
    });
    return finish_gaussians(std::move(set), {}, file);
}

/// Where packed_gaussians() wants the coefficients of degree 0.
inline glm::vec3& mean_harmonic(SplatSet& set, std::size_t i) {
    return set.harmonics.empty() ? set.color[i] : set.harmonics[i].c[0];
}

}  // namespace astrosplat
