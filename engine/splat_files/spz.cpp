// SPZ: one gzip stream of all numbers of a kind after the other (versions 1 to 3), or a Zstandard stream for
// each behind a table of their sizes (4). All sizes follow from the header, and are compared with the file
// before anything is taken.
#include "splat_files/spz_numbers.h"

#include <fmt/format.h>
#include <zstd.h>

#include <glm/gtc/packing.hpp>
#include <numeric>

#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/real.h"
#include "splat_files/file_bytes.h"
#include "splat_files/formats.h"
#include "splat_files/packed_gaussians.h"
#include "splat_files/splat_table.h"

namespace astrosplat {
namespace {

constexpr std::string_view spz_header = "header";
constexpr int gzip_window = 31;

struct SpzFile {
    const fs::path& file;
    std::string_view bytes;
    bool zipped = false;  // versions 1 to 3
    std::uint32_t version = 0;
    std::int64_t count = 0;
    int degree = 0, fraction_bits = 0;
    int flags = 0;                         // 1: trained antialiased
    std::size_t tables = 0, table_at = 0;  // version 4

    int position_bytes() const { return version == 1 ? 2 : 3; }  // of a coordinate
    int rotation_bytes() const { return version < 3 ? 3 : 4; }
    bool extended() const { return (flags & 2) != 0; }
    int harmonic_bytes() const { return 3 * ((degree + 1) * (degree + 1) - 1); }
    /// Bytes of all numbers of a kind.
    std::array<std::size_t, spz::streams> sizes() const {
        std::array<std::size_t, spz::streams> sizes{};
        const int each[spz::streams] = {3 * position_bytes(), 1, 3, 3, rotation_bytes(), harmonic_bytes()};
        for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::size_t(count) * std::size_t(each[i]);
        return sizes;
    }
};

SpzFile spz_header_of(const fs::path& file, std::string_view bytes) {
    constexpr std::size_t old_header = 16;
    std::string_view packed = bytes;
    SpzFile spz{file, bytes, bytes.starts_with("\x1f\x8b")};
    std::array<char, spz::header_bytes> head{};
    const std::size_t wanted = spz.zipped ? old_header : head.size();
    const std::size_t found = spz.zipped ? inflate_to(packed, std::span(head).first(wanted), gzip_window)
                                         : bytes.copy(head.data(), wanted);
    if (found < wanted || !std::string_view(head.data(), head.size()).starts_with(spz::magic))
        bad_input(file, spz_header, "'NGSP', or gzip around it", quoted(bytes.substr(0, spz::magic.size())));
    spz.version = number_at<std::uint32_t>(&head[4]);
    if (spz.zipped ? spz.version < 1 || spz.version > 3 : spz.version != 4)
        bad_input(file, spz_header, spz.zipped ? "version 1, 2 or 3 in gzip" : "version 4",
                  std::to_string(spz.version));
    spz.count = demand_plausible_count(file, spz_header, number_at<std::uint32_t>(&head[8]), bytes.size());
    spz.degree = byte_at(&head[12]);
    spz.fraction_bits = byte_at(&head[13]);
    if (spz.degree > 4) bad_input(file, spz_header, "harmonics of degree 0 to 4", std::to_string(spz.degree));
    if (spz.fraction_bits > 30)
        bad_input(file, spz_header, "at most 30 bits of a fraction", std::to_string(spz.fraction_bits));
    spz.flags = byte_at(&head[14]);
    spz.tables = std::size_t(byte_at(&head[15]));
    spz.table_at = number_at<std::uint32_t>(&head[16]);
    return spz;
}

/// What follows the numbers (versions up to 3) or the header: records of a type, a length and so many bytes.
struct SpzExtensions {
    std::uint32_t axes = 0;  // as SPZ_ADOBE_coordinate_system numbers them; 0: as always
};

SpzExtensions spz_extensions(const SpzFile& spz, std::string_view records) {
    constexpr std::uint32_t safe_orbit = 0xadbe0002, coordinate_system = 0xadbe0003, most_axes = 16;
    SpzExtensions known;
    std::uint32_t unknown = 0;
    while (records.size() >= 8) {
        const auto type = number_at<std::uint32_t>(records.data()),
                   size = number_at<std::uint32_t>(&records[4]);
        records.remove_prefix(8);
        if (size > records.size())
            bad_input(spz.file, "extensions", fmt::format("{} bytes", size), std::to_string(records.size()));
        if (type == coordinate_system && size >= 4)
            known.axes = number_at<std::uint32_t>(records.data());
        else if (type != safe_orbit)
            unknown = type;
        records.remove_prefix(size);
    }
    if (known.axes > most_axes)
        bad_input(spz.file, "extensions", "axes of number 0 to 16", std::to_string(known.axes));
    if (unknown != 0)
        log_warning(fmt::format("{}: its extension {:#010x} is not followed", spz.file.string(), unknown));
    return known;
}

/// What leads from axes read as if they were right, up and back to right, down and front, for `axes` that are
/// others: the bits of their number less 1 say right, up, front, and whether z leads up and y to the front.
glm::dmat3 turn_of_axes(std::uint32_t axes) {
    const std::uint32_t bits = axes - 1;
    const auto sign = [&](int bit) { return bits >> bit & 1u ? 1.0 : -1.0; };
    const int up = bits & 8u ? 2 : 1;
    glm::dmat3 turn(0.0);
    turn[0][0] = sign(0);
    turn[up][1] = sign(1);
    turn[3 - up][2] = -sign(2);
    return turn;
}

struct SpzNumbers {
    Buffer<char> bytes;
    std::array<const char*, spz::streams> begin{};
    SpzExtensions extensions;
};

void read_zipped(const SpzFile& spz, std::size_t size, SpzNumbers& numbers) {
    constexpr std::size_t old_header = 16, most_extensions = 1 << 16;
    Buffer<char> all(old_header + size + (spz.extended() ? most_extensions : 1));
    std::string_view rest = spz.bytes;
    const std::size_t found = inflate_to(rest, all, gzip_window);
    if (found < old_header + size || (!spz.extended() && found > old_header + size))
        bad_input(spz.file, "gzip", fmt::format("{} bytes of {} splats", old_header + size, spz.count),
                  found > old_header + size ? "more" : std::to_string(found));
    warn_of_rest(spz.file, rest.size());
    numbers.extensions = spz_extensions(spz, std::string_view(all.data(), found).substr(old_header + size));
    numbers.bytes = std::move(all);
    numbers.begin[0] = numbers.bytes.data() + old_header;
}

void read_streams(const SpzFile& spz, std::size_t size, const Progress& progress, SpzNumbers& numbers) {
    const std::array<std::size_t, spz::streams> sizes = spz.sizes();
    const auto expected = std::size_t(std::ranges::count_if(sizes, [](std::size_t n) { return n > 0; }));
    constexpr std::string_view place = "streams";
    if (spz.tables != expected)
        bad_input(spz.file, place, fmt::format("{} of them", expected), std::to_string(spz.tables));
    const std::size_t file_size = spz.bytes.size();
    if (spz.table_at < spz::header_bytes || spz.table_at > file_size ||
        expected * spz::entry_bytes > file_size - spz.table_at)
        bad_input(spz.file, place, "a table of them within the file", fmt::format("byte {}", spz.table_at));
    if (spz.extended())
        numbers.extensions =
            spz_extensions(spz, spz.bytes.substr(spz::header_bytes, spz.table_at - spz::header_bytes));
    std::array<std::string_view, spz::streams> from;
    const char* entry = spz.bytes.data() + spz.table_at;
    std::string_view rest = spz.bytes.substr(spz.table_at + expected * spz::entry_bytes);
    for (std::size_t i = 0; i < expected; ++i, entry += spz::entry_bytes) {  // only the last may be empty
        const auto packed = number_at<std::uint64_t>(entry), whole = number_at<std::uint64_t>(entry + 8);
        if (packed > rest.size() || whole != sizes[i])
            bad_input(spz.file, place, fmt::format("{} bytes in at most {}", sizes[i], rest.size()),
                      fmt::format("{} in {}", whole, packed));
        from[i] = rest.substr(0, packed);
        rest.remove_prefix(packed);
    }
    warn_of_rest(spz.file, rest.size());
    numbers.bytes.resize(size);
    parallel_parts(expected, progress, [&](std::size_t i) {
        char* const to =
            numbers.bytes.data() + std::accumulate(sizes.begin(), sizes.begin() + i, std::size_t{0});
        if (ZSTD_decompress(to, sizes[i], from[i].data(), from[i].size()) != sizes[i])
            bad_input(spz.file, place, fmt::format("{} bytes compressed by Zstandard", sizes[i]),
                      "something else");
    });
    numbers.begin[0] = numbers.bytes.data();
}

SpzNumbers spz_numbers(const SpzFile& spz, const Progress& progress) {
    const std::array<std::size_t, spz::streams> sizes = spz.sizes();
    const std::size_t size = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
    claim_memory(std::int64_t(size), "reading " + spz.file.string());
    SpzNumbers numbers;
    if (spz.zipped)
        read_zipped(spz, size, numbers);
    else
        read_streams(spz, size, progress, numbers);
    for (std::size_t i = 1; i < sizes.size(); ++i) numbers.begin[i] = numbers.begin[i - 1] + sizes[i - 1];
    return numbers;
}

glm::vec3 spz_position(const SpzFile& spz, const char* p) {
    glm::vec3 position;
    for (int k = 0; k < 3; ++k, p += spz.position_bytes()) {
        if (spz.version == 1) {
            position[k] = glm::unpackHalf1x16(number_at<std::uint16_t>(p));
        } else {
            const int fixed = byte_at(p) | byte_at(p + 1) << 8 | number_at<std::int8_t>(p + 2) * 65536;
            position[k] = float(std::ldexp(double(fixed), -spz.fraction_bits));
        }
    }
    return position;
}

glm::vec4 spz_rotation(const SpzFile& spz, const char* p) {
    if (spz.version < 3) {
        glm::vec3 others;
        for (int k = 0; k < 3; ++k) others[k] = float(double(byte_at(p + k)) / 127.5 - 1.0);
        return quaternion_without(3, others);
    }
    const auto bits = number_at<std::uint32_t>(p);
    glm::vec3 others;
    for (int k = 0; k < 3; ++k) {  // the first highest, each a sign and nine bits
        const std::uint32_t own = bits >> (20 - 10 * k);
        const double size = std::sqrt(0.5) * double(own & 511u) / double(spz::quaternion_steps);
        others[k] = float(own & 512u ? -size : size);
    }
    return quaternion_without(int(bits >> 30), others);
}

SplatSet spz_set(const SpzFile& spz, const Progress& progress) {
    const SpzNumbers numbers = spz_numbers(spz, progress);
    std::array<float, 256> scales{};
    for (std::size_t i = 0; i < scales.size(); ++i)
        scales[i] = float(real::exp(double(i) / spz::log_scale_steps + spz::log_scale_least));
    const std::size_t rest =
        std::min<std::size_t>(std::size_t(spz.harmonic_bytes()) / 3, spz::harmonic_signs.size());
    if (const int unknown = spz.flags & ~3; unknown != 0)
        log_warning(fmt::format("{}: its flags {:#x} are not followed", spz.file.string(), unknown));
    if (spz.degree > 3)
        log_warning(fmt::format("{}: its harmonics of degree 4 are left out", spz.file.string()));
    const auto& [positions, alphas, colors, log_scales, rotations, harmonics] = numbers.begin;
    SplatSet set =
        packed_gaussians(spz.count, spz.degree > 0, spz.file, progress, [&](SplatSet& out, std::size_t i) {
            const glm::vec3 p = spz_position(spz, positions + i * std::size_t(3 * spz.position_bytes()));
            const glm::vec4 q = spz_rotation(spz, rotations + i * std::size_t(spz.rotation_bytes()));
            out.position[i] = {p.x, -p.y, -p.z};
            out.rotation[i] = {q.x, -q.y, -q.z, q.w};
            out.alpha[i] = fraction_at(alphas + i);
            for (int k = 0; k < 3; ++k) {
                const std::size_t at = 3 * i + std::size_t(k);
                out.scale[i][k] = scales[std::size_t(byte_at(log_scales + at))];
                mean_harmonic(out, i)[k] =
                    float((double(byte_at(colors + at)) / 255.0 - 0.5) / spz::color_scale);
            }
            const char* coefficient = harmonics + i * std::size_t(spz.harmonic_bytes());
            for (std::size_t j = 0; j < rest; ++j)
                for (int k = 0; k < 3; ++k)
                    out.harmonics[i].c[j + 1][k] =
                        spz::harmonic_signs[j] * float(byte_at(coefficient++) - 128) / 128.0f;
        });
    if (numbers.extensions.axes != 0)
        place_gaussians(set, 0, std::size_t(set.size()),
                        {1.0, turn_of_axes(numbers.extensions.axes), {}, true});
    return set;
}

template <class Result>
Result with_header(const fs::path& file, Result (*use)(const SpzFile&)) {
    return read_mapped(file, [&](std::string_view bytes) { return use(spz_header_of(file, bytes)); });
}

}  // namespace

SplatSet read_spz(const fs::path& file, const Progress& progress) {
    return read_mapped(file,
                       [&](std::string_view bytes) { return spz_set(spz_header_of(file, bytes), progress); });
}

SplatColumns spz_columns(const fs::path& file) {
    return with_header<SplatColumns>(file,
                                     [](const SpzFile& spz) { return gaussian_set_columns(spz.degree > 0); });
}

std::int64_t spz_splat_count(const fs::path& file) {
    return with_header<std::int64_t>(file, [](const SpzFile& spz) { return spz.count; });
}

}  // namespace astrosplat
