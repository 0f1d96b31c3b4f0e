// Each row of blocks is summed by one thread, which takes the positions in the set's order. A set is in the
// order of its lattice, so a chunk of it lies in few rows and the others pass it by.

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/real.h"
#include "image/blur.h"
#include "look/picture_chart.h"
#include "look/shared_look.h"

namespace astrosplat {
namespace {

constexpr double cut_at = 3.0;  // sigma

std::vector<float> gaussian_taps(double sigma, bool squared) {
    const auto reach = static_cast<std::int64_t>(std::ceil(cut_at * sigma - 1e-9));
    std::vector<double> weights;
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        const double t = reach > 0 ? static_cast<double>(k) / sigma : 0.0;
        weights.push_back(real::exp(-0.5 * t * t));
        sum += weights.back();
    }
    std::vector<float> taps;
    for (const double w : weights)
        taps.push_back(static_cast<float>(squared ? w / sum * (w / sum) : w / sum));
    return taps;
}

std::int64_t reach_of(const std::vector<float>& taps) { return static_cast<std::int64_t>(taps.size() / 2); }

}  // namespace

ChartBlur::ChartBlur(const PictureChart& chart, bool squared) : chart_(chart) {
    for (const ChartBlock& block : chart.blocks) {
        taps_u_.push_back(gaussian_taps(block.sigma_u, squared));
        taps_v_.push_back(gaussian_taps(block.sigma_v, squared));
        reach_ = std::max({reach_, reach_of(taps_u_.back()), reach_of(taps_v_.back())});
    }
    between_.resize(static_cast<std::size_t>(chart.cells()));
}

void ChartBlur::operator()(CellValues& values) {
    along_rows(values, between_);
    along_columns(between_, values);
}

void ChartBlur::along_rows(const CellValues& from, CellValues& to) const {
    const std::int64_t columns = chart_.columns, rows = chart_.rows;
    parallel_chunks(chart_.meshes * rows, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<float> padded(static_cast<std::size_t>(columns + 2 * reach_));
        std::vector<const float*> shifted;
        for (std::int64_t y = begin; y < end; ++y) {
            std::copy_n(from.data() + y * columns, columns, padded.begin() + reach_);
            const std::int64_t first =
                (y / rows * chart_side + PictureChart::block_at(y % rows, rows)) * chart_side;
            for (std::int64_t b = 0; b < chart_side; ++b) {
                const std::int64_t x = PictureChart::block_begin(b, columns);
                const Taps& taps = taps_u_[static_cast<std::size_t>(first + b)];
                shifted.clear();
                for (std::int64_t k = 0; k < static_cast<std::int64_t>(taps.size()); ++k)
                    shifted.push_back(padded.data() + reach_ + x + k - reach_of(taps));
                weighted_rows(taps, shifted, PictureChart::block_begin(b + 1, columns) - x,
                              to.data() + y * columns + x);
            }
        }
    });
}

void ChartBlur::along_columns(const CellValues& from, CellValues& to) const {
    const std::int64_t columns = chart_.columns, rows = chart_.rows;
    const std::vector<float> nothing(static_cast<std::size_t>(columns));
    parallel_chunks(chart_.meshes * rows, 16, [&](std::int64_t begin, std::int64_t end, int) {
        std::vector<const float*> shifted;
        for (std::int64_t y = begin; y < end; ++y) {
            const std::int64_t mesh = y / rows;
            const std::int64_t first =
                (mesh * chart_side + PictureChart::block_at(y % rows, rows)) * chart_side;
            for (std::int64_t b = 0; b < chart_side; ++b) {
                const std::int64_t x = PictureChart::block_begin(b, columns);
                const Taps& taps = taps_v_[static_cast<std::size_t>(first + b)];
                shifted.clear();
                for (std::int64_t k = 0; k < static_cast<std::int64_t>(taps.size()); ++k) {
                    const std::int64_t row = y + k - reach_of(taps);
                    const bool there = row >= mesh * rows && row < (mesh + 1) * rows;
                    shifted.push_back((there ? from.data() + row * columns : nothing.data()) + x);
                }
                weighted_rows(taps, shifted, PictureChart::block_begin(b + 1, columns) - x,
                              to.data() + y * columns + x);
            }
        }
    });
}

namespace {

constexpr std::int64_t cells_chunk = 1 << 12;  // positions

// The look without what varies it from place to place.
LookUniforms unvaried(const LookUniforms& uniforms) {
    LookUniforms plain = uniforms;
    plain.noise_count = plain.crop_count = 0;
    return plain;
}

bool varies(const LookUniforms& u) {
    const auto has_effect = [](const shared_types::LookNoise& n) {
        return n.cull != 0.0f || n.silhouette != 0.0f || n.alpha != 0.0f;
    };
    return u.crop_count > 0 || std::any_of(u.noises, u.noises + u.noise_count, has_effect);
}

struct CellRange {
    std::int64_t least = 0, most = -1;
};

class CellSums {
  public:
    CellSums(const LookRun& run, const SplatSet& set, const PictureChart& chart, double falloff_integral)
        : run_(run),
          set_(set),
          chart_(chart),
          plain_(unvaried(run.uniforms)),
          varies_(varies(run.uniforms)),
          falloff_integral_(falloff_integral) {}

    PictureCells sums();

  private:
    void find_ranges();
    void sum_rows(std::int64_t band);
    void add(std::int64_t i, std::size_t cell, std::size_t block);
    void add_wanted(std::size_t cell, double opacity, double matched_depth, const glm::vec3& color);

    const LookRun& run_;
    const SplatSet& set_;
    const PictureChart& chart_;
    const LookUniforms plain_;
    const bool varies_;
    const double falloff_integral_;
    PictureCells cells_;
    std::vector<CellRange> ranges_;  // of chunks
};

void CellSums::find_ranges() {
    const std::int64_t count = set_.size();
    ranges_.resize(static_cast<std::size_t>((count + cells_chunk - 1) / cells_chunk));
    parallel_chunks(count, cells_chunk, [&](std::int64_t begin, std::int64_t end, int) {
        CellRange range{chart_.cells(), -1};
        for (std::int64_t i = begin; i < end; ++i) {
            const std::int64_t cell = chart_.cell_of(set_, i);
            range.least = std::min(range.least, cell), range.most = std::max(range.most, cell);
        }
        ranges_[static_cast<std::size_t>(begin / cells_chunk)] = range;
    });
}

// Light of a column of splats of the position's own alpha and color, as the blend has it.
void CellSums::add_wanted(std::size_t cell, double opacity, double matched_depth, const glm::vec3& color) {
    cells_.wanted[0][cell] += static_cast<float>(opacity);
    for (int c = 0; c < 3; ++c) {
        const auto light = static_cast<double>(color[c]);
        const bool screened = run_.uniforms.match == shared_types::MATCH_SCREEN;
        const double shown =
            screened ? 1.0 - static_cast<double>(shared::as_exp(-static_cast<float>(matched_depth * light)))
                     : opacity * light;
        cells_.wanted[static_cast<std::size_t>(c) + 1][cell] += static_cast<float>(shown);
    }
}

void CellSums::add(std::int64_t i, std::size_t cell, std::size_t block) {
    const LookUniforms& u = run_.uniforms;
    const OneSplat look = look_at(run_, u, i);
    const bool beyond = PictureChart::on_edge(set_, i);
    const std::uint32_t kept_in = beyond ? beyond_cells : static_cast<std::uint32_t>(cell);
    cells_.cell_of[static_cast<std::size_t>(i)] = look.keep ? kept_in : no_cell;
    const float alpha = shared::look_horizontal(run_.in.alpha[i], u.alpha);
    const bool sums = u.match == shared_types::MATCH_LIGHT;
    const double depth = static_cast<double>(sums ? alpha : shared::look_small_depth(alpha));
    if (!(depth > 0.0) || beyond) return;
    const OneSplat plain = varies_ ? look_at(run_, plain_, i) : look;
    const auto squared = [](float x) { return static_cast<double>(x) * static_cast<double>(x); };
    const double in_cells = falloff_integral_ / chart_.blocks[block].cell_area;
    const double plain_due =
        static_cast<double>(plain.probability) * static_cast<double>(plain.alpha) * squared(plain.radius);
    const double opacity =
        sums ? depth : 1.0 - static_cast<double>(shared::as_exp(-static_cast<float>(depth)));
    cells_.positions[cell] += 1.0f;
    add_wanted(cell, opacity, depth, look.color);
    CoverSums& cover = cells_.cover[block];
    if (plain.alpha < 1.0f) cover.due += plain_due * in_cells / depth, cover.unclamped += 1.0;
    if (varies_) {
        cells_.plain[cell] += static_cast<float>(plain_due);
        cells_.varied[cell] += static_cast<float>(static_cast<double>(look.probability) *
                                                  static_cast<double>(look.alpha) * squared(look.radius));
    }
    if (!look.keep) return;
    const double shown = static_cast<double>(look.alpha) * squared(look.radius) * in_cells;
    cells_.depth[0][cell] += static_cast<float>(shown);
    for (int c = 0; c < 3; ++c)
        cells_.depth[static_cast<std::size_t>(c) + 1][cell] +=
            static_cast<float>(shown * static_cast<double>(look.color[c]));
    cells_.squares[cell] += static_cast<float>(shown * shown);
}

// A band is a row of blocks of one mesh.
void CellSums::sum_rows(std::int64_t band) {
    const std::int64_t mesh = band / chart_side, block_row = band % chart_side, columns = chart_.columns;
    const std::int64_t first =
        (mesh * chart_.rows + PictureChart::block_begin(block_row, chart_.rows)) * columns;
    const std::int64_t end =
        (mesh * chart_.rows + PictureChart::block_begin(block_row + 1, chart_.rows)) * columns;
    for (std::size_t chunk = 0; chunk < ranges_.size(); ++chunk) {
        if (ranges_[chunk].most < first || ranges_[chunk].least >= end) continue;
        const std::int64_t begin = static_cast<std::int64_t>(chunk) * cells_chunk;
        for (std::int64_t i = begin; i < std::min(begin + cells_chunk, set_.size()); ++i) {
            const std::int64_t cell = chart_.cell_of(set_, i);
            if (cell < first || cell >= end) continue;
            const std::int64_t block = band * chart_side + PictureChart::block_at(cell % columns, columns);
            add(i, static_cast<std::size_t>(cell), static_cast<std::size_t>(block));
        }
    }
}

PictureCells CellSums::sums() {
    const auto zero = [&](CellValues& values) {
        values.assign(static_cast<std::size_t>(chart_.cells()), 0.0f);
    };
    for (std::size_t c = 0; c < picture_channels; ++c) zero(cells_.depth[c]), zero(cells_.wanted[c]);
    zero(cells_.squares), zero(cells_.positions);
    if (varies_) zero(cells_.varied), zero(cells_.plain);
    cells_.cover.resize(chart_.blocks.size());
    cells_.cell_of.resize(static_cast<std::size_t>(set_.size()));
    find_ranges();
    parallel_for(chart_.meshes * chart_side, [&](std::int64_t band, int) { sum_rows(band); });
    return std::move(cells_);
}

}  // namespace

std::int64_t picture_cells_bytes(const PictureChart& chart, std::int64_t positions) {
    constexpr std::int64_t values = 2 * static_cast<std::int64_t>(picture_channels) + 4;
    return chart.cells() * values * static_cast<std::int64_t>(sizeof(float)) +
           positions * static_cast<std::int64_t>(sizeof(std::uint32_t));
}

PictureCells picture_cells(const LookRun& run, const SplatSet& set, const PictureChart& chart,
                           double falloff_integral) {
    return CellSums(run, set, chart, falloff_integral).sums();
}

}  // namespace astrosplat
