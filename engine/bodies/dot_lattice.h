// Dots of a lattice's cells, in order of the cells. In: which cells have one, and how these are made. Out:
// dots in the arrays of a picture. The cells are gone through first, so that every dot is made where it
// stays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bodies/depth_kernel.h"
#include "bodies/picture_splats.h"
#include "core/parallel.h"

namespace astrosplat {

struct DotCell {
    std::int64_t column, row;
};

/// Cells of a picture of width x height texels. They are numbered row by row.
struct DotLattice {
    std::int64_t columns, rows;
    DotLattice(std::int64_t width, std::int64_t height, float spacing)
        : columns(static_cast<std::int64_t>(static_cast<float>(width) / spacing) + 1),
          rows(static_cast<std::int64_t>(static_cast<float>(height) / spacing) + 1) {}
    std::uint64_t number(const DotCell& cell) const {
        return static_cast<std::uint64_t>(cell.row * columns + cell.column);
    }
};

/// Appends a dot of that size for every cell for which has_dot(cell) is true. make_dots(cells, first) fills
/// in the values of at most DepthBlock::size dots, from row `first` of the arrays on, but for their radii.
/// Both are called on several threads.
template <class HasDot, class MakeDots>
DotRange add_lattice_dots(const DotLattice& lattice, float sigma, const HasDot& has_dot,
                          const MakeDots& make_dots, PictureSplats& out) {
    constexpr std::int64_t rows_per_chunk = 16;
    constexpr std::size_t cells_per_block = DepthBlock::size;
    const std::int64_t chunks = (lattice.rows + rows_per_chunk - 1) / rows_per_chunk;
    std::vector<std::vector<DotCell>> cells(static_cast<std::size_t>(chunks));
    parallel_chunks(lattice.rows, rows_per_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<DotCell>& found = cells[static_cast<std::size_t>(begin / rows_per_chunk)];
        for (DotCell cell{0, begin}; cell.row < end; ++cell.row)
            for (cell.column = 0; cell.column < lattice.columns; ++cell.column)
                if (has_dot(cell)) found.push_back(cell);
    });
    std::vector<std::int64_t> first{out.splats.size()};
    for (const auto& found : cells) first.push_back(first.back() + static_cast<std::int64_t>(found.size()));
    resize_dots(out, first.back());
    parallel_for(chunks, [&](std::int64_t chunk, int) {
        const std::span<const DotCell> found(cells[static_cast<std::size_t>(chunk)]);
        const auto begin = static_cast<std::size_t>(first[static_cast<std::size_t>(chunk)]);
        for (std::size_t i = 0; i < found.size(); i += cells_per_block)
            make_dots(found.subspan(i, std::min(cells_per_block, found.size() - i)), begin + i);
        std::fill_n(out.splats.radius.data() + begin, found.size(), radius_sigmas * sigma);
    });
    return {first.front(), first.back(), sigma};
}

}  // namespace astrosplat
