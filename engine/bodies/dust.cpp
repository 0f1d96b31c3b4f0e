// Dust lies in a thin sheet, so light of dots before it is not dimmed and what is behind is dimmed more than
// the picture shows: the share before it is measured, cell by cell, from the dots as they were placed.
#include "bodies/dust.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/blur.h"
#include "image/channels.h"
#include "splats/star_id.h"

namespace astrosplat {
namespace {

using shared::as_hash, shared::as_log, shared::as_uniform;

constexpr float least_transmittance = 0.1f;
constexpr float dark_sky = 0.004f;  // added to both sides of the ratio: noise of dark dark_sky is no dust
// Of H. Thicker, lanes smear into curtains for a camera that comes close.
constexpr float sheet_height = 0.2f, sheet_thickness = 0.05f;
constexpr double sheet_wave = 26.0;  // texels at a width of 1920, of the clumps in the sheet
constexpr std::int64_t share_cell_px = 8;
constexpr double share_blur_cells = 4.0;
constexpr float dot_sigma = 1.3f, dots_each_texel = 0.6f;
constexpr float certain_depth = 0.1f;  // optical depth from which no dot is left out

// Optical depth of the sheet's middle line, and how far that stands out, bent by waves of its own so that
// edge-on it is torn and not ruled.
void bend(const Placement& placement, DepthBlock& block) {
    DepthBlock waves = block;
    NoiseStack noise;
    noise.seed = shared::as_mix(placement.seed + 3);
    for (const auto& [wave, gain] : {std::pair{160.0, 0.15f}, {70.0, 0.1f}, {30.0, 0.04f}}) {
        noise.frequency[noise.count] = static_cast<float>(1.0 / (wave * placement.scale));
        noise.gain[noise.count++] = gain;
    }
    noise_sum(noise, waves);
    for (int i = 0; i < block.count; ++i) {
        const float height = placement.scale_height(block.x[i], block.y[i]);
        block.z[i] += height * (sheet_height + waves.z[i]);
    }
}

// Channel 0: light before the sheet, 1: all light, of cells of share_cell_px, blurred.
Image light_before(const Placement& placement, const PictureSplats& dots) {
    Image cells = make_image((placement.picture_width + share_cell_px - 1) / share_cell_px,
                             (placement.picture_height + share_cell_px - 1) / share_cell_px, 2);
    const float middle_x = 0.5f * static_cast<float>(placement.picture_width),
                middle_y = 0.5f * static_cast<float>(placement.picture_height);
    for (std::size_t i = 0; i < static_cast<std::size_t>(dots.splats.size()); ++i) {
        const glm::vec3 p = dots.splats.position[i], color = dots.splats.color[i];
        const float x = p.x + middle_x, y = middle_y - p.y, radius = dots.splats.radius[i];
        const float light = std::max({color.x, color.y, color.z}) * dots.splats.alpha[i] * radius * radius;
        const auto column =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(x) / share_cell_px, 0, cells.width - 1);
        const auto row =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(y) / share_cell_px, 0, cells.height - 1);
        float* const cell = cells.at(column, row);
        cell[1] += light;
        if (p.z - middle_plane(placement, x, y) > sheet_height * placement.scale_height(x, y))
            cell[0] += light;
    }
    return gaussian_blur(cells, share_blur_cells);
}

// Share of the dots that are kept.
float kept_dust(float depth) {
    const float kept = std::min(1.0f, depth / certain_depth);
    return kept > 1e-3f ? kept : 0.0f;
}

// Optical depth of a sheet that leaves `transmittance` of all light, with a share of it before the sheet.
float sheet_depth(float transmittance, float before) {
    const float behind = (transmittance - before) / std::max(1e-6f, 1.0f - before);
    return -as_log(std::clamp(behind, least_transmittance, 1.0f));
}

class DustRow {
  public:
    DustRow(const Image& transmittance, const Image& before, double amount, const Placement& placement)
        : transmittance_(transmittance),
          before_(before),
          amount_(static_cast<float>(amount)),
          placement_(placement) {}

    void add_cell(std::int64_t column, std::int64_t row, std::uint64_t id, ChunkDots& out) {
        const auto low = static_cast<std::uint32_t>(id), high = static_cast<std::uint32_t>(id >> 32);
        const auto random = [&](std::uint32_t purpose) {
            return as_uniform(as_hash(placement_.seed, low, high, purpose));
        };
        const float x = (static_cast<float>(column) + random(shared::PURPOSE_JITTER_X)) * spacing;
        const float y = (static_cast<float>(row) + random(shared::PURPOSE_JITTER_Y)) * spacing;
        if (x >= static_cast<float>(transmittance_.width) || y >= static_cast<float>(transmittance_.height))
            return;
        const float depth = amount_ * depth_at(x, y), kept = kept_dust(depth);
        if (!(kept > 0.0f) || random(shared::PURPOSE_DENSITY) >= kept) return;
        // The optical depth of a dot of Gaussian s is 2 pi sigma^2 Li2(s), of which s + s^2 / 4 is enough.
        const float share = depth / kept / (dots_each_texel * footprint);
        const float s = std::min(0.9f, 2.0f * (std::sqrt(1.0f + share) - 1.0f));
        push(x, y, as_hash(placement_.seed, low, high, shared::PURPOSE_DEPTH), out);
        out.alpha.push_back(s);
        out.color.push_back(-dust_exponents);
        out.id.push_back(id);
    }

    void flush(ChunkDots& out) {
        if (block_.count == 0) return;
        NoiseStack noise;
        noise.seed = placement_.seed;
        noise.count = 1;
        noise.frequency[0] = static_cast<float>(1.0 / (sheet_wave * placement_.scale));
        noise.gain[0] = static_cast<float>(1.6 * placement_.clumps);
        disk_depths(noise, block_);
        bend(placement_, block_);
        const float middle_x = 0.5f * static_cast<float>(transmittance_.width);
        const float middle_y = 0.5f * static_cast<float>(transmittance_.height);
        for (int i = 0; i < block_.count; ++i) {
            const float z = block_.z[i] + middle_plane(placement_, block_.x[i], block_.y[i]);
            out.position.emplace_back(block_.x[i] - middle_x, middle_y - block_.y[i], z);
            out.distance.push_back(std::fabs(block_.z[i]));
        }
        block_.count = 0;
    }

    static constexpr float footprint = footprint_share * 6.28318531f * dot_sigma * dot_sigma;
    static constexpr float spacing = 1.29099445f;  // of dots_each_texel
    static_assert(spacing * spacing * dots_each_texel > 0.999f &&
                  spacing * spacing * dots_each_texel < 1.001f);

  private:
    // Of the sheet at a place, that dims what lies behind it so that the whole is dimmed as it is seen.
    float depth_at(float x, float y) const {
        const float t = bilinear(transmittance_, 0, x, y);
        const float cell_x = x / static_cast<float>(share_cell_px),
                    cell_y = y / static_cast<float>(share_cell_px);
        const float f =
            bilinear(before_, 0, cell_x, cell_y) / std::max(1e-20f, bilinear(before_, 1, cell_x, cell_y));
        return sheet_depth(t, f);
    }

    void push(float x, float y, std::uint32_t random, ChunkDots& out) {
        if (block_.count == DepthBlock::size) flush(out);
        block_.x[block_.count] = x;
        block_.y[block_.count] = y;
        block_.height[block_.count] = sheet_thickness * placement_.scale_height(x, y);
        block_.clumping[block_.count] = 1.0f;
        block_.random[block_.count++] = random;
    }

    const Image& transmittance_;
    const Image& before_;
    float amount_;
    const Placement& placement_;
    DepthBlock block_{};
};

}  // namespace

Image transmittance_of(const Image& brightest, const Image& emission, const Image& alpha) {
    Image ratio = brightest;
    const Image whole = brightest_channel(emission);
    parallel_each(ratio.pixels.size(), 65536, [&](std::size_t i) {
        ratio.pixels[i] = std::clamp((ratio.pixels[i] + dark_sky) / (whole.pixels[i] + dark_sky),
                                     least_transmittance, 1.0f);
    });
    parallel_each(alpha.pixels.size(), 65536, [&](std::size_t i) {
        ratio.pixels[i] = 1.0f - (1.0f - ratio.pixels[i]) * alpha.pixels[i];
    });
    return ratio;
}

double dust_of(const StructureParams& params) {
    constexpr double dust_of_disks = 0.8;  // all of it makes lanes edge-on that are deeper than real ones
    return params.dust ? *params.dust : params.kind == StructureKind::disk ? dust_of_disks : 0.0;
}

float expected_dust_dots(float transmittance, double amount) {
    constexpr float usual_before = 0.37f;  // .29 to .455 were measured
    return dots_each_texel * kept_dust(static_cast<float>(amount) * sheet_depth(transmittance, usual_before));
}

void add_dust(const Image& transmittance, double amount, const Placement& placement, PictureSplats& out) {
    constexpr std::int64_t rows_per_chunk = 16;
    const Image before = light_before(placement, out);
    const auto columns =
        static_cast<std::int64_t>(static_cast<float>(transmittance.width) / DustRow::spacing) + 1;
    const auto rows =
        static_cast<std::int64_t>(static_cast<float>(transmittance.height) / DustRow::spacing) + 1;
    std::vector<ChunkDots> chunks(static_cast<std::size_t>((rows + rows_per_chunk - 1) / rows_per_chunk));
    parallel_chunks(rows, rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        DustRow dust(transmittance, before, amount, placement);
        ChunkDots& chunk = chunks[static_cast<std::size_t>(begin / rows_per_chunk)];
        for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t column = 0; column < columns; ++column)
                dust.add_cell(column, row,
                              dust_band << 48 | static_cast<std::uint64_t>(row * columns + column), chunk);
        dust.flush(chunk);
    });
    append_dots(chunks, dot_sigma, out);
    out.absorbs = true;
}

}  // namespace astrosplat
