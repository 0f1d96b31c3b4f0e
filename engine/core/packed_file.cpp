#include "core/packed_file.h"

#include <bzlib.h>
#include <fmt/format.h>
#include <zlib.h>

#include "core/error.h"
#include "core/file.h"
#include "core/memory.h"

namespace astrosplat {
namespace {

// Both libraries' streams have the same members.
struct Gzip {
    using Stream = z_stream;
    static constexpr std::string_view name = "gzip", magic = "\x1f\x8b";
    static constexpr int any = 15 + 16;  // the largest window, and gzip's own header
    static constexpr int good = Z_OK, ended = Z_STREAM_END;
    static bool begin(Stream& stream) { return inflateInit2(&stream, any) == Z_OK; }
    static int step(Stream& stream) { return inflate(&stream, Z_NO_FLUSH); }
    static int end(Stream* stream) { return inflateEnd(stream); }
};

struct Bzip2 {
    using Stream = bz_stream;
    static constexpr std::string_view name = "bzip2", magic = "BZh";
    static constexpr int good = BZ_OK, ended = BZ_STREAM_END;
    static bool begin(Stream& stream) { return BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK; }
    static int step(Stream& stream) { return BZ2_bzDecompress(&stream); }
    static int end(Stream* stream) { return BZ2_bzDecompressEnd(stream); }
};

constexpr std::size_t least_block = std::size_t{1} << 22, largest_block = std::size_t{1} << 28;
constexpr std::size_t free_bytes = std::size_t{1} << 26;

template <class Codec>
std::string unpack(std::string_view packed, const std::string& name, const Progress& progress,
                   const UnpackBounds& bounds) {
    const auto [most_times, enough] = bounds;
    const std::size_t packed_size = packed.size(), most = std::max(free_bytes, most_times * packed_size);
    std::string text;
    std::size_t size = 0;
    while (packed.starts_with(Codec::magic) && size < enough) {
        typename Codec::Stream stream{};
        if (!Codec::begin(stream)) throw std::bad_alloc();
        const std::unique_ptr<typename Codec::Stream, int (*)(typename Codec::Stream*)> open(&stream,
                                                                                             Codec::end);
        for (int result = Codec::good; result != Codec::ended && size < enough;) {
            if (size == text.size()) {
                progress.check();
                if (size > most)
                    bad_input(name, fmt::format("at most {} times its {} bytes", most_times, packed_size),
                              fmt::format("more that {} packed", Codec::name));
                const std::size_t more = std::clamp(size, least_block, largest_block);
                claim_memory(std::int64_t(size + more), fmt::format("reading {}", name));
                text.resize(size + more);
            }
            const auto given = static_cast<unsigned>(std::min(packed.size(), largest_block));
            const auto room = static_cast<unsigned>(text.size() - size);
            stream.next_in = reinterpret_cast<decltype(stream.next_in)>(
                const_cast<char*>(packed.data()));  // which is only read
            stream.avail_in = given;
            stream.next_out = reinterpret_cast<decltype(stream.next_out)>(text.data() + size);
            stream.avail_out = room;
            result = Codec::step(stream);
            packed.remove_prefix(given - stream.avail_in);
            size += room - stream.avail_out;
            const bool stuck = given == stream.avail_in && room == stream.avail_out;
            if (result != Codec::ended && (result != Codec::good || stuck))
                bad_input(name, fmt::format("a whole {} file", Codec::name), "damaged data");
        }
    }
    text.resize(size);
    return text;
}

}  // namespace

bool is_packed(std::string_view bytes) {
    return bytes.starts_with(Gzip::magic) || bytes.starts_with(Bzip2::magic);
}

std::string unpacked(std::string bytes, const std::string& name, const Progress& progress,
                     const UnpackBounds& bounds) {
    if (bytes.starts_with(Gzip::magic)) return unpack<Gzip>(bytes, name, progress, bounds);
    if (bytes.starts_with(Bzip2::magic)) return unpack<Bzip2>(bytes, name, progress, bounds);
    return bytes;
}

std::string read_unpacked(const fs::path& file, const Progress& progress, const UnpackBounds& bounds) {
    return unpacked(read_file(file, progress), file.string(), progress, bounds);
}

}  // namespace astrosplat
