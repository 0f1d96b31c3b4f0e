// A frame in slabs of depth, for splats that are not all in memory: which blocks show, how near and far their
// splats are, and where to cut so that a slab's records fit. In: projections and a sample of the splats. Out:
// ranges of depth. Where the cuts are changes no pixel, for the fold goes on from slab to slab.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "render/project.h"

namespace astrosplat {

/// Splats by ScreenSplat::depth, from first to last, both included.
struct DepthRange {
    std::uint32_t first = 0, last = 0xffffffffu;

    bool is_all() const { return first == 0 && last == 0xffffffffu; }
    bool holds(std::uint32_t depth) const { return depth >= first && depth <= last; }
    bool meets(const DepthRange& other) const { return first <= other.last && other.first <= last; }
};

/// A block of a layer that may show, and the depths at which its splats and their children lie.
struct VisibleBlock {
    std::size_t layer, block;
    DepthRange depths;
};

/// Of all layers that come by the block, in the files' order. None that leaves a record in `rect` is missing.
std::vector<VisibleBlock> visible_blocks(std::span<const LayerProjection> layers, const ScreenRect& rect);

/// Records that the splats near a depth will leave.
struct DepthShare {
    std::uint32_t depth;
    double records;
};

/// A sample of the splats by depth.
struct DepthSample {
    std::vector<DepthShare> shares;  // near to far

    double records() const;
    /// Cuts that leave each slab no more than so many records, as far as the sample can tell; one range where
    /// all fit. Near to far, together all depths from `first` on.
    std::vector<DepthRange> cut(double most_records, std::uint32_t first) const;
    /// The range in two of about equal records. first < last.
    std::pair<DepthRange, DepthRange> halve(const DepthRange& range) const;
};

}  // namespace astrosplat
