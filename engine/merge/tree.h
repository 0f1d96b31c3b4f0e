// A tree over the positions of a set, so that a few dots can stand for many (merge/README.md). In: SplatSet.
// Out: its rows along a Morton curve, and the nodes over them. Looks, cameras and blends come later.
#pragma once

#include <cstdint>
#include <vector>

#include "core/buffer.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// A run of rows that lie in one cell of space.
struct MergeNode {
    std::int64_t first = 0, end = 0;  // in MergeTree::rows
    std::int64_t children = 0;        // the first of two, one after the other; 0: a leaf

    bool is_leaf() const { return children == 0; }
};

/// Cells are cubes halved along x, y and z in turn. Splats that absorb (SplatSetFacts::absorbs) and others
/// are never below one node: they have a root each.
struct MergeTree {
    static constexpr std::int64_t leaf_rows = 16;  // at most, but for splats at one place

    Buffer<std::int64_t> rows;
    /// Level by level, the roots first: what a cut looks at lies together.
    Buffer<MergeNode> nodes;
    std::vector<std::int64_t> levels;  // where each begins, and the end of the last
    std::int64_t root_count() const { return levels.size() > 1 ? levels[1] : 0; }

    /// Bytes of a tree of so many rows, at most.
    static std::int64_t bytes_for(std::int64_t row_count);
};

/// The same for any thread count. Throws Cancelled, and InputError when memory does not suffice.
MergeTree build_merge_tree(const SplatSet& set, const Progress& progress = {});

/// A stratified sample of the set that the tree is of: at most `count` rows, spread evenly over space, in
/// order of the set's rows.
SplatSet sample_tree(const MergeTree& tree, const SplatSet& set, std::int64_t count);

}  // namespace astrosplat
