// match = "picture": a front view shows the light of the picture, whichever of its positions became splats
// and however wide they are. A set's pictures are grids of cells about as small as its splats' footprints,
// one grid for each mesh. In: a set, and its look by the arithmetic of one splat (look.glsl), for a splat's
// chances rather than its fate. Out: grids, sums over the positions of a cell, values blurred by the
// footprints, neither beyond a picture's edges nor into another mesh's; in the end factors of alpha and
// colour for each splat that is kept.
#pragma once

#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "look/kernel.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct OneSplat {
    bool keep = false;
    float probability = 0.0f;  // of being kept
    glm::vec3 color{0.0f};
    float alpha = 0.0f, radius = 0.0f;
};

/// Under `uniforms`, which need not be the run's own.
OneSplat look_at(const LookRun& run, const PreparedLook& uniforms, std::int64_t i);

/// Footprints in one part of a picture.
struct ChartBlock {
    double sigma_u = 0.0, sigma_v = 0.0;  // cells; standard deviations of a footprint along u and v
    double cell_area = 0.0;               // square scene units of surface under a cell, > 0
};

/// Blocks along u, and along v, of each picture.
inline constexpr std::int64_t chart_side = 32;

struct PictureChart {
    std::int64_t meshes = 0;             // 0: there is no picture, because u and v say no place on the meshes
    std::int64_t columns = 0, rows = 0;  // cells along u, and along v
    std::vector<ChartBlock> blocks;      // mesh after mesh, row after row

    std::int64_t cells() const { return meshes * columns * rows; }
    std::int64_t cell_of(const SplatSet& set, std::int64_t i) const;
    /// Whether a position lies on a picture's very edge, as all do that are beyond a mesh that ends there.
    static bool on_edge(const SplatSet& set, std::int64_t i);

    /// Of a row or column `at` of a grid of `size`; and the first row or column of a block.
    static std::int64_t block_at(std::int64_t at, std::int64_t size) { return at * chart_side / size; }
    static std::int64_t block_begin(std::int64_t block, std::int64_t size) {
        return (block * size + chart_side - 1) / chart_side;
    }
    std::size_t block_of_cell(std::int64_t cell) const {
        const std::int64_t row = cell / columns, band = row / rows * chart_side + block_at(row % rows, rows);
        return std::size_t(band * chart_side + block_at(cell % columns, columns));
    }
};

/// `falloff_variance`: along an axis, square radii. At most as many cells as the set has positions.
PictureChart picture_chart(const LookRun& run, const SplatSet& set, double falloff_variance);

/// A float for each cell of a chart.
using CellValues = Buffer<float>;

class ChartBlur {
  public:
    /// A footprint's weights on the cells about its own, which sum to 1; `squared`: the squares of these.
    ChartBlur(const PictureChart& chart, bool squared);

    /// The same bits with any number of threads and on any instruction set.
    void operator()(CellValues& values);

  private:
    using Taps = std::vector<float>;  // an odd number, the middle one of the cell itself

    template <class Shifted>
    void blur_row(std::int64_t y, const std::vector<Taps>& taps, const Shifted& shifted, float* to) const;
    void along_rows(const CellValues& from, CellValues& to) const;
    void along_columns(const CellValues& from, CellValues& to) const;

    const PictureChart& chart_;
    std::vector<Taps> taps_u_, taps_v_;  // of each block
    std::int64_t reach_ = 0;             // cells, of the widest footprint
    CellValues between_;                 // rows are done, columns not yet
};

/// Opacity, and light in red, green and blue.
inline constexpr std::size_t picture_channels = 4;
using ChannelValues = std::array<CellValues, picture_channels>;

/// In place of a cell: not a splat; one beyond an edge of the picture, whose light is no cell's.
inline constexpr std::uint32_t no_cell = 0xffffffffu, beyond_cells = 0xfffffffeu;

/// Sums over the positions of a block.
struct CoverSums {
    double due = 0.0;  // the column's mean of optical depth that each stands for, of a depth of 1, in cells
    double unclamped = 0.0;  // how many there are in `due`; the others are as opaque as can be
};

/// Sums over the positions of each cell, or where it says so over those of them that became splats.
struct PictureCells {
    ChannelValues depth;   // of splats: alpha * color (of opacity: 1) * the area of the footprint in cells
    CellValues squares;    // of splats: the square of that of opacity
    ChannelValues wanted;  // what a front view shows where all is of the position's colour and alpha
    CellValues positions;  // how many there are
    /// Expected depth as the look's noise and crops leave it, and without them. Empty where it has none.
    CellValues varied, plain;
    std::vector<CoverSums> cover;        // of each block
    std::vector<std::uint32_t> cell_of;  // of each position, or one of the two above
};

/// Memory that a chart's sums take, bytes.
std::int64_t picture_cells_bytes(const PictureChart& chart, std::int64_t positions);

/// The same bits with any number of threads.
PictureCells picture_cells(const LookRun& run, const SplatSet& set, const PictureChart& chart,
                           double falloff_integral);

/// The layer's falloff as seen from afar.
struct FalloffMoments {
    double integral = 1.0;  // over the unit disc
    double variance = 0.1;  // along an axis, square radii
};

struct PictureFactors {
    std::vector<std::uint32_t>
        cell_of;            // of each splat that shade_run keeps, in order of the set, or beyond_cells
    ChannelValues of_cell;  // of alpha, and of alpha * color
};

/// picture_chart, picture_cells and picture_fit. Empty for a set without u and v. Reads the set before its
/// arrays are written over. The same bits with any number of threads. Throws InputError for want of memory.
PictureFactors picture_factors(const LookRun& run, const SplatSet& set, const FalloffMoments& falloff);

/// Multiplies; alphas end at 1.
void apply_factors(const PictureFactors& factors, ShadedSplats& shaded);

}  // namespace astrosplat
