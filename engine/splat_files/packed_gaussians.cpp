#include "splat_files/packed_gaussians.h"

#include <fmt/format.h>
#include <zlib.h>

#include "core/error.h"
#include "core/log.h"
#include "core/text.h"

namespace astrosplat {

glm::vec4 quaternion_without(int largest, const glm::vec3& others) {
    glm::vec4 q(0.0f);
    double squares = 0.0;
    for (int k = 0, from = 0; k < 4; ++k) {
        if (k == largest) continue;
        q[k] = others[from++];
        squares += double(q[k]) * double(q[k]);
    }
    q[largest] = float(std::sqrt(std::max(0.0, 1.0 - squares)));
    return q;
}

std::size_t inflate_to(std::string_view& from, std::span<char> to, int window_bits) {
    constexpr std::size_t portion = std::size_t{1} << 30;  // zlib counts in 32 bits
    z_stream stream{};
    if (inflateInit2(&stream, window_bits) != Z_OK) throw std::bad_alloc();
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
    std::size_t written = 0;
    for (int result = Z_OK; result == Z_OK && written < to.size();) {
        const std::size_t in = std::min(portion, from.size()), out = std::min(portion, to.size() - written);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(from.data()));  // zlib reads it only
        stream.avail_in = static_cast<uInt>(in);
        stream.next_out = reinterpret_cast<Bytef*>(to.data() + written);
        stream.avail_out = static_cast<uInt>(out);
        result = inflate(&stream, Z_NO_FLUSH);
        from.remove_prefix(in - stream.avail_in);
        written += out - stream.avail_out;
    }
    return written;
}

void warn_of_rest(const fs::path& file, std::size_t bytes) {
    if (bytes > 0)
        log_warning(fmt::format("{}: {} after its splats are left out", file.string(),
                                counted(std::int64_t(bytes), "byte")));
}

std::int64_t demand_plausible_count(const fs::path& file, std::string_view place, std::uint64_t count,
                                    std::size_t bytes) {
    constexpr std::uint64_t most_from_a_byte = 1032, least_position = 6, any_file = 2'000'000;
    const std::uint64_t size = bytes, most = std::min(size * most_from_a_byte / least_position,
                                                      std::max(any_file, 2 * size));
    if (count > most)
        bad_input(file, place, fmt::format("at most {} splats in {} bytes", most, bytes),
                  std::to_string(count));
    return std::int64_t(count);
}

}  // namespace astrosplat
