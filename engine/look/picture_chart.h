// The pictures of a set as grids of cells about as small as the footprints of its splats, one grid for each
// mesh, and what a footprint is there. In: a set and its look. Out: the grids; no values yet.
#pragma once

#include <cstdint>
#include <vector>

#include "look/kernel.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// What footprints are in one part of a picture.
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
        return static_cast<std::size_t>(band * chart_side + block_at(cell % columns, columns));
    }
};

/// `falloff_variance`: along an axis, square radii. At most as many cells as the set has positions.
PictureChart picture_chart(const LookRun& run, const SplatSet& set, double falloff_variance);

}  // namespace astrosplat
