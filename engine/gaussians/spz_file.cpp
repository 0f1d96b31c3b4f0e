// SPZ, version 4, of the precision and the compression that its own library takes by default.
#include <zstd.h>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "gaussians/gaussian_file.h"
#include "splat_files/spz_numbers.h"

namespace astrosplat {
namespace {

using SpzStreams = std::array<Buffer<char>, spz::streams>;
constexpr std::int64_t packed_at_once = 1 << 14;
constexpr int most_fixed = (1 << 23) - 1;  // 24 bits with the sign

/// 12, as its own library has it: a four thousandth of a scene unit. Fewer where the scene is too large for
/// that, more where it is smaller than 1.
int fraction_bits(const Gaussians& g) {
    float most = 0.0f;
    for (const glm::vec3& p : g.position)
        most = std::max({most, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    int exponent = 0;
    std::frexp(most, &exponent);  // most < 2^exponent
    return std::clamp(exponent > 0 ? std::min(12, 23 - exponent) : 12 - exponent, 0, 23);
}

char* put_code(char* out, double value) {
    *out = static_cast<char>(static_cast<unsigned char>(std::clamp(std::floor(value + 0.5), 0.0, 255.0)));
    return out + 1;
}

std::uint32_t packed_rotation(glm::vec4 q) {
    int largest = 0;
    for (int k = 1; k < 4; ++k)
        if (std::fabs(q[k]) > std::fabs(q[largest])) largest = k;
    if (q[largest] < 0.0f) q = -q;
    auto bits = std::uint32_t(largest);
    for (int k = 0; k < 4; ++k) {
        if (k == largest) continue;
        const double size = std::fabs(double(q[k])) / std::sqrt(0.5) * spz::quaternion_steps + 0.5;
        bits = bits << 10 | (q[k] < 0.0f ? 512u : 0u) |
               std::min(std::uint32_t(size), std::uint32_t(spz::quaternion_steps));
    }
    return bits;
}

/// Of five bits (degree 1) or four, as its own library rounds by default.
char* put_harmonic(char* out, float value, int degree) {
    const int step = degree == 1 ? 8 : 16;
    const auto code = int(std::floor(std::clamp(double(value), -2.0, 2.0) * 128.0 + 0.5)) + 128 + step / 2;
    return put_code(out, std::max(code, 0) / step * step);
}

/// Of the faintest at random, by its number: bodies are made of many that no step of 255 shows alone, and
/// rounded to the nearest one all of them would go out, or shine twice as much.
double alpha_code(float alpha, std::size_t i) {
    constexpr double faintest = 4.0;  // from here on as many are rounded up as down
    const double code = 255.0 * double(alpha);
    if (code >= faintest) return code;
    return code - 0.5 + double(shared::as_uniform(shared::as_hash_of_id(0u, i, shared::PURPOSE_ROUNDING)));
}

void pack_row(const Gaussians& g, int bits, SpzStreams& streams, std::size_t i) {
    auto& [positions, alphas, colors, scales, rotations, harmonics] = streams;
    const glm::vec4 q = g.rotation[i];
    const std::uint32_t rotation = packed_rotation({q.x, -q.y, -q.z, q.w});
    for (std::size_t k = 0; k < 4; ++k) rotations[4 * i + k] = char(rotation >> 8 * k & 255u);
    put_code(&alphas[i], alpha_code(g.alpha[i], i));
    const glm::vec3 mean = g.degree > 0 ? g.harmonics[i].c[0] : mean_coefficient(g.color[i]);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = int(k);
        const double place = std::ldexp(double(axis == 0 ? g.position[i].x : -g.position[i][axis]), bits);
        const auto fixed =
            std::int32_t(std::clamp(std::floor(place + 0.5), -double(most_fixed), double(most_fixed)));
        for (std::size_t b = 0; b < 3; ++b)
            positions[9 * i + 3 * k + b] = char(std::uint32_t(fixed) >> 8 * b & 255u);
        put_code(&colors[3 * i + k], 255.0 * (double(mean[axis]) * spz::color_scale + 0.5));
        const double log_scale = real::log(std::max(double(g.scale[i][axis]), 1e-30));
        put_code(&scales[3 * i + k], (log_scale - spz::log_scale_least) * spz::log_scale_steps);
    }
    const std::size_t rest = g.harmonics_each() - 1;
    char* out = harmonics.data() + 3 * rest * i;
    for (std::size_t j = 0; j < rest; ++j)
        for (int k = 0; k < 3; ++k)
            out = put_harmonic(out, spz::harmonic_signs[j] * g.harmonics[i].c[j + 1][k], j < 3 ? 1 : 2);
}

void compress(Buffer<char>& bytes) {
    constexpr int level = 12;  // its own library's
    Buffer<char> packed(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
    if (ZSTD_isError(size)) throw std::bad_alloc();  // its only reason with so much room
    packed.resize(size);
    bytes = std::move(packed);
}

template <class Number>
void append(std::string& bytes, Number value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_gaussian_spz(const WriteTarget& target, const Gaussians& gaussians, const Progress& progress) {
    const auto count = std::size_t(gaussians.size());
    if (count > std::numeric_limits<std::uint32_t>::max())
        bad_input(target.file, "at most 4294967295 splats (see --count)", std::to_string(count));
    const std::array<std::size_t, spz::streams> row_bytes = {9, 1, 3,
                                                             3, 4, 3 * (gaussians.harmonics_each() - 1)};
    SpzStreams streams;
    std::size_t all = 0;
    for (const std::size_t bytes : row_bytes) all += bytes * count;
    claim_memory(std::int64_t(2 * all), "writing " + target.file.string());
    for (std::size_t i = 0; i < streams.size(); ++i) streams[i].resize(row_bytes[i] * count);
    const int bits = fraction_bits(gaussians);
    parallel_each(count, packed_at_once, [&](std::size_t i) { pack_row(gaussians, bits, streams, i); });
    const std::size_t kinds = gaussians.degree > 0 ? streams.size() : streams.size() - 1;
    parallel_parts(kinds, progress, [&](std::size_t i) { compress(streams[i]); });
    std::string header(spz::magic);
    append(header, std::uint32_t{4});  // its version
    append(header, std::uint32_t(count));
    for (const std::size_t byte : {std::size_t(gaussians.degree), std::size_t(bits), std::size_t{0}, kinds})
        header += char(byte);
    append(header, std::uint32_t(spz::header_bytes));
    header.resize(spz::header_bytes, '\0');
    for (std::size_t i = 0; i < kinds; ++i) {
        append(header, std::uint64_t(streams[i].size()));
        append(header, std::uint64_t(row_bytes[i] * count));
    }
    AtomicFile file(target.file, target.existing);
    file.write(header);
    for (std::size_t i = 0; i < kinds; ++i) file.write(streams[i].data(), streams[i].size());
    progress.check();
    file.commit();
}

}  // namespace astrosplat
