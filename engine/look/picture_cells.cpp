// Each row of blocks is summed by one thread, which takes the positions in the set's order. A set is in the
// order of its lattice, so a chunk of it lies in few rows and the others pass it by.

#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "look/picture_fit.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

constexpr double cut_at = 3.0;  // sigma

std::vector<float> gaussian_taps(double sigma, bool squared) {
    const auto reach = std::int64_t(std::ceil(cut_at * sigma - 1e-9));
    std::vector<double> weights;
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        const double t = reach > 0 ? double(k) / sigma : 0.0;
        weights.push_back(real::exp(-0.5 * t * t));
        sum += weights.back();
    }
    std::vector<float> taps;
    for (const double w : weights) taps.push_back(float(squared ? w / sum * (w / sum) : w / sum));
    return taps;
}

std::int64_t reach_of(const std::vector<float>& taps) { return std::int64_t(taps.size() / 2); }

}  // namespace

ChartBlur::ChartBlur(const PictureChart& chart, bool squared) : chart_(chart) {
    for (const ChartBlock& block : chart.blocks) {
        taps_u_.push_back(gaussian_taps(block.sigma_u, squared));
        taps_v_.push_back(gaussian_taps(block.sigma_v, squared));
        reach_ = std::max({reach_, reach_of(taps_u_.back()), reach_of(taps_v_.back())});
    }
    between_.resize(std::size_t(chart.cells()));
}

void ChartBlur::operator()(CellValues& values) {
    along_rows(values, between_);
    along_columns(between_, values);
}

// One row of cells, block by block. `shifted(k)`: the values k cells away, along it or across.
template <class Shifted>
void ChartBlur::blur_row(std::int64_t y, const std::vector<Taps>& taps, const Shifted& shifted,
                         float* to) const {
    const std::int64_t columns = chart_.columns, rows = chart_.rows;
    const std::int64_t first = (y / rows * chart_side + PictureChart::block_at(y % rows, rows)) * chart_side;
    std::vector<const float*> from;
    for (std::int64_t b = 0; b < chart_side; ++b) {
        const std::int64_t x = PictureChart::block_begin(b, columns), reach = reach_of(taps[first + b]);
        from.clear();
        for (std::int64_t k = -reach; k <= reach; ++k) from.push_back(shifted(k) + x);
        weighted_rows(taps[first + b], from, PictureChart::block_begin(b + 1, columns) - x, to + x);
    }
}

void ChartBlur::along_rows(const CellValues& from, CellValues& to) const {
    const std::int64_t columns = chart_.columns;
    parallel_chunks(chart_.meshes * chart_.rows, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<float> padded(columns + 2 * reach_);
        for (std::int64_t y = begin; y < end; ++y) {
            std::copy_n(from.data() + y * columns, columns, padded.begin() + reach_);
            blur_row(
                y, taps_u_, [&](std::int64_t k) { return padded.data() + reach_ + k; },
                to.data() + y * columns);
        }
    });
}

void ChartBlur::along_columns(const CellValues& from, CellValues& to) const {
    const std::int64_t columns = chart_.columns, rows = chart_.rows;
    const std::vector<float> nothing(columns);
    parallel_each(chart_.meshes * rows, 16, [&](std::int64_t y) {
        const auto row_at = [&](std::int64_t k) {
            const bool on_mesh = y % rows + k >= 0 && y % rows + k < rows;
            return on_mesh ? from.data() + (y + k) * columns : nothing.data();
        };
        blur_row(y, taps_v_, row_at, to.data() + y * columns);
    });
}

namespace {

constexpr std::int64_t cells_chunk = 1 << 12;  // positions

// The look without what varies it from place to place.
PreparedLook unvaried(const PreparedLook& uniforms) {
    PreparedLook plain = uniforms;
    plain.noise_count = plain.crop_count = 0;
    plain.outlines.clear();
    return plain;
}

bool varies(const PreparedLook& u) {
    const auto has_effect = [](const shared_types::LookNoise& n) {
        return n.cull != 0.0f || n.silhouette != 0.0f || n.alpha != 0.0f;
    };
    return u.is_cropped() || std::any_of(u.noises, u.noises + u.noise_count, has_effect);
}

struct CellRange {
    std::int64_t least = 0, most = -1;
};

struct CellSums {
    const LookRun& run;
    const SplatSet& set;
    const PictureChart& chart;
    double falloff_integral;
    PreparedLook plain = unvaried(run.uniforms);
    bool varied = varies(run.uniforms);
    PictureCells cells = {};
    std::vector<CellRange> ranges = {};  // of chunks

    PictureCells sums() {
        const auto zero = [&](CellValues& values) { values.assign(std::size_t(chart.cells()), 0.0f); };
        for (std::size_t c = 0; c < picture_channels; ++c) zero(cells.depth[c]), zero(cells.wanted[c]);
        zero(cells.squares), zero(cells.positions);
        if (varied) zero(cells.varied), zero(cells.plain);
        cells.cover.resize(chart.blocks.size());
        cells.cell_of.resize(std::size_t(set.size()));
        find_ranges();
        parallel_for(chart.meshes * chart_side, [&](std::int64_t band, int) { sum_rows(band); });
        return std::move(cells);
    }

    void find_ranges() {
        const std::int64_t count = set.size();
        ranges.resize(std::size_t((count + cells_chunk - 1) / cells_chunk));
        parallel_chunks(count, cells_chunk, [&](std::int64_t begin, std::int64_t end, int) {
            CellRange range{chart.cells(), -1};
            for (std::int64_t i = begin; i < end; ++i) {
                const std::int64_t cell = chart.cell_of(set, i);
                range.least = std::min(range.least, cell), range.most = std::max(range.most, cell);
            }
            ranges[begin / cells_chunk] = range;
        });
    }

    // A band is a row of blocks of one mesh.
    void sum_rows(std::int64_t band) {
        const std::int64_t mesh = band / chart_side, block_row = band % chart_side, columns = chart.columns;
        const std::int64_t first =
            (mesh * chart.rows + PictureChart::block_begin(block_row, chart.rows)) * columns;
        const std::int64_t end =
            (mesh * chart.rows + PictureChart::block_begin(block_row + 1, chart.rows)) * columns;
        for (std::size_t chunk = 0; chunk < ranges.size(); ++chunk) {
            if (ranges[chunk].most < first || ranges[chunk].least >= end) continue;
            const std::int64_t begin = std::int64_t(chunk) * cells_chunk;
            for (std::int64_t i = begin; i < std::min(begin + cells_chunk, set.size()); ++i) {
                const std::int64_t cell = chart.cell_of(set, i);
                if (cell < first || cell >= end) continue;
                const std::int64_t block =
                    band * chart_side + PictureChart::block_at(cell % columns, columns);
                add(i, std::size_t(cell), std::size_t(block));
            }
        }
    }

    void add(std::int64_t i, std::size_t cell, std::size_t block) {
        const PreparedLook& u = run.uniforms;
        const OneSplat look = look_at(run, u, i);
        const bool beyond = PictureChart::on_edge(set, i);
        const std::uint32_t kept_in = beyond ? beyond_cells : std::uint32_t(cell);
        cells.cell_of[i] = look.keep ? kept_in : no_cell;
        const float alpha = shared::look_horizontal(run.in.alpha[i], u.alpha);
        const bool sums = u.match == shared_types::MATCH_LIGHT;
        const double depth = double(sums ? alpha : shared::look_small_depth(alpha));
        if (!(depth > 0.0) || beyond) return;
        const OneSplat even = varied ? look_at(run, plain, i) : look;
        const auto squared = [](float x) { return double(x) * double(x); };
        const double in_cells = falloff_integral / chart.blocks[block].cell_area;
        const double even_due = double(even.probability) * double(even.alpha) * squared(even.radius);
        const double opacity = sums ? depth : 1.0 - double(shared::as_exp(-float(depth)));
        cells.positions[cell] += 1.0f;
        add_wanted(cell, opacity, depth, look.color);
        CoverSums& cover = cells.cover[block];
        if (even.alpha < 1.0f) cover.due += even_due * in_cells / depth, cover.unclamped += 1.0;
        if (varied) {
            cells.plain[cell] += float(even_due);
            cells.varied[cell] += float(double(look.probability) * double(look.alpha) * squared(look.radius));
        }
        if (!look.keep) return;
        const double shown = double(look.alpha) * squared(look.radius) * in_cells;
        cells.depth[0][cell] += float(shown);
        for (int c = 0; c < 3; ++c)
            cells.depth[std::size_t(c) + 1][cell] += float(shown * double(look.color[c]));
        cells.squares[cell] += float(shown * shown);
    }

    // Light of a column of splats of the position's own alpha and color, as the blend has it.
    void add_wanted(std::size_t cell, double opacity, double matched_depth, const glm::vec3& color) {
        cells.wanted[0][cell] += float(opacity);
        for (int c = 0; c < 3; ++c) {
            const auto light = double(color[c]);
            const bool screened = run.uniforms.match == shared_types::MATCH_SCREEN;
            const double shown =
                screened ? 1.0 - double(shared::as_exp(-float(matched_depth * light))) : opacity * light;
            cells.wanted[std::size_t(c) + 1][cell] += float(shown);
        }
    }
};

}  // namespace

std::int64_t picture_cells_bytes(const PictureChart& chart, std::int64_t positions) {
    constexpr std::int64_t values = 2 * std::int64_t(picture_channels) + 4;
    return chart.cells() * values * std::int64_t(sizeof(float)) +
           positions * std::int64_t(sizeof(std::uint32_t));
}

PictureCells picture_cells(const LookRun& run, const SplatSet& set, const PictureChart& chart,
                           double falloff_integral) {
    return CellSums{run, set, chart, falloff_integral}.sums();
}

}  // namespace astrosplat
