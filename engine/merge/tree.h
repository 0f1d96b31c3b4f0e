// A tree over the positions of a set, so that a few splats can stand for many (merge/README.md), and what the
// splats below each of its nodes add up to after a look. In: SplatSet, then its shaded splats. Out: its rows
// along a Morton curve and the nodes over them; MergedSplats, of which any cut (cut.h) has all the light.
#pragma once

#include <glm/vec3.hpp>

#include "core/buffer.h"
#include "core/progress.h"
#include "splats/shaded_splats.h"
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

/// Sums over the splats below a node; a splat counts by its cover, alpha * radius^2. Layer space. All 0 where
/// the look kept none.
struct NodeSums {
    float cover = 0.0f;     // sum of alpha * radius^2, square scene units
    float squares = 0.0f;   // sum of its square: cover^2 / squares is how many equal splats these are like
    glm::vec3 light{0.0f};  // sum of cover * colour
    glm::vec3 centre{0.0f};
    glm::vec3 spread{0.0f};  // second moments of the centres, xx, yy, zz, square scene units
    glm::vec3 skew{0.0f};    // yz, zx, xy
    float own = 0.0f;        // mean square radius of the splats themselves
    float bound = 0.0f;      // no splat reaches farther from the centre, scene units
};
static_assert(sizeof(NodeSums) == 64);

/// A set, or a sample of one, with its tree.
struct MergeSource {
    std::shared_ptr<const SplatSet> set;
    std::shared_ptr<const MergeTree> tree;
    float weight = 1.0f;  // so many splats does each one stand for
    bool operator==(const MergeSource&) const = default;
};

/// A layer's splats, one by one and merged.
struct MergedSplats {
    std::shared_ptr<const MergeTree> tree;
    Buffer<NodeSums> sums;  // of each node
    ShadedSplats splats;
    Buffer<std::int64_t> place;  // in `splats`, of each row of the set; below 0: the look dropped it
    float weight = 1.0f;         // of the source; those of a sample are never shown one by one
};

/// `splats` are those of the source's set after a look. The same bits for any thread count. Throws Cancelled,
/// and InputError when memory does not suffice.
MergedSplats merge_splats(const MergeSource& source, ShadedSplats splats, const Progress& progress = {});

}  // namespace astrosplat
