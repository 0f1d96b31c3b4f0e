// Dust lies in a thin sheet, so light of dots before it is not dimmed and what is behind is dimmed more than
// the picture shows: the share before it is measured, cell by cell, from the dots as they were placed.
#include "bodies/dust.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bodies/picture_splats.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/blur.h"
#include "image/channels.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

using shared::as_hash, shared::as_log, shared::as_uniform;

// As DEPTH 5 has them, but for the sheet, which is torn, and thinner.
constexpr float least_transmittance = 0.1f;
constexpr float dark_sky = 0.004f;  // added to both sides of the ratio: noise of a dark sky is no dust
// Of H. Thicker, lanes smear into curtains for a camera that comes close.
constexpr float lane_height = 0.2f, lane_thickness = 0.05f;
constexpr double sheet_wave = 26.0;  // texels at a width of 1920, of the clumps in the sheet
constexpr std::int64_t share_cell_px = 8;
constexpr double share_blur_cells = 4.0;
constexpr std::size_t light_parts = 8;  // of the dots, whose light is added up at the same time
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
        block.z[i] += height * (lane_height + waves.z[i]);
    }
}

// Channel 0: light before the sheet, 1: all light, of cells of share_cell_px, blurred.
Image light_before(const Placement& placement, const PictureSplats& dots) {
    const Image none = make_image((placement.picture_width + share_cell_px - 1) / share_cell_px,
                                  (placement.picture_height + share_cell_px - 1) / share_cell_px, 2);
    std::vector<Image> parts(light_parts, none);
    const float middle_x = 0.5f * static_cast<float>(placement.picture_width),
                middle_y = 0.5f * static_cast<float>(placement.picture_height);
    const auto add = [&](std::size_t i, Image& cells) {
        const glm::vec3 p = dots.splats.position[i], color = dots.splats.color[i];
        const float x = p.x + middle_x, y = middle_y - p.y, radius = dots.splats.radius[i];
        const float light = std::max({color.x, color.y, color.z}) * dots.splats.alpha[i] * radius * radius;
        const auto column =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(x) / share_cell_px, 0, cells.width - 1);
        const auto row =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(y) / share_cell_px, 0, cells.height - 1);
        float* const cell = cells.at(column, row);
        cell[1] += light;
        if (p.z - middle_plane(placement, x, y) > lane_height * placement.scale_height(x, y))
            cell[0] += light;
    };
    const std::size_t count = dots.splats.position.size();
    parallel_each(parts.size(), 1, [&](std::size_t part) {
        for (std::size_t i = part * count / light_parts; i < (part + 1) * count / light_parts; ++i)
            add(i, parts[part]);
    });
    for (std::size_t part = 1; part < light_parts; ++part)
        std::ranges::transform(parts[0].pixels, parts[part].pixels, parts[0].pixels.begin(), std::plus());
    return gaussian_blur(parts[0], share_blur_cells);
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

class DustDots {
  public:
    DustDots(const Image& transmittance, const Image& before, double amount, const glm::vec3& exponents,
             const Placement& placement)
        : transmittance_(transmittance),
          before_(before),
          amount_(static_cast<float>(amount)),
          exponents_(exponents),
          placement_(placement),
          lattice_(transmittance.width, transmittance.height, spacing) {}

    void add_to(PictureSplats& out) const {
        add_lattice_dots(
            lattice_, dot_sigma, [&](const DotCell& cell) { return candidate_of(cell).has_value(); },
            [&](std::span<const DotCell> cells, std::size_t first) { make_dots(cells, first, out); }, out);
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

    struct Candidate {
        float x, y;   // texels from the top left corner
        float alpha;  // of the dot's middle
        std::uint64_t id;
    };

    // A cell's dot, where there is dust and it is not thinned out.
    std::optional<Candidate> candidate_of(const DotCell& cell) const {
        Candidate dot;
        dot.id = dust_band << 48 | lattice_.number(cell);
        dot.x = (static_cast<float>(cell.column) + random(dot.id, shared::PURPOSE_JITTER_X)) * spacing;
        dot.y = (static_cast<float>(cell.row) + random(dot.id, shared::PURPOSE_JITTER_Y)) * spacing;
        if (dot.x >= static_cast<float>(transmittance_.width) ||
            dot.y >= static_cast<float>(transmittance_.height))
            return {};
        const float depth = amount_ * depth_at(dot.x, dot.y), kept = kept_dust(depth);
        if (!(kept > 0.0f) || random(dot.id, shared::PURPOSE_DENSITY) >= kept) return {};
        // The optical depth of a dot of Gaussian s is 2 pi sigma^2 Li2(s), of which s + s^2 / 4 is enough.
        const float share = depth / kept / (dots_each_texel * footprint);
        dot.alpha = std::min(0.9f, 2.0f * (std::sqrt(1.0f + share) - 1.0f));
        return dot;
    }

    std::uint32_t hash_of(std::uint64_t id, std::uint32_t purpose) const {
        return as_hash(placement_.seed, static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32),
                       purpose);
    }

    float random(std::uint64_t id, std::uint32_t purpose) const { return as_uniform(hash_of(id, purpose)); }

    void make_dots(std::span<const DotCell> cells, std::size_t first, PictureSplats& out) const {
        DepthBlock block;
        block.count = static_cast<int>(cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Candidate dot = *candidate_of(cells[i]);
            block.x[i] = dot.x;
            block.y[i] = dot.y;
            block.height[i] = lane_thickness * placement_.scale_height(dot.x, dot.y);
            block.clumping[i] = 1.0f;
            block.random[i] = hash_of(dot.id, shared::PURPOSE_DEPTH);
            out.splats.alpha[first + i] = dot.alpha;
            out.splats.color[first + i] = -exponents_;
            out.splats.id[first + i] = dot.id;
        }
        NoiseStack noise;
        noise.seed = placement_.seed;
        noise.count = 1;
        noise.frequency[0] = static_cast<float>(1.0 / (sheet_wave * placement_.scale));
        noise.gain[0] = static_cast<float>(1.6 * placement_.clumps);
        disk_depths(noise, block);
        bend(placement_, block);
        const float middle_x = 0.5f * static_cast<float>(transmittance_.width);
        const float middle_y = 0.5f * static_cast<float>(transmittance_.height);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const float z = block.z[i] + middle_plane(placement_, block.x[i], block.y[i]);
            out.splats.position[first + i] = {block.x[i] - middle_x, middle_y - block.y[i], z};
            out.distance[first + i] = std::fabs(block.z[i]);
        }
    }

    const Image& transmittance_;
    const Image& before_;
    float amount_;
    glm::vec3 exponents_;
    const Placement& placement_;
    DotLattice lattice_;
};

}  // namespace

glm::vec3 dust_exponents_of(const Image& light) {
    constexpr float least = 1e-3f, share = 0.02f;  // that a channel differs where there is colour
    for (std::size_t i = 0; i + 2 < light.pixels.size(); i += 3) {
        const auto [low, high] = std::minmax({light.pixels[i], light.pixels[i + 1], light.pixels[i + 2]});
        if (high - low > std::max(least, share * high)) return dust_exponents;
    }
    return glm::vec3(1.0f);
}

Image transmittance_of(const Image& brightest, const Image& emission, const Image& alpha) {
    Image ratio = unfilled_image(brightest.width, brightest.height, 1);
    const Image whole = brightest_channel(emission);
    parallel_each(ratio.pixels.size(), 65536, [&](std::size_t i) {
        ratio.pixels[i] = std::clamp((brightest.pixels[i] + dark_sky) / (whole.pixels[i] + dark_sky),
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

void add_dust(const Image& transmittance, double amount, const glm::vec3& exponents,
              const Placement& placement, PictureSplats& out) {
    const Image before = light_before(placement, out);
    DustDots(transmittance, before, amount, exponents, placement).add_to(out);
    out.absorbs = true;
}

}  // namespace astrosplat
