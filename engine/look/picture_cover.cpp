#include "look/picture_cover.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr double piled_up = 5.0;       // times what chance adds to the positions of a cell
constexpr double never_piled = 2.0;    // positions
constexpr double sampled_below = 0.5;  // covered less than this, the set is a sample

struct BlockSums {
    double due = 0.0, unclamped = 0.0, positions = 0.0, cells = 0.0;

    void add(const BlockSums& s) {
        due += s.due, unclamped += s.unclamped, positions += s.positions, cells += s.cells;
    }
};

// Calls body(cell, block) for the cells of a band of blocks, row after row.
template <class Body>
void each_of_band(const PictureChart& chart, std::int64_t band, const Body& body) {
    const std::int64_t mesh = band / chart_side, rows = chart.rows;
    const std::int64_t begin = PictureChart::block_begin(band % chart_side, rows);
    const std::int64_t end = PictureChart::block_begin(band % chart_side + 1, rows);
    for (std::int64_t y = mesh * rows + begin; y < mesh * rows + end; ++y)
        for (std::int64_t x = 0; x < chart.columns; ++x)
            body(static_cast<std::size_t>(y * chart.columns + x),
                 static_cast<std::size_t>(band * chart_side + PictureChart::block_at(x, chart.columns)));
}

// 1 where a cell or one of the eight about it has positions.
CellValues filled(const PictureChart& chart, const CellValues& positions) {
    CellValues result(positions.size(), 0.0f);
    const std::int64_t columns = chart.columns, rows = chart.rows;
    parallel_each(chart.meshes * rows, 16, [&](std::int64_t y) {
        const std::int64_t mesh = y / rows;
        const std::int64_t y0 = std::max(mesh * rows, y - 1), y1 = std::min((mesh + 1) * rows - 1, y + 1);
        for (std::int64_t x = 0; x < columns; ++x) {
            float sum = 0.0f;
            for (std::int64_t ny = y0; ny <= y1; ++ny)
                for (std::int64_t nx = std::max<std::int64_t>(0, x - 1); nx <= std::min(columns - 1, x + 1);
                     ++nx)
                    sum += positions[static_cast<std::size_t>(ny * columns + nx)];
            result[static_cast<std::size_t>(y * columns + x)] = sum > 0.0f ? 1.0f : 0.0f;
        }
    });
    return result;
}

// Of each block and its neighbours.
std::vector<BlockSums> sums_around(const PictureChart& chart, const PictureCells& cells,
                                   const CellValues& inside) {
    std::vector<BlockSums> own(chart.blocks.size()), around(chart.blocks.size());
    parallel_for(chart.meshes * chart_side, [&](std::int64_t band, int) {
        each_of_band(chart, band, [&](std::size_t cell, std::size_t block) {
            own[block].positions += static_cast<double>(cells.positions[cell]);
            own[block].cells += static_cast<double>(inside[cell]);
        });
    });
    for (std::size_t b = 0; b < own.size(); ++b)
        own[b].due = cells.cover[b].due, own[b].unclamped = cells.cover[b].unclamped;
    for (std::int64_t b = 0; b < static_cast<std::int64_t>(own.size()); ++b) {
        const std::int64_t mesh = b / (chart_side * chart_side), row = b / chart_side % chart_side,
                           column = b % chart_side;
        for (std::int64_t y = std::max<std::int64_t>(0, row - 1); y <= std::min(chart_side - 1, row + 1); ++y)
            for (std::int64_t x = std::max<std::int64_t>(0, column - 1);
                 x <= std::min(chart_side - 1, column + 1); ++x)
                around[static_cast<std::size_t>(b)].add(
                    own[static_cast<std::size_t>((mesh * chart_side + y) * chart_side + x)]);
    }
    return around;
}

// A picture's black positions are not in the set, so less than once is once.
float covered(const BlockSums& s) {
    if (!(s.unclamped > 0.0) || !(s.cells > 0.0)) return 1.0f;
    const double estimate = s.due / s.unclamped * (s.positions / s.cells);
    return static_cast<float>(estimate < sampled_below ? estimate
                                                       : std::max(1.0, std::floor(estimate + 0.5)));
}

void empty_cell(PictureCells& cells, std::size_t i) {
    for (std::size_t c = 0; c < picture_channels; ++c) cells.depth[c][i] = cells.wanted[c][i] = 0.0f;
    cells.squares[i] = cells.positions[i] = 0.0f;
    if (!cells.plain.empty()) cells.plain[i] = cells.varied[i] = 0.0f;
}

}  // namespace

PictureCover cover_once(const PictureChart& chart, PictureCells& cells, double positions_due) {
    PictureCover cover{filled(chart, cells.positions), std::vector<float>(chart.blocks.size())};
    const std::vector<BlockSums> around = sums_around(chart, cells, cover.inside);
    for (std::size_t b = 0; b < around.size(); ++b)
        cover.whole[b] = static_cast<float>(positions_due * chart.blocks[b].cell_area) * covered(around[b]);
    parallel_for(chart.meshes * chart_side, [&](std::int64_t band, int) {
        each_of_band(chart, band, [&](std::size_t i, std::size_t block) {
            const BlockSums& s = around[block];
            const double mean = s.cells > 0.0 ? s.positions / s.cells : 0.0;
            if (static_cast<double>(cells.positions[i]) > mean + piled_up * std::sqrt(mean) + never_piled) {
                empty_cell(cells, i);
                cover.inside[i] = 0.0f;
            }
            const float less = 1.0f / covered(s);
            if (less == 1.0f) return;
            for (std::size_t c = 0; c < picture_channels; ++c) cells.depth[c][i] *= less;
            cells.squares[i] *= less * less;
        });
    });
    return cover;
}

}  // namespace astrosplat
