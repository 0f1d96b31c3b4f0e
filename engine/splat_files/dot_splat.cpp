// .splat, as antimatter15's viewer of 2023 takes it: 32 bytes a splat and nothing else. Position and scale as
// floats, colour and opacity as bytes, the quaternion as bytes around 128, w first. Axes as PLY's.
#include <fmt/format.h>

#include "core/error.h"
#include "splat_files/file_bytes.h"
#include "splat_files/formats.h"
#include "splat_files/packed_gaussians.h"
#include "splats/harmonics.h"

namespace astrosplat {
namespace {

constexpr std::size_t splat_bytes = 32;

std::int64_t dot_splat_count_of(const fs::path& file, std::string_view bytes) {
    if (bytes.empty() || bytes.size() % splat_bytes != 0)
        bad_input(file, "size", fmt::format("splats of {} bytes each", splat_bytes),
                  fmt::format("{} bytes", bytes.size()));
    return std::int64_t(bytes.size() / splat_bytes);
}

}  // namespace

SplatSet read_dot_splat(const fs::path& file, const Progress& progress) {
    return read_mapped(file, [&](std::string_view bytes) {
        const std::int64_t count = dot_splat_count_of(file, bytes);
        return packed_gaussians(count, false, file, progress, [&](SplatSet& out, std::size_t i) {
            const char* const p = bytes.data() + i * splat_bytes;
            for (int k = 0; k < 3; ++k) {
                out.position[i][k] = number_at<float>(p + 4 * k);
                out.scale[i][k] = number_at<float>(p + 12 + 4 * k);
                out.color[i][k] = fraction_at(p + 24 + k);
            }
            out.color[i] = mean_coefficient(out.color[i]);
            out.alpha[i] = fraction_at(p + 27);
            for (int k = 0; k < 4; ++k)
                out.rotation[i][(k + 3) % 4] = float(byte_at(p + 28 + k) - 128) / 128.0f;
        });
    });
}

std::int64_t dot_splat_splat_count(const fs::path& file) {
    return read_mapped(file, [&](std::string_view bytes) { return dot_splat_count_of(file, bytes); });
}

SplatColumns dot_splat_columns(const fs::path& file) {
    dot_splat_splat_count(file);
    return gaussian_set_columns(false);
}

}  // namespace astrosplat
