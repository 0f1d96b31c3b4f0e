#include "render/fold.h"

#include "render/fold_batch.h"
#include "render/shape.h"
#include "render/sphere_shape.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/fold.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h has to come before highway.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "core/lanes-inl.h"
#include "render/fold_blend-inl.h"
#include "render/fold_prepare-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat::HWY_NAMESPACE {

/// One cell being folded.
struct Cell {
    std::size_t first_pixel;  // in the planes
    float x0_px, y0_px;       // of the whole frame
    std::uint64_t open;       // blocks that take more light
    const Cap* caps;          // of its blocks; onto the sphere only
};

template <Outline kOutline>
BlockPart block_part(const TilePlanes& planes, const Cell& cell, int block, int first) {
    alignas(64) static constexpr float column[16] = {0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                                     0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f};
    alignas(64) static constexpr float row[16] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f,
                                                  2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f};
    const auto edge = [](float corner, int n) { return corner + float(n * TilePlanes::block_px); };
    const float x_px = edge(cell.x0_px, block % TilePlanes::cell_blocks),
                y_px = edge(cell.y0_px, block / TilePlanes::cell_blocks);
    BlockPart part;
    for (int p = 0; p < parts; ++p) {
        // Whole rows have the same columns: these are computed once for all.
        part.x_px[p] = p > 0 && lanes % TilePlanes::block_px == 0
                           ? part.x_px[0]
                           : hn::Add(load(column + first + p * lanes), all(x_px));
        part.y_px[p] = hn::Add(load(row + first + p * lanes), all(y_px));
    }
    part.at = cell.first_pixel + std::size_t(block * TilePlanes::block_pixels + first);
    if constexpr (is_onto_sphere(kOutline))
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t p = 0; p < parts; ++p)
                part.toward[k][p] = load(&planes.toward[k][part.at + p * lanes]);
    return part;
}

/// The state of a part of a block.
template <class Pixels>
using PartPixels = std::array<Pixels, parts>;

template <class Pixels, std::size_t... kPart>
HWY_INLINE PartPixels<Pixels> load_pixels(const TilePlanes& planes, std::size_t at,
                                          std::index_sequence<kPart...>) {
    return {Pixels(planes, at + kPart * lanes)...};
}
template <class Pixels>
HWY_INLINE PartPixels<Pixels> load_pixels(const TilePlanes& planes, std::size_t at) {
    return load_pixels<Pixels>(planes, at, std::make_index_sequence<parts>());
}

template <class Pixels>
HWY_INLINE void store_pixels(const PartPixels<Pixels>& pixels, TilePlanes& planes, std::size_t at) {
    for (std::size_t p = 0; p < parts; ++p) pixels[p].store_to(planes, at + p * lanes);
}

template <class Pixels>
HWY_INLINE bool all_open(const PartPixels<Pixels>& pixels, V stop) {
    M open = pixels[0].open(stop);
    for (std::size_t p = 1; p < parts; ++p) open = hn::And(open, pixels[p].open(stop));
    return hn::AllTrue(D(), open);
}

template <class Pixels>
HWY_INLINE bool any_open(const PartPixels<Pixels>& pixels, V stop) {
    M open = pixels[0].open(stop);
    for (std::size_t p = 1; p < parts; ++p) open = hn::Or(open, pixels[p].open(stop));
    return !hn::AllFalse(D(), open);
}

/// Folds the splats `bits` of a batch into a part of a block. Unless kMayClose, all its pixels have to be
/// open to the end, and the batch faint.
template <Outline kOutline, bool kMayClose, class Pixels>
HWY_INLINE void fold_splats(const SplatBatch& batch, SplatBits bits, const BlockPart& part, V stop,
                            TilePlanes& planes, PartPixels<Pixels>& pixels) {
    auto next = begin_splats<kOutline>(batch, bits, part);
    for (bool more = true; more;) {
        const auto now = next;
        more = bits.any();
        if (more) next = begin_splats<kOutline>(batch, bits, part);
        V w[sides];
        end_splats<kOutline>(batch, now, w);
        for (int n = 0; n < sides; ++n) {
            const int i = now.i[n];
            FoldStep step{batch, i, {}};
            if constexpr (Pixels::aovs)
                for (std::size_t k = 0; k < 4; ++k)
                    step.layer_light[k] = planes.layer_light[4 * std::size_t{batch.layer[i]} + k].data() +
                                          part.at + part_of(n) * lanes;
            const V s = clamp_zero(hn::Mul(all(batch.opacity[i]), w[n]));
            pixels[part_of(n)].template fold<kMayClose>(step, kMayClose ? clamp_one(s) : s,
                                                        hn::Mul(w[n], all(batch.weight_gain[i])), stop);
        }
    }
}

/// Folds the splats `bits` of a batch into a part of a block as if no pixel closed; false, and nothing done,
/// if one does.
template <class Pixels>
HWY_INLINE bool fold_open(const SplatBatch& batch, SplatBits bits, const BlockPart& part, V stop,
                          TilePlanes& planes) {
    auto pixels = load_pixels<Pixels>(planes, part.at);
    if (!all_open(pixels, stop)) return false;
    fold_splats<Outline::soft, false>(batch, bits, part, stop, planes, pixels);
    // Transmittances never grow: if all pixels are open at the end they were all the time, and no splat
    // needed to be asked about.
    if (!all_open(pixels, stop)) return false;
    store_pixels(pixels, planes, part.at);
    return true;
}

/// Folds them asking of every splat which pixels are open; false if they close, and none is open at the end.
template <class Pixels, Outline kOutline>
HWY_NOINLINE bool fold_closing(const SplatBatch& batch, SplatBits bits, const BlockPart& part, V stop,
                               TilePlanes& planes) {
    auto pixels = load_pixels<Pixels>(planes, part.at);
    fold_splats<kOutline, true>(batch, bits, part, stop, planes, pixels);
    store_pixels(pixels, planes, part.at);
    return !Pixels::closes || any_open(pixels, stop);
}

/// Folds the splats `bits` of a batch into one block; false when all of its pixels are closed.
template <class Pixels, Outline kOutline>
HWY_INLINE bool fold_block(const SplatBatch& batch, SplatBits bits, const Cell& cell, int block,
                           float stop_at, TilePlanes& planes) {
    const V stop = all(stop_at);
    bool open = false;
    for (int first = 0; first < TilePlanes::block_pixels; first += lanes * parts) {
        const BlockPart part = block_part<kOutline>(planes, cell, block, first);
        bool is_done = false;
        if constexpr (kOutline == Outline::soft && !Pixels::aovs)  // AOVs write the layers' light at once
            is_done = batch.is_faint && fold_open<Pixels>(batch, bits, part, stop, planes);
        open |= is_done || fold_closing<Pixels, kOutline>(batch, bits, part, stop, planes);
    }
    return open;
}

/// A record may lie in two cache lines.
HWY_INLINE void prefetch(const ScreenSplat& splat) {
    hwy::Prefetch(&splat);
    hwy::Prefetch(&splat.hybrid);
}

/// Prepares those splats of the batch that touch an open block, and folds the batch.
template <class Pixels, Outline kOutline>
void fold_batch(const FoldJob& job, const FoldCommon& common, SplatBatch& batch, Cell& cell,
                TilePlanes& planes) {
    for (int i = 0; i < batch.count; ++i) prefetch(*job.splats[batch.index[i]]);
    if constexpr (is_onto_sphere(kOutline))
        find_touched_caps(batch, cell.caps);
    else
        find_touched_blocks(batch, cell.x0_px, cell.y0_px);
    SplatBits touching;
    for (std::uint64_t rest = cell.open; rest != 0; rest &= rest - 1)
        touching |= batch.touches[std::countr_zero(rest)];
    if (touching.any()) prepare_splats<Pixels>(job, common, touching, batch);
    for (std::uint64_t rest = cell.open; rest != 0; rest &= rest - 1) {
        const int block = std::countr_zero(rest);
        if (!batch.touches[block].any()) continue;
        if (!fold_block<Pixels, kOutline>(batch, batch.touches[block], cell, block, job.settings.stop,
                                          planes))
            cell.open &= ~(std::uint64_t{1} << block);
    }
}

/// Distance from the centre beyond which a splat's weights are 0. Radii below the smallest tabulated one have
/// its support.
float drawn_support_px(const FootprintTable& table, const ScreenSplat& splat, std::span<const Shape> shapes) {
    if (shapes.empty() || is_round(splat)) return table.drawn_support_px(splat.radius_px);
    return shape_support_px(shapes[shape_number(splat)],
                            {table.reach, 4.0f * table.pixel_filter_px, table.variance});
}

/// Sets the discs of all splats.
void find_discs(const FoldJob& job, Discs& discs) {
    constexpr std::size_t fetch_ahead = 16, check_every = 65536;
    const std::size_t count = job.splats.size();
    discs.resize(count + lanes);
    for (std::size_t i = 0; i < count; ++i) {
        if (i % check_every == 0) job.progress.check();
        if (i + fetch_ahead < count) prefetch(*job.splats[i + fetch_ahead]);
        const ScreenSplat& splat = *job.splats[i];
        // Rounding must not lose a pixel.
        const float reach_px =
            drawn_support_px(*job.layers[splat.layer].footprints, splat, job.shapes) * 1.0001f;
        discs.set(i, splat.x_px, splat.y_px, reach_px);
    }
    for (std::size_t i = count; i < count + lanes; ++i) discs.set_nowhere(i);
}

/// Appends those of the splats [begin, end) whose support may touch the cell.
void find_in_cell(const Discs& discs, std::size_t begin, std::size_t end, const Cell& cell,
                  CellSplats& found) {
    constexpr float half = 0.5f * float(TilePlanes::cell_px);
    const hn::RebindToUnsigned<D> du;
    const V middle_x = all(cell.x0_px + half), middle_y = all(cell.y0_px + half);
    for (std::size_t i = begin; i < end; i += lanes) {
        const V x = hn::Load(D(), &discs.x_px[i]), y = hn::Load(D(), &discs.y_px[i]),
                reach = hn::Load(D(), &discs.reach_px[i]);
        const V distance = hn::Max(hn::Abs(hn::Sub(x, middle_x)), hn::Abs(hn::Sub(y, middle_y)));
        const M near = hn::Lt(distance, hn::Add(reach, all(half)));
        const auto index = hn::Add(counting(du), hn::Set(du, std::uint32_t(i)));
        const std::size_t n = found.count;
        append(D(), x, near, &found.discs.x_px[n]);
        append(D(), y, near, &found.discs.y_px[n]);
        append(D(), reach, near, &found.discs.reach_px[n]);
        append(du, index, hn::RebindMask(du, near), &found.index[n]);
        found.count = n + hn::CountTrue(D(), near);
    }
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

FoldCommon common_of(const FoldJob& job) {
    const std::span<const FoldLayer> layers = job.layers;
    const auto all_like = [&](auto&& test) { return std::ranges::all_of(layers, test); };
    const bool one_table =
        all_like([&](const FoldLayer& layer) { return layer.footprints == layers[0].footprints; });
    const bool screen = all_like([](const FoldLayer& layer) {
        return layer.blend == Blend::screen && !layer.holdout && !layer.absorbs;
    });
    const bool plain = job.shapes.empty() && !shared::is_onto_sphere(job.settings.lens);
    return {one_table && plain ? layers[0].footprints : nullptr, screen};
}

/// Folds the splats found, as far as they make whole batches; the others move to the front. `last`:
/// also those.
template <class Pixels, Outline kOutline>
void fold_found(const FoldJob& job, const FoldCommon& common, bool last, CellSplats& found, SplatBatch& batch,
                Cell& cell, TilePlanes& planes) {
    constexpr std::size_t size = SplatBatch::size;
    std::size_t begin = 0;
    for (; begin + size <= found.count || (last && begin < found.count); begin += size) {
        job.progress.check();
        batch.count = int(std::min(size, found.count - begin));
        batch.x_px = &found.discs.x_px[begin];
        batch.y_px = &found.discs.y_px[begin];
        batch.reach_px = &found.discs.reach_px[begin];
        batch.index = &found.index[begin];
        if constexpr (is_onto_sphere(kOutline)) {
            batch.toward[0] = &found.toward.x[begin];
            batch.toward[1] = &found.toward.y[begin];
            batch.toward[2] = &found.toward.z[begin];
        }
        for (std::size_t i = begin + batch.count; i % lanes != 0; ++i) found.discs.set_nowhere(i);
        fold_batch<Pixels, kOutline>(job, common, batch, cell, planes);
        if (cell.open == 0) return;
    }
    found.keep_from(std::min(begin, found.count));
}

template <class Pixels, Outline kOutline>
void fold_cells(const FoldJob& job, TilePlanes& planes) {
    constexpr std::size_t step = 1024;  // splats looked at before some are folded, while in cache
    static_assert(step % lanes == 0);
    constexpr std::size_t most_kept = 1 << 20;  // discs that a thread keeps for its next tile
    static thread_local const std::unique_ptr<FoldScratch> scratch = std::make_unique<FoldScratch>();
    const FoldCommon common = common_of(job);
    std::fill_n(scratch->batch.linear_in_distance, SplatBatch::size,
                common.footprints && common.footprints->linear_in_distance);
    find_discs(job, scratch->discs);
    CellSplats& found = scratch->found;
    found.resize(step + SplatBatch::size + lanes);
    constexpr bool sphere = is_onto_sphere(kOutline);
    if constexpr (sphere) {
        const float focal_px = job.settings.lens.focal_px;
        scratch->batch.per_square = 1.0f / (4.0f * focal_px * focal_px);
        find_directions(job.settings.lens, scratch->discs, job.splats.size(), scratch->toward);
        found.toward.resize(step + SplatBatch::size + lanes);
    } else {
        found.toward = {};
    }
    Cap caps[SplatBatch::blocks];
    for (int n = 0; n < planes.cell_columns * planes.cell_rows; ++n) {
        const int column = n % planes.cell_columns, row = n / planes.cell_columns;
        Cell cell{std::size_t(n * TilePlanes::cell_pixels), float(planes.x0 + column * TilePlanes::cell_px),
                  float(planes.y0 + row * TilePlanes::cell_px), used_blocks(planes, column, row), caps};
        // Of the columns in use: of two places of a splat the nearer one is the one whose
        // square surely touches.
        const int used_px = std::min(TilePlanes::cell_px, planes.width - column * TilePlanes::cell_px);
        const float middle_px = cell.x0_px + 0.5f * float(used_px);
        found.count = 0;
        Cap whole;
        if constexpr (sphere) {
            whole = cap_of(planes, cell.first_pixel, TilePlanes::cell_pixels);
            for (std::size_t b = 0; b < SplatBatch::blocks; ++b)
                caps[b] =
                    cap_of(planes, cell.first_pixel + b * TilePlanes::block_pixels, TilePlanes::block_pixels);
        }
        for (std::size_t i = 0; i < job.splats.size() && cell.open != 0; i += step) {
            const std::size_t end = std::min(i + step, job.splats.size());
            if constexpr (sphere)
                find_on_sphere(*scratch, i, end, whole, middle_px, shared::period_px(job.settings.lens),
                               found);
            else
                find_in_cell(scratch->discs, i, end, cell, found);
            fold_found<Pixels, kOutline>(job, common, end == job.splats.size(), found, scratch->batch, cell,
                                         planes);
        }
        if constexpr (Pixels::closes) close_cell<Pixels>(cell, job.settings.stop, planes);
    }
    if (job.splats.size() > most_kept) scratch->discs = {};
}

template <class Pixels>
void fold_pixels(const FoldJob& job, TilePlanes& planes) {
    const bool flat =
        std::ranges::any_of(job.layers, [](const FoldLayer& layer) { return layer.footprints->flat_core; });
    flat ? fold_cells<Pixels, Outline::flat>(job, planes) : fold_cells<Pixels, Outline::soft>(job, planes);
}

template <bool kAovs>
void fold_kind(const FoldJob& job, TilePlanes& planes) {
    const bool holds = std::ranges::any_of(job.layers, [](const FoldLayer& layer) { return layer.holdout; });
    if (job.settings.kind == FoldKind::lighten)
        fold_pixels<LightenPixels<kAovs>>(job, planes);
    else if (holds)
        fold_pixels<GeneralPixels<kAovs, true>>(job, planes);
    else
        fold_pixels<GeneralPixels<kAovs, false>>(job, planes);
}

/// With splats that are not round, or not on the frame: the general folds alone, which give the bits
/// of the others.
template <Outline kOutline, bool kAovs>
void fold_general(const FoldJob& job, TilePlanes& planes) {
    if (job.settings.kind == FoldKind::lighten)
        fold_cells<LightenPixels<kAovs>, kOutline>(job, planes);
    else
        fold_cells<GeneralPixels<kAovs, true>, kOutline>(job, planes);
}
template <Outline kOutline>
void fold_general(const FoldJob& job, TilePlanes& planes) {
    job.settings.aovs ? fold_general<kOutline, true>(job, planes)
                      : fold_general<kOutline, false>(job, planes);
}

void fold_here(const FoldJob& job, TilePlanes& planes) {
    const bool aovs = job.settings.aovs;
    const bool shaped = !job.shapes.empty();
    if (shared::is_onto_sphere(job.settings.lens))
        shaped ? fold_general<Outline::sphere_shaped>(job, planes)
               : fold_general<Outline::sphere>(job, planes);
    else if (shaped)
        fold_general<Outline::shaped>(job, planes);
    else if (job.settings.kind == FoldKind::over)
        fold_pixels<OverPixels>(job, planes);
    else if (job.settings.kind == FoldKind::add)
        fold_pixels<AddPixels>(job, planes);
    else
        aovs ? fold_kind<true>(job, planes) : fold_kind<false>(job, planes);
}

}  // namespace astrosplat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(fold_here);

void fold(const FoldJob& job, TilePlanes& planes) {
    if (shared::is_onto_sphere(job.settings.lens)) set_directions(job.settings.lens, planes);
    HWY_DYNAMIC_DISPATCH(fold_here)(job, planes);
}

void TilePlanes::reset(const Region& tile, const FoldSettings& settings, std::size_t layer_count) {
    x0 = tile.x;
    y0 = tile.y;
    width = int(tile.width);
    height = int(tile.height);
    cell_columns = (width + cell_px - 1) / cell_px;
    cell_rows = (height + cell_px - 1) / cell_px;
    const auto size = std::size_t(cell_columns * cell_rows * cell_pixels);
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
