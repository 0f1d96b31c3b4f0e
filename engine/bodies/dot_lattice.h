// Dots of a lattice's cells, in order of the cells. In: which cells have one, and how these are made. Out:
// dots in the arrays of a picture. The cells are gone through first, so that every dot is made where it
// stays.
#pragma once

#include <algorithm>
#include <array>
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

/// Which cells of some rows have a dot.
struct DotRows {
    std::int64_t begin = 0, columns = 0;
    std::vector<bool> dots;  // of all cells from row `begin` on
    std::int64_t count = 0;

    /// Calls visit(cells) for those that have, up to DepthBlock::size at once.
    template <class Visit>
    void for_each_block(const Visit& visit) const {
        std::array<DotCell, DepthBlock::size> cells;
        std::size_t found = 0;
        std::int64_t left = count;
        for (std::int64_t i = 0; left > 0; ++i) {
            if (!dots[static_cast<std::size_t>(i)]) continue;
            cells[found++] = {i % columns, begin + i / columns};
            if (--left > 0 && found < cells.size()) continue;
            visit(std::span<const DotCell>(cells.data(), found));
            found = 0;
        }
    }
};

/// has_dot(cell) of all cells, a few rows at a time.
template <class HasDot>
std::vector<DotRows> find_dots(const DotLattice& lattice, const HasDot& has_dot) {
    constexpr std::int64_t rows_at_once = 16;
    std::vector<DotRows> parts(static_cast<std::size_t>((lattice.rows + rows_at_once - 1) / rows_at_once));
    parallel_chunks(lattice.rows, rows_at_once, [&](std::int64_t begin, std::int64_t end, int) {
        DotRows part{begin, lattice.columns, {}, 0};
        part.dots.reserve(static_cast<std::size_t>((end - begin) * lattice.columns));
        for (DotCell cell{0, begin}; cell.row < end; ++cell.row) {
            for (cell.column = 0; cell.column < lattice.columns; ++cell.column) {
                part.dots.push_back(has_dot(cell));
                part.count += part.dots.back() ? 1 : 0;
            }
        }
        parts[static_cast<std::size_t>(begin / rows_at_once)] = std::move(part);
    });
    return parts;
}

/// Appends a dot of that size for every cell for which has_dot(cell) is true. make_dots(cells, first) fills
/// in the values of at most DepthBlock::size dots, from row `first` of the arrays on, but for their radii.
/// Both are called on several threads.
template <class HasDot, class MakeDots>
DotRange add_lattice_dots(const DotLattice& lattice, float sigma, const HasDot& has_dot,
                          const MakeDots& make_dots, PictureSplats& out) {
    const std::vector<DotRows> parts = find_dots(lattice, has_dot);
    std::vector<std::int64_t> first{out.splats.size()};
    for (const DotRows& part : parts) first.push_back(first.back() + part.count);
    resize_dots(out, first.back());
    parallel_each(parts.size(), 1, [&](std::size_t i) {
        auto next = static_cast<std::size_t>(first[i]);
        std::fill_n(out.splats.radius.data() + next, parts[i].count, radius_sigmas * sigma);
        parts[i].for_each_block([&](std::span<const DotCell> cells) {
            make_dots(cells, next);
            next += cells.size();
        });
    });
    return {first.front(), first.back(), sigma};
}

}  // namespace astrosplat
