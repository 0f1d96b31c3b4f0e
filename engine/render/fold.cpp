#include "render/fold.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "render/fold_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/fold.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "render/fold_blend-inl.h"
#include "render/fold_prepare-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {

/// One cell being folded.
struct Cell {
    std::size_t first_pixel;  // in the planes
    float x0_px, y0_px;       // of the whole picture
    std::uint64_t open;       // blocks that take more light
};

/// Folds the splats `bits` of a batch into one block; false when all of its pixels are closed.
template <class Pixels, bool kFlat>
bool fold_block(const SplatBatch& batch, std::uint64_t bits, const Cell& cell, int block, float stop_at,
                TilePlanes& planes) {
    alignas(64) static constexpr float column[16] = {0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                                     0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f};
    alignas(64) static constexpr float row[16] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f,
                                                  2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f};
    const auto edge = [](float corner, int n) {
        return corner + static_cast<float>(n * TilePlanes::block_px);
    };
    const V stop = all(stop_at);
    bool open = !Pixels::closes;
    for (int part = 0; part < TilePlanes::block_pixels; part += lanes) {
        const V x = hn::Add(load(column + part), all(edge(cell.x0_px, block % TilePlanes::cell_blocks)));
        const V y = hn::Add(load(row + part), all(edge(cell.y0_px, block / TilePlanes::cell_blocks)));
        const std::size_t at =
            cell.first_pixel + static_cast<std::size_t>(block * TilePlanes::block_pixels + part);
        Pixels pixels(planes, at);
        for (std::uint64_t rest = bits; rest != 0; rest &= rest - 1) {
            const int i = std::countr_zero(rest);
            const V dx = hn::Sub(x, all(batch.x_px[i])), dy = hn::Sub(y, all(batch.y_px[i]));
            const V w = weight_at<kFlat>(batch, i, hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
            FoldStep step{batch, i, {}};
            if constexpr (Pixels::aovs)
                for (std::size_t k = 0; k < 4; ++k)
                    step.layer_light[k] = planes.layer_light[4 * std::size_t{batch.layer[i]} + k].data() + at;
            pixels.fold(step, saturate(hn::Mul(all(batch.opacity[i]), w)),
                        hn::Mul(w, all(batch.weight_gain[i])), stop);
        }
        pixels.store_to(planes, at);
        if constexpr (Pixels::closes) open = open || !hn::AllFalse(D(), pixels.open(stop));
    }
    return open;
}

/// Prepares those splats of the batch that touch an open block, and folds the batch. `table`: the footprint
/// table of all layers, or null when they differ.
template <class Pixels, bool kFlat>
void fold_batch(const FoldJob& job, const FootprintTable* table, SplatBatch& batch, Cell& cell,
                TilePlanes& planes) {
    for (int i = batch.count; i % lanes != 0; ++i) {
        batch.x_px[i] = batch.y_px[i] = 0.0f;
        batch.reach_squared[i] = -1.0f;
    }
    find_touched_blocks(batch, cell.x0_px, cell.y0_px);
    std::uint64_t touching = 0;
    for (std::uint64_t rest = cell.open; rest != 0; rest &= rest - 1)
        touching |= batch.touches[std::countr_zero(rest)];
    if (touching != 0) prepare_splats<Pixels>(job, table, touching, batch);
    for (std::uint64_t rest = cell.open; rest != 0; rest &= rest - 1) {
        const int block = std::countr_zero(rest);
        if (batch.touches[block] == 0) continue;
        if (!fold_block<Pixels, kFlat>(batch, batch.touches[block], cell, block, job.settings.stop, planes))
            cell.open &= ~(std::uint64_t{1} << block);
    }
    batch.count = 0;
}

/// A record may lie in two cache lines.
HWY_INLINE void prefetch(const ScreenSplat& splat) {
    hwy::Prefetch(&splat);
    hwy::Prefetch(&splat.hybrid);
}

/// Adds a splat to the batch if its support may touch the cell.
HWY_INLINE void gather(const ScreenSplat& splat, const FoldLayer& layer, const Cell& cell,
                       SplatBatch& batch) {
    constexpr float half = 0.5f * static_cast<float>(TilePlanes::cell_px);
    // Radii below the smallest tabulated one have its support; rounding must not lose a pixel.
    const float reach = layer.footprints->drawn_support_px(splat.radius_px) * 1.0001f;
    const float dx = std::fabs(splat.x_px - (cell.x0_px + half)),
                dy = std::fabs(splat.y_px - (cell.y0_px + half));
    const int n = batch.count;
    batch.splat[n] = &splat;
    batch.x_px[n] = splat.x_px;
    batch.y_px[n] = splat.y_px;
    batch.reach_squared[n] = reach * reach;
    batch.count = n + (std::max(dx, dy) < reach + half);
}

/// Blocks of a cell that lie in the used part of the tile.
std::uint64_t used_blocks(const TilePlanes& planes, int column, int row) {
    const auto blocks = [](int px) {
        return std::clamp((px + TilePlanes::block_px - 1) / TilePlanes::block_px, 0, TilePlanes::cell_blocks);
    };
    const int columns = blocks(planes.width - column * TilePlanes::cell_px);
    const int rows = blocks(planes.height - row * TilePlanes::cell_px);
    std::uint64_t used = 0;
    for (int r = 0; r < rows; ++r)
        used |= ((std::uint64_t{1} << columns) - 1) << (r * TilePlanes::cell_blocks);
    return used;
}

/// Pixels that are closed take their final values.
template <class Pixels>
void close_cell(const Cell& cell, float stop, TilePlanes& planes) {
    for (std::size_t i = cell.first_pixel; i < cell.first_pixel + TilePlanes::cell_pixels; i += lanes) {
        Pixels pixels(planes, i);
        pixels.close(all(stop));
        pixels.store_to(planes, i);
    }
}

const FootprintTable* common_table(std::span<const FoldLayer> layers) {
    const auto same = [&](const FoldLayer& layer) { return layer.footprints == layers[0].footprints; };
    return std::all_of(layers.begin(), layers.end(), same) ? layers[0].footprints : nullptr;
}

template <class Pixels, bool kFlat>
void fold_cells(const FoldJob& job, TilePlanes& planes) {
    constexpr std::size_t check_every = 1024, fetch_ahead = 16;
    static thread_local const std::unique_ptr<SplatBatch> batch_memory = std::make_unique<SplatBatch>();
    SplatBatch& batch = *batch_memory;
    const FootprintTable* table = common_table(job.layers);
    for (int n = 0; n < planes.cell_columns * planes.cell_rows; ++n) {
        const int column = n % planes.cell_columns, row = n / planes.cell_columns;
        Cell cell{static_cast<std::size_t>(n * TilePlanes::cell_pixels),
                  static_cast<float>(planes.x0 + column * TilePlanes::cell_px),
                  static_cast<float>(planes.y0 + row * TilePlanes::cell_px),
                  used_blocks(planes, column, row)};
        batch.count = 0;
        for (std::size_t i = 0; i < job.splats.size() && cell.open != 0; ++i) {
            if (i % check_every == 0) job.progress.check();
            if (i + fetch_ahead < job.splats.size()) prefetch(*job.splats[i + fetch_ahead]);
            const ScreenSplat& splat = *job.splats[i];
            gather(splat, job.layers[splat.layer], cell, batch);
            if (batch.count == SplatBatch::size) fold_batch<Pixels, kFlat>(job, table, batch, cell, planes);
        }
        fold_batch<Pixels, kFlat>(job, table, batch, cell, planes);
        if constexpr (Pixels::closes) close_cell<Pixels>(cell, job.settings.stop, planes);
    }
}

template <class Pixels>
void fold_pixels(const FoldJob& job, TilePlanes& planes) {
    const bool flat = std::any_of(job.layers.begin(), job.layers.end(),
                                  [](const FoldLayer& layer) { return layer.footprints->flat_core; });
    flat ? fold_cells<Pixels, true>(job, planes) : fold_cells<Pixels, false>(job, planes);
}

template <bool kAovs>
void fold_kind(const FoldJob& job, TilePlanes& planes) {
    const bool holds = std::any_of(job.layers.begin(), job.layers.end(),
                                   [](const FoldLayer& layer) { return layer.holdout; });
    if (job.settings.kind == FoldKind::lighten)
        fold_pixels<LightenPixels<kAovs>>(job, planes);
    else if (holds)
        fold_pixels<GeneralPixels<kAovs, true>>(job, planes);
    else
        fold_pixels<GeneralPixels<kAovs, false>>(job, planes);
}

void fold_here(const FoldJob& job, TilePlanes& planes) {
    if (job.settings.kind == FoldKind::over)
        fold_pixels<OverPixels>(job, planes);
    else if (job.settings.kind == FoldKind::add)
        fold_pixels<AddPixels>(job, planes);
    else if (job.settings.aovs)
        fold_kind<true>(job, planes);
    else
        fold_kind<false>(job, planes);
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(fold_here);

void fold(const FoldJob& job, TilePlanes& planes) { HWY_DYNAMIC_DISPATCH(fold_here)(job, planes); }

void TilePlanes::reset(const Region& tile, const FoldSettings& settings, std::size_t layer_count) {
    x0 = tile.x;
    y0 = tile.y;
    width = static_cast<int>(tile.width);
    height = static_cast<int>(tile.height);
    cell_columns = (width + cell_px - 1) / cell_px;
    cell_rows = (height + cell_px - 1) / cell_px;
    const auto size = static_cast<std::size_t>(cell_columns * cell_rows * cell_pixels);
    for (Buffer<float>& plane : color) plane.assign(size, 0.0f);
    alpha.assign(size, 0.0f);
    for (Buffer<float>& plane : transmittance) plane.assign(size, 1.0f);
    held.assign(size, 0.0f);
    if (!settings.aovs) return;
    depth_sum.assign(size, 0.0f);
    uncovered.assign(size, 1.0f);
    count.assign(size, 0.0f);
    layer_light.resize(4 * layer_count);
    for (Buffer<float>& plane : layer_light) plane.assign(size, 0.0f);
}

}  // namespace astrosplat
#endif  // HWY_ONCE
