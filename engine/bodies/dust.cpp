// Dust lies in a thin sheet, so light of splats before it is not dimmed and what is behind is dimmed more
// than the picture shows: the share before it is measured, cell by cell, from the splats as they were placed.
#include "bodies/dust.h"

#include "bodies/picture_splats.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/shared_maths.h"
#include "image/blur.h"
#include "image/channels.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

using shared::as_log, shared::as_uniform;

// As DEPTH 5 has them, but for the sheet, which is torn, and thinner.
constexpr float least_transmittance = 0.1f;
constexpr float dark_sky = 0.004f;  // added to both sides of the ratio: noise of a dark sky is no dust
// Of H. Thicker, lanes smear into curtains for a camera that comes close.
constexpr float lane_height = 0.2f, lane_thickness = 0.05f;
constexpr double sheet_wave = 26.0;  // texels at a width of 1920, of the clumps in the sheet
constexpr std::int64_t share_cell_px = 8;
constexpr double share_blur_cells = 4.0;
constexpr std::size_t light_parts = 8;  // of the splats, whose light is added up at the same time
constexpr float splat_sigma = 1.3f, splats_each_texel = 0.6f;
constexpr float most_opaque = 0.9f;    // a splat's middle
constexpr float least_kept = 1e-3f;    // share of splats: where fewer would be, there is none
constexpr float dust_force = 1.0f;     // of what is invented of a galaxy's plane
constexpr float certain_depth = 0.1f;  // optical depth from which no splat is left out

// Optical depth of the sheet's middle line, and how far that stands out, bent by waves of its own so that
// edge-on it is torn and not ruled.
void bend(const Placement& placement, DepthBlock& block) {
    // Waves, texels at a width of 1920, and their heights, of H.
    DepthBlock bent = block;
    noise_sum(waves(placement, 3, {{160.0, 0.15}, {70.0, 0.1}, {30.0, 0.04}}), bent);
    for (int i = 0; i < block.count; ++i) {
        const float height = placement.scale_height(block.x[i], block.y[i]);
        block.z[i] += height * (lane_height + bent.z[i]);
    }
}

// A galaxy's dust lies in its disk, a little before the middle of it, or the light of the near half would
// hide every lane of a galaxy that is seen from above.
void place_in_galaxy(const Placement& placement, const GalaxyBody& galaxy, DepthBlock& block) {
    constexpr float before_middle = 0.5f;  // of the thickness of what is small in the disk
    DepthCandidates candidates;
    set_candidates(galaxy, GalaxyPart::dust, dust_force, block, candidates);
    const double wave = sheet_wave * placement.scale;
    line_depths(stack(placement, wave, wave, whole_gain * placement.clumps, 1.0), candidates, block);
    for (int i = 0; i < block.count; ++i) block.z[i] += before_middle * galaxy.thickness * galaxy.cos_i;
}

}  // namespace

void place_dust(const Placement& placement, DepthBlock& block) {
    if (!placement.galaxies.empty()) {
        place_by_galaxy(placement, block, [&](const GalaxyBody& galaxy, DepthBlock& own) {
            place_in_galaxy(placement, galaxy, own);
        });
        return;
    }
    for (int i = 0; i < block.count; ++i) {
        block.height[i] = lane_thickness * placement.scale_height(block.x[i], block.y[i]);
        block.clumping[i] = 1.0f;
    }
    const double wave = sheet_wave * placement.scale;
    disk_depths(stack(placement, wave, wave, whole_gain * placement.clumps, 1.0), block);
    bend(placement, block);
}

namespace {

constexpr int depths_a_cell = 8;

// Some depths of the dust in each cell of share_cell_px.
Image dust_depths(const Placement& placement) {
    Image depths =
        unfilled_image((placement.picture_width + share_cell_px - 1) / share_cell_px,
                       (placement.picture_height + share_cell_px - 1) / share_cell_px, depths_a_cell);
    constexpr std::int64_t cells_at_once = DepthBlock::size / depths_a_cell;
    parallel_chunks(
        depths.width * depths.height, cells_at_once, [&](std::int64_t begin, std::int64_t end, int) {
            DepthBlock block;
            for (std::int64_t cell = begin; cell < end; ++cell)
                for (int k = 0; k < depths_a_cell; ++k) {
                    block.x[block.count] = (float(cell % depths.width) + 0.5f) * float(share_cell_px);
                    block.y[block.count] = (float(cell / depths.width) + 0.5f) * float(share_cell_px);
                    block.even[block.count] = (float(k) + 0.5f) / float(depths_a_cell);
                    block.random[block.count++] =
                        placement.hash_of(std::uint64_t(cell) << 8 | std::uint64_t(k), shared::PURPOSE_SHEET);
                }
            place_dust(placement, block);
            std::copy_n(block.z, block.count, depths.pixels.data() + begin * depths_a_cell);
        });
    return depths;
}

// Channel 0: light before the dust, 1: all light, of cells of share_cell_px, blurred.
Image light_before(const Placement& placement, const PictureSplats& set) {
    const Image sheet = dust_depths(placement);
    const Image none = make_image(sheet.width, sheet.height, 2);
    std::vector<Image> parts(light_parts, none);
    const float middle_x = 0.5f * float(placement.picture_width),
                middle_y = 0.5f * float(placement.picture_height);
    const auto add = [&](std::size_t i, Image& cells) {
        const glm::vec3 p = set.splats.position[i], color = set.splats.color[i];
        const float x = p.x + middle_x, y = middle_y - p.y, radius = set.splats.radius[i];
        const float light = std::max({color.x, color.y, color.z}) * set.splats.alpha[i] * radius * radius;
        const auto cell_along = [](float at, std::int64_t count) {
            return std::clamp<std::int64_t>(std::int64_t(at) / share_cell_px, 0, count - 1);
        };
        const std::int64_t column = cell_along(x, cells.width), row = cell_along(y, cells.height);
        float* const cell = cells.at(column, row);
        cell[1] += light;
        if (p.z - middle_plane(placement, x, y) > sheet.at(column, row)[i % depths_a_cell]) cell[0] += light;
    };
    const std::size_t count = set.splats.position.size();
    parallel_each(parts.size(), 1, [&](std::size_t part) {
        for (std::size_t i = part * count / light_parts; i < (part + 1) * count / light_parts; ++i)
            add(i, parts[part]);
    });
    for (std::size_t part = 1; part < light_parts; ++part)
        std::ranges::transform(parts[0].pixels, parts[part].pixels, parts[0].pixels.begin(), std::plus());
    return gaussian_blur(parts[0], share_blur_cells);
}

// Share of the splats that are kept.
float kept_dust(float depth) {
    const float kept = std::min(1.0f, depth / certain_depth);
    return kept > least_kept ? kept : 0.0f;
}

// Optical depth of a sheet that leaves `transmittance` of all light, with a share of it before the sheet.
float sheet_depth(float transmittance, float before) {
    const float behind = (transmittance - before) / std::max(1e-6f, 1.0f - before);
    return -as_log(std::clamp(behind, least_transmittance, 1.0f));
}

struct DustMaker {
    const Image& transmittance;
    const Image& before;
    float amount;
    glm::vec3 exponents;
    const Placement& placement;

    static constexpr float footprint = footprint_share * 6.28318531f * splat_sigma * splat_sigma;
    static_assert(dust_spacing * dust_spacing * splats_each_texel > 0.999f &&
                  dust_spacing * dust_spacing * splats_each_texel < 1.001f);
    SplatLattice lattice{transmittance.width, transmittance.height, dust_spacing};

    // Of the sheet at a place, that dims what lies behind it so that the whole is dimmed as it is seen.
    float depth_at(float x, float y) const {
        const float t = bilinear(transmittance, 0, x, y);
        const float cell_x = x / float(share_cell_px), cell_y = y / float(share_cell_px);
        const float f =
            bilinear(before, 0, cell_x, cell_y) / std::max(1e-20f, bilinear(before, 1, cell_x, cell_y));
        return sheet_depth(t, f);
    }

    struct Candidate {
        float x, y;   // texels from the top left corner
        float alpha;  // of the splat's middle
        std::uint64_t id;
    };

    // A cell's splat, where there is dust and it is not thinned out.
    std::optional<Candidate> candidate_of(const LatticeCell& cell) const {
        Candidate splat;
        splat.id = dust_band << band_bit | lattice.number(cell);
        splat.x = (float(cell.column) + random(splat.id, shared::PURPOSE_JITTER_X)) * dust_spacing;
        splat.y = (float(cell.row) + random(splat.id, shared::PURPOSE_JITTER_Y)) * dust_spacing;
        if (splat.x >= float(transmittance.width) || splat.y >= float(transmittance.height)) return {};
        const float depth = amount * depth_at(splat.x, splat.y), kept = kept_dust(depth);
        if (!(kept > 0.0f) || random(splat.id, shared::PURPOSE_DENSITY) >= kept) return {};
        // The optical depth of a splat of Gaussian s is 2 pi sigma^2 Li2(s), of which s + s^2 / 4 is enough.
        const float share = depth / kept / (splats_each_texel * footprint);
        splat.alpha = std::min(most_opaque, 2.0f * (std::sqrt(1.0f + share) - 1.0f));
        return splat;
    }

    float random(std::uint64_t id, std::uint32_t purpose) const {
        return as_uniform(placement.hash_of(id, purpose));
    }

    void make_splats(std::span<const LatticeCell> cells, std::size_t first, PictureSplats& out) const {
        const std::uint32_t even_key = placement.hash_of(dust_band << band_bit, shared::PURPOSE_EVEN);
        DepthBlock block;
        block.count = int(cells.size());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Candidate splat = *candidate_of(cells[i]);
            block.x[i] = splat.x;
            block.y[i] = splat.y;
            block.random[i] = placement.hash_of(splat.id, shared::PURPOSE_DEPTH);
            block.even[i] = even_number(cells[i], even_key);
            out.splats.alpha[first + i] = splat.alpha;
            out.splats.color[first + i] = -exponents;
            out.splats.id[first + i] = splat.id;
        }
        place_dust(placement, block);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const float z = block.z[i] + middle_plane(placement, block.x[i], block.y[i]);
            out.splats.position[first + i] = placement.among_splats(block.x[i], block.y[i], z);
            out.distance[first + i] = std::fabs(block.z[i]);
        }
    }
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

float expected_dust_splats(float transmittance, double amount) {
    constexpr float usual_before = 0.37f;  // .29 to .455 were measured
    return splats_each_texel * kept_dust(float(amount) * sheet_depth(transmittance, usual_before));
}

namespace {

// The far half and the sides of a galaxy that is seen from its edge, which no picture shows, have the dust of
// the near side (INCLINED 4): what lies within 60 degrees of the direction to it, turned about the normal.
void turn_dust(const GalaxyBody& galaxy, const Placement& placement, std::int64_t begin, PictureSplats& out) {
    constexpr double turns_deg[] = {120.0, 240.0};
    constexpr float along_near = 0.5f;  // cosine of 60 degrees: a third of the ring
    const std::int64_t end = out.splats.size();
    std::vector<std::int64_t> near;
    const auto in_disk = [&](std::int64_t i) {
        const glm::vec3 p = out.splats.position[i];
        return galaxy.in_disk(p.x + 0.5f * float(placement.picture_width),
                              0.5f * float(placement.picture_height) - p.y, p.z);
    };
    for (std::int64_t i = begin; i < end; ++i) {
        const glm::vec3 p = in_disk(i);
        const bool nearer = p.y > along_near * std::sqrt(p.x * p.x + p.y * p.y);
        if (nearer && as_uniform(placement.hash_of(out.splats.id[i], shared::PURPOSE_SHEET)) < galaxy.hidden)
            near.push_back(i);
    }
    const auto count = std::ssize(near);
    resize_splats(out, end + 2 * count);
    parallel_each(2 * count, 4096, [&](std::int64_t k) {
        const std::int64_t from = near[k % count], to = end + k;
        const double turn = real::radians(turns_deg[k / count]);
        const auto c = float(real::cos(turn)), s = float(real::sin(turn));
        const glm::vec3 p = in_disk(from), q = galaxy.in_picture({c * p.x - s * p.y, s * p.x + c * p.y, p.z});
        out.splats.position[to] = placement.among_splats(q.x, q.y, q.z);
        out.splats.color[to] = out.splats.color[from];
        out.splats.alpha[to] = out.splats.alpha[from];
        out.splats.radius[to] = out.splats.radius[from];
        out.splats.id[to] = out.splats.id[from] | std::uint64_t(1 + k / count) << size_bit;
        out.distance[to] = out.distance[from];
    });
}

}  // namespace

void add_dust(const Image& transmittance, double amount, const glm::vec3& exponents,
              const Placement& placement, PictureSplats& out) {
    const Image before = light_before(placement, out);
    const std::int64_t begin =
        add_on_lattice(DustMaker{transmittance, before, float(amount), exponents, placement}, splat_sigma,
                       out)
            .begin;
    if (placement.galaxies.size() == 1 && placement.galaxies.front().hidden > 0.0f)
        turn_dust(placement.galaxies.front(), placement, begin, out);
    out.absorbs = true;
}

}  // namespace astrosplat
