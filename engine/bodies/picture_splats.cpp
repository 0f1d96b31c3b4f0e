#include "bodies/picture_splats.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/channels.h"
#include "splats/star_id.h"

namespace astrosplat {
namespace {

using shared::as_exp, shared::as_hash, shared::as_log, shared::as_pow, shared::as_uniform;

constexpr float cell_jitter = 0.5f;         // of the lattice's spacing
constexpr float least_brightness = 0.002f;  // below which opacity falls to 0: empty sky hides nothing
constexpr float greatest_opacity = 0.985f;
constexpr float star_opacity = 0.25f;      // of a star's own
constexpr float glowing_thickness = 0.7f;  // of H, from which the light of a disk is that of its bulge
constexpr float clearest_bulge = 16.0f;    // times; clearer still, it would burn out where it is seen aslant
constexpr float glow_hiding = 0.5f;        // share of its optical depth that the glow between two walls keeps

// What a dot is before it has a depth.
struct Candidate {
    glm::vec3 light;      // of its footprint
    float amplitude;      // the brightest of it
    float brightest;      // of the picture there
    float opacity_limit;  // the picture's alpha
    float hiding;         // share of the column's optical depth
    std::uint64_t id;
};

// Share of the optical depth that dots keep. A bulge, old stars without dust, glows: seen from the side,
// light comes from all of its depth, not from a surface as a cloud's would. So does what is between two
// walls: were it a fog, the fit would raise the filaments of the back wall by what is lost in it, and from
// behind they would burn out.
float hiding_of(const BandDots& dots, const Placement& placement, float thickness) {
    if (placement.kind == StructureKind::disk) {
        const float bulge = thickness / glowing_thickness;
        return 1.0f / std::clamp(bulge * bulge * bulge * bulge, 1.0f, clearest_bulge);
    }
    return dots.glow ? glow_hiding : 1.0f;
}

// The optical depth a dot adds to its column is its share of the column's light.
void shade(const Candidate& dot, float footprint, const Opacity& opacity, ChunkDots& out) {
    const float brightest = std::max(least_brightness, dot.brightest);
    const float tau = dot.hiding * opacity.depth_of(dot.brightest, dot.opacity_limit);
    const float alpha = std::clamp(tau * (dot.amplitude / brightest) / footprint, 1e-6f, 1.0f);
    const float boost = tau > 1e-4f ? tau / (1.0f - as_exp(-tau)) : 1.0f;  // what lies before it takes away
    out.alpha.push_back(alpha);
    out.color.push_back(dot.light * (boost / (alpha * footprint)));
    out.id.push_back(dot.id);
}

class BandChunk {
  public:
    BandChunk(const Image& band, const BandDots& dots, const Image& brightest, const Image& alpha,
              const Placement& placement, const Opacity& opacity)
        : band_(band),
          dots_(dots),
          brightest_(brightest),
          alpha_(alpha),
          placement_(placement),
          opacity_(opacity) {
        footprint_ = footprint_share * static_cast<float>(2.0 * real::pi) * dots.sigma * dots.sigma;
        block_.count = 0;
    }

    // A cell's dot, where there is light and it is not thinned out.
    void add_cell(std::int64_t column, std::int64_t row, std::uint64_t id) {
        const auto low = static_cast<std::uint32_t>(id), high = static_cast<std::uint32_t>(id >> 32);
        const auto random = [&](std::uint32_t purpose) {
            return as_uniform(as_hash(placement_.seed, low, high, purpose));
        };
        const auto place_in = [&](std::int64_t cell, std::uint32_t purpose) {
            return (static_cast<float>(cell) + 0.5f + cell_jitter * (random(purpose) - 0.5f)) * dots_.spacing;
        };
        const float x = place_in(column, shared::PURPOSE_JITTER_X),
                    y = place_in(row, shared::PURPOSE_JITTER_Y);
        if (x >= static_cast<float>(band_.width) || y >= static_cast<float>(band_.height)) return;
        const float thickness = placement_.thickness_at(x, y);
        if (thickness < dots_.thickness_from || thickness >= dots_.thickness_to) return;
        Candidate dot;
        dot.light = {bilinear(band_, 0, x, y), bilinear(band_, 1, x, y), bilinear(band_, 2, x, y)};
        dot.amplitude = std::max({dot.light.x, dot.light.y, dot.light.z});
        if (dot.amplitude <= 0.0f) return;
        dot.opacity_limit = alpha_.pixels.empty() ? 1.0f : bilinear(alpha_, 0, x, y);
        if (dot.opacity_limit <= 0.0f) return;
        dot.brightest = bilinear(brightest_, 0, x, y);
        const float kept = kept_share(dot.amplitude, dot.brightest, dots_);
        if (random(shared::PURPOSE_DENSITY) >= kept) return;
        const float gain = dots_.spacing * dots_.spacing / kept;
        dot.light *= gain;
        dot.amplitude *= gain;
        dot.hiding = hiding_of(dots_, placement_, thickness);
        dot.id = id;
        push(dot, x, y, as_hash(placement_.seed, low, high, shared::PURPOSE_DEPTH));
    }

    // The dots so far, all placed.
    ChunkDots finish() {
        flush();
        return std::move(out_);
    }

  private:
    void push(const Candidate& dot, float x, float y, std::uint32_t random) {
        if (block_.count == DepthBlock::size) flush();
        block_.x[block_.count] = x;
        block_.y[block_.count] = y;
        block_.random[block_.count++] = random;
        shade(dot, footprint_, opacity_, out_);
    }

    void flush() {
        if (block_.count == 0) return;
        place(placement_, dots_, block_);
        const float middle_x = 0.5f * static_cast<float>(band_.width);
        const float middle_y = 0.5f * static_cast<float>(band_.height);
        for (int i = 0; i < block_.count; ++i) {
            out_.position.emplace_back(block_.x[i] - middle_x, middle_y - block_.y[i], block_.z[i]);
            out_.distance.push_back(block_.distance[i]);
        }
        block_.count = 0;
    }

    const Image& band_;
    const BandDots& dots_;
    const Image& brightest_;
    const Image& alpha_;
    const Placement& placement_;
    const Opacity& opacity_;
    float footprint_ = 0.0f;
    PlacedBlock block_;
    ChunkDots out_;
};

template <class T>
void append(const std::vector<T>& from, std::int64_t at, Buffer<T>& to) {
    std::copy(from.begin(), from.end(), to.begin() + at);
}

void resize(PictureSplats& set, std::int64_t count) {
    const auto size = static_cast<std::size_t>(count);
    set.splats.position.resize(size);
    set.splats.color.resize(size);
    set.splats.alpha.resize(size);
    set.splats.radius.resize(size);
    set.splats.id.resize(size);
    set.distance.resize(size);
}

}  // namespace

void append_dots(const std::vector<ChunkDots>& chunks, float sigma, PictureSplats& out) {
    std::vector<std::int64_t> first{out.splats.size()};
    for (const ChunkDots& chunk : chunks)
        first.push_back(first.back() + static_cast<std::int64_t>(chunk.id.size()));
    resize(out, first.back());
    parallel_for(static_cast<std::int64_t>(chunks.size()), [&](std::int64_t i, int) {
        const ChunkDots& chunk = chunks[static_cast<std::size_t>(i)];
        const std::int64_t at = first[static_cast<std::size_t>(i)];
        append(chunk.position, at, out.splats.position);
        append(chunk.color, at, out.splats.color);
        append(chunk.alpha, at, out.splats.alpha);
        append(chunk.id, at, out.splats.id);
        append(chunk.distance, at, out.distance);
        std::fill_n(out.splats.radius.begin() + at, chunk.id.size(), radius_sigmas * sigma);
    });
}

float kept_share(float amplitude, float brightest, const BandDots& dots) {
    return std::min(1.0f, amplitude / (dots.threshold * (brightest + 0.03f)));
}

float Opacity::depth_of(float brightest, float alpha) const {
    float hidden = std::min(greatest_opacity, density * as_pow(std::max(least_brightness, brightest), power));
    if (brightest < least_brightness) hidden *= brightest / least_brightness;
    return -as_log(1.0f - std::min(hidden, alpha));
}

void add_band(const Image& band, const BandDots& dots, const Image& brightest, const Image& alpha,
              const Placement& placement, const Opacity& opacity, PictureSplats& out) {
    constexpr std::int64_t rows_per_chunk = 16;
    const auto columns = static_cast<std::int64_t>(static_cast<float>(band.width) / dots.spacing) + 1;
    const auto rows = static_cast<std::int64_t>(static_cast<float>(band.height) / dots.spacing) + 1;
    std::vector<ChunkDots> chunks(static_cast<std::size_t>((rows + rows_per_chunk - 1) / rows_per_chunk));
    parallel_chunks(rows, rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        BandChunk chunk(band, dots, brightest, alpha, placement, opacity);
        const std::uint64_t first =
            static_cast<std::uint64_t>(dots.index) << 48 | static_cast<std::uint64_t>(dots.size) << 40;
        for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t column = 0; column < columns; ++column)
                chunk.add_cell(column, row, first + static_cast<std::uint64_t>(row * columns + column));
        chunks[static_cast<std::size_t>(begin / rows_per_chunk)] = chunk.finish();
    });
    const std::int64_t first_dot = out.splats.size();
    append_dots(chunks, dots.sigma, out);
    out.ranges.push_back({first_dot, out.splats.size(), dots.sigma});
}

void add_stars(const std::vector<Star>& stars, const Placement& placement, const Opacity& opacity,
               PictureSplats& out) {
    const std::int64_t begin = out.splats.size();
    resize(out, begin + static_cast<std::int64_t>(stars.size()));
    const float middle_x = 0.5f * static_cast<float>(placement.picture_width),
                middle_y = 0.5f * static_cast<float>(placement.picture_height);
    double sigmas = 0.0;
    for (std::size_t i = 0; i < stars.size(); ++i) {
        const Star& star = stars[i];
        const std::size_t at = static_cast<std::size_t>(begin) + i;
        const auto low = static_cast<std::uint32_t>(i);
        const float u = as_uniform(
            as_hash(placement.seed, low, static_cast<std::uint32_t>(star_band), shared::PURPOSE_DEPTH));
        const float inside = std::clamp(u, 1e-5f, 1.0f - 1e-5f);
        const float spread =
            placement.kind == StructureKind::disk
                ? 0.5f * placement.scale_height(star.x, star.y) * as_log(inside / (1.0f - inside))
                : (2.0f * u - 1.0f) * static_cast<float>(placement.depth);
        const float peak = std::max({star.peak.x, star.peak.y, star.peak.z, 1e-6f});
        const float alpha =
            std::clamp(star_opacity * opacity.depth_of(peak, 1.0f) / footprint_share, 1e-3f, 1.0f);
        out.splats.position[at] = {star.x - middle_x, middle_y - star.y,
                                   spread + middle_plane(placement, star.x, star.y)};
        out.splats.color[at] = star.peak / alpha;
        out.splats.alpha[at] = alpha;
        out.splats.radius[at] = radius_sigmas * star.sigma;
        out.splats.id[at] = star_band << 48 | low;
        out.distance[at] = std::fabs(spread);
        sigmas += static_cast<double>(star.sigma);
    }
    if (!stars.empty())
        out.ranges.push_back(
            {begin, out.splats.size(), static_cast<float>(sigmas / static_cast<double>(stars.size()))});
}

}  // namespace astrosplat
