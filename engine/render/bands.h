// A band of the frame: its splats are scattered into tiles, and these are folded. Splats that would take more
// memory than there may be come in slabs of depth, near to far. In: a job and a band. Out: the band's pixels
// in the frame.
#pragma once

#include <cstdint>

#include "render/frame.h"
#include "render/frame_job.h"
#include "render/scatter.h"
#include "render/splat_sorter.h"

namespace astrosplat {

/// Of a record of the tile being folded, beside itself: its places in the order, and its disc.
constexpr std::int64_t fold_bytes_per_record = SplatSorter::bytes_per_record + 6 * sizeof(float);

/// Bytes of all records of the frame with what folding them takes, without the memory that no record uses.
std::int64_t scattered_bytes(const FrameJob& job, RenderCache::State& cache);

/// `before` of the frame's share is done already. Throws InputError where what lies at one distance takes
/// more than the limit.
void render_band(const FrameJob& job, const TileGrid& grid, std::int64_t records, double before,
                 RenderCache::State& cache, RenderedFrame& frame);

}  // namespace astrosplat
