#include "render/fold.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "render/fold_batch.h"
#include "render/shared_render.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/fold.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/highway.h>

#include "render/fold_blend-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {

/// Cubics between the footprint's two nodes.
HWY_INLINE void prepare_cubics(const Footprint& f, PreparedSplat& to) {
    const V t = all(f.t);
    for (int power = 0; power < 4; ++power)
        for (int i = 0; i < segments; i += lanes) {
            const V a = load(f.node_a->cubic[power] + i), b = load(f.node_b->cubic[power] + i);
            store(hn::Add(a, hn::Mul(hn::Sub(b, a), t)), to.cubic[power] + i);
        }
}

/// Everything of splat `i` of the batch but its cubics.
void prepare_constants(const ScreenSplat& splat, const FoldLayer& layer, const Footprint& footprint,
                       const FoldSettings& settings, SplatBatch& batch, int i) {
    PreparedSplat& p = batch.splats[i];
    const float h = static_cast<float>(splat.hybrid) * (1.0f / 65535.0f);
    const int blend = layer.holdout ? shared::BLEND_OVER : static_cast<int>(layer.blend);
    p.x_px = splat.x_px;
    p.y_px = splat.y_px;
    p.lo = footprint.lo;
    p.scale = footprint.scale;
    p.edge_gain = footprint.edge_gain;
    p.opacity = splat.opacity * footprint.amplitude;
    p.weight_gain = footprint.amplitude;
    p.shows = layer.holdout ? 0.0f : 1.0f;
    batch.linear_in_distance[i] = layer.footprints->linear_in_distance;
    batch.layer[i] = splat.layer;
    float sum = 0.0f;
    bool bright = false;
    for (int k = 0; k < 3; ++k) {
        p.color[k] = layer.holdout ? 0.0f : splat.color[k];
        p.occlusion[k] = shared::blend_occlusion(blend, splat.color[k], h);
        sum += p.occlusion[k];
        bright = bright || (blend == shared::BLEND_SCREEN && splat.color[k] > 1.0f);
    }
    p.occlusion[3] = sum / 3.0f;
    batch.bright_screen[i] = bright;
    if (!settings.aovs) return;
    const float x = (splat.x_px - settings.center_x_px) / settings.focal_px;
    const float y = (splat.y_px - settings.center_y_px) / settings.focal_px;
    const float key = std::bit_cast<float>(splat.depth);
    p.depth = settings.orthographic ? key : std::sqrt(key / (1.0f + x * x + y * y));
}

/// Squared distance along one axis from `lanes` splats to the nearest pixel centre of a row or column of
/// blocks.
HWY_INLINE V distance_to_block(V center, float first_px) {
    const float half = 0.5f * static_cast<float>(TilePlanes::block_px - 1);
    const V middle = all(first_px + 0.5f * static_cast<float>(TilePlanes::block_px));
    const V distance = hn::Max(hn::Sub(hn::Abs(hn::Sub(center, middle)), all(half)), hn::Zero(D()));
    return hn::Mul(distance, distance);
}

HWY_INLINE void set_bits(M mask, int first, std::uint64_t& word) {
    std::uint8_t bytes[8] = {};  // StoreMaskBits may write more than it needs
    hn::StoreMaskBits(D(), mask, bytes);
    word |= (std::uint64_t{bytes[0]} | std::uint64_t{bytes[1]} << 8) << first;
}

/// Which splats of the batch may have weight in which blocks of a cell whose corner is (x0, y0).
void find_touched_blocks(SplatBatch& batch, float x0_px, float y0_px) {
    constexpr int side = TilePlanes::cell_blocks;
    std::fill_n(batch.touches, SplatBatch::blocks, std::uint64_t{0});
    for (int n = 0; n < batch.count; n += lanes) {
        const V x = load(batch.x_px + n), y = load(batch.y_px + n), reach = load(batch.reach_squared + n);
        V dx[side];
        for (int c = 0; c < side; ++c)
            dx[c] = distance_to_block(x, x0_px + static_cast<float>(c * TilePlanes::block_px));
        for (int r = 0; r < side; ++r) {
            const V dy = distance_to_block(y, y0_px + static_cast<float>(r * TilePlanes::block_px));
            for (int c = 0; c < side; ++c)
                set_bits(hn::Le(hn::Add(dx[c], dy), reach), n, batch.touches[r * side + c]);
        }
    }
}

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
            const PreparedSplat& splat = batch.splats[i];
            const V dx = hn::Sub(x, all(splat.x_px)), dy = hn::Sub(y, all(splat.y_px));
            const V w = weight_at<kFlat>(splat, batch.linear_in_distance[i],
                                         hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
            FoldStep step{splat, batch.bright_screen[i] != 0, {}};
            if constexpr (Pixels::aovs)
                for (std::size_t k = 0; k < 4; ++k)
                    step.layer_light[k] = planes.layer_light[4 * std::size_t{batch.layer[i]} + k].data() + at;
            pixels.fold(step, saturate(hn::Mul(all(splat.opacity), w)), hn::Mul(w, all(splat.weight_gain)),
                        stop);
        }
        pixels.store_to(planes, at);
        if constexpr (Pixels::closes) open = open || !hn::AllFalse(D(), pixels.open(stop));
    }
    return open;
}

/// Prepares those splats of the batch that touch an open block, and folds the batch.
template <class Pixels, bool kFlat>
void fold_batch(std::span<const ScreenSplat> splats, std::span<const FoldLayer> layers,
                const FoldSettings& settings, SplatBatch& batch, Cell& cell, TilePlanes& planes) {
    for (int i = batch.count; i % lanes != 0; ++i) {
        batch.x_px[i] = batch.y_px[i] = 0.0f;
        batch.reach_squared[i] = -1.0f;
    }
    find_touched_blocks(batch, cell.x0_px, cell.y0_px);
    std::uint64_t touching = 0;
    for (std::uint64_t rest = cell.open; rest != 0; rest &= rest - 1)
        touching |= batch.touches[std::countr_zero(rest)];
    for (; touching != 0; touching &= touching - 1) {
        const int i = std::countr_zero(touching);
        const ScreenSplat& splat = splats[batch.index[i]];
        const FoldLayer& layer = layers[splat.layer];
        Footprint footprint;
        footprint_at(*layer.footprints, splat.radius_px, splat.x_px, splat.y_px, footprint);
        prepare_cubics(footprint, batch.splats[i]);
        prepare_constants(splat, layer, footprint, settings, batch, i);
    }
    for (std::uint64_t rest = cell.open; rest != 0; rest &= rest - 1) {
        const int block = std::countr_zero(rest);
        if (batch.touches[block] == 0) continue;
        if (!fold_block<Pixels, kFlat>(batch, batch.touches[block], cell, block, settings.stop, planes))
            cell.open &= ~(std::uint64_t{1} << block);
    }
    batch.count = 0;
}

/// Adds a splat to the batch if its support may touch the cell.
HWY_INLINE void gather(const ScreenSplat& splat, std::uint32_t index, const FoldLayer& layer,
                       const Cell& cell, SplatBatch& batch) {
    constexpr float half = 0.5f * static_cast<float>(TilePlanes::cell_px);
    // Radii below the smallest tabulated one have its support; rounding must not lose a pixel.
    const float reach = layer.footprints->drawn_support_px(splat.radius_px) * 1.0001f;
    const float dx = std::fabs(splat.x_px - (cell.x0_px + half)),
                dy = std::fabs(splat.y_px - (cell.y0_px + half));
    const int n = batch.count;
    batch.index[n] = index;
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

template <class Pixels, bool kFlat>
void fold_cells(std::span<const ScreenSplat> splats, std::span<const std::uint32_t> order,
                std::span<const FoldLayer> layers, const FoldSettings& settings, const Progress& progress,
                TilePlanes& planes) {
    constexpr std::size_t check_every = 1024;
    static thread_local std::unique_ptr<SplatBatch> batch_memory = std::make_unique<SplatBatch>();
    SplatBatch& batch = *batch_memory;
    for (int n = 0; n < planes.cell_columns * planes.cell_rows; ++n) {
        const int column = n % planes.cell_columns, row = n / planes.cell_columns;
        Cell cell{static_cast<std::size_t>(n * TilePlanes::cell_pixels),
                  static_cast<float>(planes.x0 + column * TilePlanes::cell_px),
                  static_cast<float>(planes.y0 + row * TilePlanes::cell_px),
                  used_blocks(planes, column, row)};
        batch.count = 0;
        for (std::size_t i = 0; i < order.size() && cell.open != 0; ++i) {
            if (i % check_every == 0) progress.check();
            const ScreenSplat& splat = splats[order[i]];
            gather(splat, order[i], layers[splat.layer], cell, batch);
            if (batch.count == SplatBatch::size)
                fold_batch<Pixels, kFlat>(splats, layers, settings, batch, cell, planes);
        }
        fold_batch<Pixels, kFlat>(splats, layers, settings, batch, cell, planes);
        if constexpr (Pixels::closes) close_cell<Pixels>(cell, settings.stop, planes);
    }
}

template <class Pixels>
void fold_pixels(std::span<const ScreenSplat> splats, std::span<const std::uint32_t> order,
                 std::span<const FoldLayer> layers, const FoldSettings& settings, const Progress& progress,
                 TilePlanes& planes) {
    const bool flat = std::any_of(layers.begin(), layers.end(),
                                  [](const FoldLayer& layer) { return layer.footprints->flat_core; });
    flat ? fold_cells<Pixels, true>(splats, order, layers, settings, progress, planes)
         : fold_cells<Pixels, false>(splats, order, layers, settings, progress, planes);
}

template <bool kAovs>
void fold_kind(std::span<const ScreenSplat> splats, std::span<const std::uint32_t> order,
               std::span<const FoldLayer> layers, const FoldSettings& settings, const Progress& progress,
               TilePlanes& planes) {
    const bool holds =
        std::any_of(layers.begin(), layers.end(), [](const FoldLayer& layer) { return layer.holdout; });
    if (settings.kind == FoldKind::lighten)
        fold_pixels<LightenPixels<kAovs>>(splats, order, layers, settings, progress, planes);
    else if (holds)
        fold_pixels<GeneralPixels<kAovs, true>>(splats, order, layers, settings, progress, planes);
    else
        fold_pixels<GeneralPixels<kAovs, false>>(splats, order, layers, settings, progress, planes);
}

void fold_here(std::span<const ScreenSplat> splats, std::span<const std::uint32_t> order,
               std::span<const FoldLayer> layers, const FoldSettings& settings, const Progress& progress,
               TilePlanes& planes) {
    if (settings.kind == FoldKind::over)
        fold_pixels<OverPixels>(splats, order, layers, settings, progress, planes);
    else if (settings.kind == FoldKind::add)
        fold_pixels<AddPixels>(splats, order, layers, settings, progress, planes);
    else if (settings.aovs)
        fold_kind<true>(splats, order, layers, settings, progress, planes);
    else
        fold_kind<false>(splats, order, layers, settings, progress, planes);
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(fold_here);

void fold(std::span<const ScreenSplat> splats, std::span<const std::uint32_t> order,
          std::span<const FoldLayer> layers, const FoldSettings& settings, const Progress& progress,
          TilePlanes& planes) {
    HWY_DYNAMIC_DISPATCH(fold_here)(splats, order, layers, settings, progress, planes);
}

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
