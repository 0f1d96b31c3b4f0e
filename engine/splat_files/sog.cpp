// SOG (PlayCanvas), version 2: a ZIP archive of meta.json and of lossless WebP pictures with a pixel a splat.
// Bytes of most numbers index codebooks of 256; harmonics are a palette that each splat has a place in. Axes
// as PLY's.
#include <fmt/format.h>
#include <webp/decode.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/memory.h"
#include "core/real.h"
#include "core/text.h"
#include "splat_files/file_bytes.h"
#include "splat_files/formats.h"
#include "splat_files/packed_gaussians.h"

namespace astrosplat {
namespace {

constexpr std::string_view meta_name = "meta.json";
constexpr std::size_t most_meta = 1 << 20;  // of four codebooks of 256 numbers, and names

// ---- ZIP archives of less than 4 GB, by the directory at their end (PKWARE's APPNOTE.TXT)

struct ZipEntry {
    std::uint16_t method = 0;
    std::size_t packed = 0, size = 0, header_at = 0;
};

/// The place of `size` bytes at `at`.
const char* zip_bytes_at(const fs::path& file, std::string_view bytes, std::size_t at, std::size_t size) {
    if (at > bytes.size() || size > bytes.size() - at)
        bad_input(file, "ZIP", fmt::format("{} bytes at byte {}", size, at), "the end of the file");
    return bytes.data() + at;
}

ZipEntry zip_entry(const fs::path& file, std::string_view bytes, std::string_view name) {
    constexpr std::size_t end_bytes = 22, longest_comment = 0xffff, entry_bytes = 46;
    const std::size_t tail = std::min(bytes.size(), end_bytes + longest_comment);
    const std::size_t found = bytes.substr(bytes.size() - tail).rfind("PK\5\6");
    if (found == std::string_view::npos || tail - found < end_bytes)
        bad_input(file, "ZIP", "a directory at its end", "none");
    const char* const end = bytes.data() + bytes.size() - tail + found;
    std::size_t at = number_at<std::uint32_t>(end + 16);
    for (int left = number_at<std::uint16_t>(end + 10); left > 0; --left) {
        const char* const p = zip_bytes_at(file, bytes, at, entry_bytes);
        const std::size_t length = number_at<std::uint16_t>(p + 28);
        const std::string_view own(zip_bytes_at(file, bytes, at + entry_bytes, length), length);
        if (own == name)
            return {number_at<std::uint16_t>(p + 10), number_at<std::uint32_t>(p + 20),
                    number_at<std::uint32_t>(p + 24), number_at<std::uint32_t>(p + 42)};
        at += entry_bytes + length + number_at<std::uint16_t>(p + 30) + number_at<std::uint16_t>(p + 32);
    }
    bad_input(file, "ZIP", fmt::format("a file '{}'", printable(name)), "none");
}

/// The bytes of the file `name` in the archive `bytes`, unpacked.
Buffer<char> zipped_file(const fs::path& file, std::string_view bytes, std::string_view name) {
    constexpr std::size_t local_bytes = 30, most_from_a_byte = 1032;  // the most that deflate packs
    constexpr int raw_deflate = -15;
    const ZipEntry entry = zip_entry(file, bytes, name);
    const char* const local = zip_bytes_at(file, bytes, entry.header_at, local_bytes);
    const std::size_t at = entry.header_at + local_bytes + number_at<std::uint16_t>(local + 26) +
                           number_at<std::uint16_t>(local + 28);
    std::string_view packed(zip_bytes_at(file, bytes, at, entry.packed), entry.packed);
    if (name == meta_name && entry.size > most_meta)
        bad_input(file, meta_name, fmt::format("at most {} bytes", most_meta), std::to_string(entry.size));
    if (entry.method == 0) return {packed.begin(), packed.end()};
    if (entry.method != 8 || entry.size > packed.size() * most_from_a_byte)
        bad_input(file, printable(name), "a stored or deflated file",
                  fmt::format("method {}, {} bytes in {}", entry.method, entry.size, packed.size()));
    claim_memory(std::int64_t(entry.size), "reading " + file.string());
    Buffer<char> out(entry.size);
    const std::size_t written = inflate_to(packed, out, raw_deflate);
    if (written != out.size())
        bad_input(file, printable(name), fmt::format("{} bytes", out.size()), std::to_string(written));
    return out;
}

// ---- SOG

using Json = nlohmann::json;
using Codebook = std::array<float, 256>;

constexpr std::int64_t palette_columns = 64;

/// Red, green, blue and alpha of each pixel.
struct SogPicture {
    Buffer<char> rgba;
    std::int64_t width = 0, pixels = 0;
    const char* at(std::size_t i) const { return rgba.data() + 4 * i; }
};

struct SogFile {
    const fs::path& file;
    std::string_view bytes;
    Json meta;
    std::int64_t count = 0;
    int rest = 0;  // harmonics a channel beyond degree 0

    [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
        bad_input(file, meta_name, expected, printable(found));
    }
    Codebook codebook(const char* part) const {
        const Json& numbers = meta.at(part).at("codebook");
        Codebook book{};
        if (numbers.size() != book.size())
            fail(fmt::format("{} numbers in the codebook of {}", book.size(), part),
                 std::to_string(numbers.size()));
        std::ranges::copy(numbers.get<std::vector<float>>(), book.begin());
        return book;
    }
    /// Picture number i of a part, of `least` pixels or somewhat more.
    SogPicture picture(const char* part, std::size_t i, std::int64_t least) const {
        const auto name = meta.at(part).at("files").at(i).get<std::string>();
        const Buffer<char> packed = zipped_file(file, bytes, name);
        const auto* const data = reinterpret_cast<const std::uint8_t*>(packed.data());
        int width = 0, height = 0;
        if (WebPGetInfo(data, packed.size(), &width, &height) == 0)
            bad_input(file, printable(name), "a WebP picture", "something else");
        SogPicture picture{{}, width, std::int64_t(width) * height};
        if (picture.pixels < least || picture.pixels > 2 * least + (1 << 20))
            bad_input(file, printable(name), fmt::format("about {} pixels", least),
                      fmt::format("{} x {}", width, height));
        claim_memory(4 * picture.pixels, "reading " + file.string());
        picture.rgba.resize(std::size_t(4 * picture.pixels));
        auto* const out = reinterpret_cast<std::uint8_t*>(picture.rgba.data());
        if (WebPDecodeRGBAInto(data, packed.size(), out, picture.rgba.size(), 4 * width) == nullptr)
            bad_input(file, printable(name), "a whole WebP picture", "a damaged one");
        return picture;
    }
};

SogFile open_sog(const fs::path& file, std::string_view bytes) {
    SogFile sog{file, bytes, Json::parse(zipped_file(file, bytes, meta_name))};
    const Json version = sog.meta.value("version", Json("none"));
    if (version != 2)
        sog.fail("version 2 (splat-transform makes one of others)", "version " + version.dump());
    sog.count =
        demand_plausible_count(file, meta_name, sog.meta.at("count").get<std::uint64_t>(), bytes.size());
    if (!sog.meta.contains("shN")) return sog;
    const int bands = sog.meta.at("shN").at("bands").get<int>();
    if (bands < 1 || bands > 3) sog.fail("1 to 3 bands of harmonics", std::to_string(bands));
    sog.rest = (bands + 1) * (bands + 1) - 1;
    return sog;
}

/// What a palette of harmonics says of each splat.
struct SogHarmonics {
    SogPicture palette, places;
    Codebook book{};
    std::int64_t colors = 0;  // of the palette

    void put(int rest, std::size_t i, Harmonics& out) const {
        const std::int64_t place = byte_at(places.at(i)) | byte_at(places.at(i) + 1) << 8;
        if (place >= colors) return;
        const std::int64_t first = place / palette_columns * palette.width + place % palette_columns * rest;
        for (int j = 0; j < rest; ++j)
            for (int k = 0; k < 3; ++k)
                out.c[std::size_t(j) + 1][k] =
                    book[std::size_t(byte_at(palette.at(std::size_t(first + j)) + k))];
    }
};

SogHarmonics sog_harmonics(const SogFile& sog) {
    SogHarmonics harmonics;
    if (sog.rest == 0) return harmonics;
    harmonics.colors = sog.meta.at("shN").at("count").get<std::int64_t>();
    if (harmonics.colors < 1 || harmonics.colors > 65536)
        sog.fail("a palette of 1 to 65536", std::to_string(harmonics.colors));
    const std::int64_t rows = (harmonics.colors + palette_columns - 1) / palette_columns;
    harmonics.palette = sog.picture("shN", 0, rows * palette_columns * sog.rest);
    harmonics.places = sog.picture("shN", 1, sog.count);
    harmonics.book = sog.codebook("shN");
    if (harmonics.palette.width != palette_columns * sog.rest)
        sog.fail(fmt::format("a palette {} pixels wide", palette_columns * sog.rest),
                 std::to_string(harmonics.palette.width));
    return harmonics;
}

SplatSet sog_set(const SogFile& sog, const Progress& progress) {
    const SogPicture low = sog.picture("means", 0, sog.count), high = sog.picture("means", 1, sog.count),
                     turns = sog.picture("quats", 0, sog.count), sizes = sog.picture("scales", 0, sog.count),
                     colors = sog.picture("sh0", 0, sog.count);
    const SogHarmonics harmonics = sog_harmonics(sog);
    const Codebook color_book = sog.codebook("sh0");
    Codebook scale_book = sog.codebook("scales");
    for (float& scale : scale_book) scale = float(real::exp(scale));
    const auto mins = sog.meta.at("means").at("mins").get<std::array<double, 3>>(),
               maxs = sog.meta.at("means").at("maxs").get<std::array<double, 3>>();
    return packed_gaussians(sog.count, sog.rest > 0, sog.file, progress, [&](SplatSet& out, std::size_t i) {
        glm::vec3 others;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = int(k);
            const int step = byte_at(low.at(i) + k) | byte_at(high.at(i) + k) << 8;
            const double place = mins[k] + (maxs[k] - mins[k]) * step / 65535.0;  // sign(x) ln(1 + |x|)
            out.position[i][axis] = float(std::copysign(real::exp(std::fabs(place)) - 1.0, place));
            out.scale[i][axis] = scale_book[std::size_t(byte_at(sizes.at(i) + k))];
            mean_harmonic(out, i)[axis] = color_book[std::size_t(byte_at(colors.at(i) + k))];
            others[axis] = float((double(byte_at(turns.at(i) + k)) / 127.5 - 1.0) * std::sqrt(0.5));
        }
        out.alpha[i] = fraction_at(colors.at(i) + 3);
        const int largest = byte_at(turns.at(i) + 3) - 252;  // w first; others are no turn
        const glm::vec4 q = largest < 0 ? glm::vec4(1, 0, 0, 0) : quaternion_without(largest, others);
        out.rotation[i] = {q.y, q.z, q.w, q.x};
        if (sog.rest > 0) harmonics.put(sog.rest, i, out.harmonics[i]);
    });
}

/// The result of `use` for the file; wrong types in its JSON are reported in our words.
template <class Use>
auto with_sog(const fs::path& file, const Use& use) {
    return read_mapped(file, [&](std::string_view bytes) {
        try {
            return use(open_sog(file, bytes));
        } catch (const Json::exception& error) {
            bad_input(file, meta_name, "SOG as its specification says", printable(error.what()));
        }
    });
}

}  // namespace

SplatSet read_sog(const fs::path& file, const Progress& progress) {
    return with_sog(file, [&](const SogFile& sog) { return sog_set(sog, progress); });
}

SplatColumns sog_columns(const fs::path& file) {
    return with_sog(file, [](const SogFile& sog) { return gaussian_set_columns(sog.rest > 0); });
}

std::int64_t sog_splat_count(const fs::path& file) {
    return with_sog(file, [](const SogFile& sog) { return sog.count; });
}

}  // namespace astrosplat
