// The splats of a picture, in its own space: texels, x to the right, y up, z towards the viewer, the origin
// in the middle. In: bands and stars; which cells of a lattice have a splat. Out: splats that show the
// picture from the front, but for what hides what (front_fit.h), in order of the cells. The cells are gone
// through first, so that every splat is made where it stays.
#pragma once

#include "bodies/depth_kernel.h"
#include "bodies/picture_light.h"
#include "bodies/placement.h"
#include "bodies/spikes.h"
#include "bodies/stars.h"
#include "core/parallel.h"
#include "splats/shaded_splats.h"

namespace astrosplat {

/// Splats [begin, end) of one size.
struct SplatRange {
    std::int64_t begin = 0, end = 0;
    float sigma = 0.0f;                                     // texels; of stars: of most of them
    enum class Of { bands, detail, stars } of = Of::bands;  // stars: and their spikes
};

struct PictureSplats {
    ShadedSplats splats;             // id: splat_set.h's; the place is a lattice cell
    Buffer<float> distance;          // texels from the middle of the layer
    std::vector<SplatRange> ranges;  // of those that shine
    bool absorbs = false;            // there is dust: splats of colours below 0 (blend.glsl)
};

/// Takes the memory of so many splats at once, which are more than there are.
void reserve_splats(PictureSplats& set, std::int64_t count);

/// Makes room for more splats, whose values are not set.
void resize_splats(PictureSplats& set, std::int64_t count);

/// How a picture's brightness m becomes opacity, 1 - e^-tau = kappa m^p (DEPTH 5).
struct Opacity {
    float power = 0.55f, density = 0.75f;
    /// Optical depth of the column of a pixel.
    float depth_of(float brightest, float alpha) const;
};

/// By which splats of a column of that optical depth shine more, for what lies before them takes away.
float boost_of(float tau);

/// Radius of a splat of the default falloff, in its sigmas; the integral of its footprint over 2 pi sigma^2;
/// and its variance along an axis over sigma^2: both integrals of the Gaussian of sharpness 4.5, cut at 3
/// sigma.
inline constexpr float radius_sigmas = 3.0f;
inline constexpr float footprint_share = 0.9494f;
inline constexpr double footprint_variance = 0.8802;

/// Share of a band's splats that are kept where its light's brightest channel is `amplitude`, and the
/// picture's `brightest`.
float kept_share(float amplitude, float brightest, const BandSplats& splats);

/// The light of a band, of `times` px a texel, where it is `shown`; and where splats are made of it, texels.
struct BandLight {
    const Image& light;
    Region shown, region;
    float times = 1.0f;
};

/// That of all of a picture.
inline BandLight whole_band(const Image& light) {
    const Region all{0, 0, light.width, light.height};
    return {light, all, all};
}

/// Adds a band's splats. `picture` is the whole picture's light, whose brightness decides the opacity.
SplatRange add_band(const BandLight& band, const BandSplats& splats, const Image& picture, const Image& alpha,
                    const Placement& placement, const Opacity& opacity, PictureSplats& out);

/// Adds one splat for each Gaussian of a star, at a depth of the layer's own distribution.
void add_picture_stars(const PictureStars& stars, const Placement& placement, const Opacity& opacity,
                       PictureSplats& out);

/// Adds the light of spikes, and of stars beside their Gaussians: one splat a texel, in a plane at the depth
/// of their star. `places`: of the stars; `part`: 0 or 1, in ids.
void add_spikes(std::span<const SpikeLight> spikes, std::span<const glm::vec2> places, int part, int times,
                const Placement& placement, const Opacity& opacity, PictureSplats& out);

struct LatticeCell {
    std::int64_t column, row;
};

/// Cells of a picture of width x height texels. They are numbered row by row. Those whose splats may lie in a
/// part of it: from `begin` to `end`.
struct SplatLattice {
    std::int64_t columns, rows;
    LatticeCell begin{0, 0}, end;
    SplatLattice(std::int64_t width, std::int64_t height, float spacing)
        : columns(std::int64_t(float(width) / spacing) + 1),
          rows(std::int64_t(float(height) / spacing) + 1),
          end{columns, rows} {}
    SplatLattice(std::int64_t width, std::int64_t height, float spacing, const Region& part)
        : SplatLattice(width, height, spacing) {
        begin = {std::int64_t(float(part.x) / spacing), std::int64_t(float(part.y) / spacing)};
        end = {std::min(columns, std::int64_t(float(part.x + part.width) / spacing) + 1),
               std::min(rows, std::int64_t(float(part.y + part.height) / spacing) + 1)};
    }
    std::uint64_t number(const LatticeCell& cell) const {
        return std::uint64_t(cell.row * columns + cell.column);
    }
};

/// 0..1, spread evenly over neighbours: of any 2^p x 2^q cells (from multiples of these on) one number lies
/// in each 2^-(p + q) of the range, so whatever a body is seen along, its splats are even, and no pattern
/// shows. A digital net (Niederreiter 1987) by Pascal's matrix (Faure 1982), each coordinate scrambled by a
/// nested hash (Owen 1995; Laine and Karras 2011).
float even_number(const LatticeCell& cell, std::uint32_t key);

/// Which cells of some rows have a splat.
struct LatticeRows {
    LatticeCell begin;
    std::int64_t columns = 0;
    std::vector<bool> filled;  // of all cells from `begin` on, `columns` a row
    std::int64_t count = 0;

    /// Calls visit(cells) for those that have, up to DepthBlock::size at once.
    template <class Visit>
    void for_each_block(const Visit& visit) const {
        std::array<LatticeCell, DepthBlock::size> cells;
        std::size_t found = 0;
        std::int64_t left = count;
        for (std::int64_t i = 0; left > 0; ++i) {
            if (!filled[i]) continue;
            cells[found++] = {begin.column + i % columns, begin.row + i / columns};
            if (--left > 0 && found < cells.size()) continue;
            visit(std::span<const LatticeCell>(cells.data(), found));
            found = 0;
        }
    }
};

/// has_splat(cell) of all cells, a few rows at a time.
template <class HasSplat>
std::vector<LatticeRows> find_splats(const SplatLattice& lattice, const HasSplat& has_splat) {
    constexpr std::int64_t rows_at_once = 16;
    const std::int64_t rows = lattice.end.row - lattice.begin.row,
                       columns = lattice.end.column - lattice.begin.column;
    std::vector<LatticeRows> parts(std::size_t((rows + rows_at_once - 1) / rows_at_once));
    parallel_chunks(rows, rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
        LatticeRows part{{lattice.begin.column, lattice.begin.row + begin}, columns, {}, 0};
        part.filled.reserve(std::size_t((end - begin) * columns));
        for (LatticeCell cell = part.begin; cell.row < lattice.begin.row + end; ++cell.row) {
            for (cell.column = lattice.begin.column; cell.column < lattice.end.column; ++cell.column) {
                part.filled.push_back(has_splat(cell));
                part.count += part.filled.back() ? 1 : 0;
            }
        }
        parts[begin / rows_at_once] = std::move(part);
    });
    return parts;
}

/// Appends a splat of that size for every cell of maker.lattice for which maker.candidate_of(cell), an
/// optional, is one. maker.make_splats(cells, first, out) fills in the values of at most DepthBlock::size
/// splats, from row `first` of the arrays on, but for their radii. Both are called on several threads.
template <class Maker>
SplatRange add_on_lattice(const Maker& maker, float sigma, PictureSplats& out) {
    const std::vector<LatticeRows> parts = find_splats(
        maker.lattice, [&](const LatticeCell& cell) { return maker.candidate_of(cell).has_value(); });
    std::vector<std::int64_t> first{out.splats.size()};
    for (const LatticeRows& part : parts) first.push_back(first.back() + part.count);
    resize_splats(out, first.back());
    parallel_each(parts.size(), 1, [&](std::size_t i) {
        auto next = std::size_t(first[i]);
        std::fill_n(out.splats.radius.data() + next, parts[i].count, radius_sigmas * sigma);
        parts[i].for_each_block([&](std::span<const LatticeCell> cells) {
            maker.make_splats(cells, next, out);
            next += cells.size();
        });
    });
    return {first.front(), first.back(), sigma};
}

}  // namespace astrosplat
