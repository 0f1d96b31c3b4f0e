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
    std::int64_t size() const { return end - first; }
};

/// Cells are cubes halved along x, y and z in turn. Splats that absorb (SplatSetFacts::absorbs), stars of
/// pictures and others are never below one node: they have a root each.
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

/// A stratified sample of the set that the tree is of: at most `count` rows, spread evenly over space, in the
/// tree's order.
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
    float weight = 1.0f;                                          // so many splats does each one stand for
    std::shared_ptr<const std::vector<float>> weights = nullptr;  // of each row; null: `weight`
    bool operator==(const MergeSource&) const = default;
};

/// A sample of at most `count` splats of a set that has radii: the more light of its own one has, the
/// likelier it is taken, and the fewer it stands for. Where bodies have large splats among small ones, every
/// n-th of them would be blotches. Without a tree.
MergeSource sample_light(const SplatSet& set, std::int64_t count);

/// A layer's splats, one by one and merged.
struct MergedSplats {
    std::shared_ptr<const MergeTree> tree;
    Buffer<NodeSums> sums;  // of each node
    ShadedSplats splats;
    Buffer<std::int64_t> place;  // in `splats`, of each row of the set; below 0: the look dropped it
    float weight = 1.0f;         // of the source; those of a sample are never shown one by one
    std::shared_ptr<const std::vector<float>> weights;  // likewise
};

/// `splats` are those of the source's set after a look. The same bits for any thread count. Throws Cancelled,
/// and InputError when memory does not suffice.
MergedSplats merge_splats(const MergeSource& source, ShadedSplats splats, const Progress& progress = {});

/// What another look makes of merged splats, by a sample of their rows: the same cuts show it, long before
/// there are sums of all. Light is in the same places, as much as it became in the rows around.
class Relight {
  public:
    /// Factors of the sums of a run of rows, and of each of its splats.
    struct Factors {
        float cover = 1.0f, squares = 1.0f, own = 1.0f;
        glm::vec3 light{1.0f};
    };

    /// `sample`: of sample_tree(), of the tree of `merged`; `splats`: it under the other look. `last`: of the
    /// same two and a look before, which saves half of the time; may be null.
    Relight(const MergedSplats& merged, const SplatSet& sample, const ShadedSplats& splats,
            const Relight* last = nullptr);

    /// Of a run of the tree's rows, by the nearest few of the sample.
    Factors of(std::int64_t first, std::int64_t end) const;
    /// False where splats shine that did not: merged ones do not know where.
    bool is_true() const { return is_true_; }
    /// The share of the rows that the other look keeps, 0..1.
    double kept() const { return kept_; }

  private:
    struct Sums {
        double cover = 0.0, squares = 0.0, own = 0.0;
        glm::dvec3 light{0.0};
        void add(const ShadedSplats& splats, std::int64_t i);
        Sums plus(const Sums& other, double times = 1.0) const;
    };

    /// Over the sampled rows before each, and over all. add(i, sums) adds a row's.
    template <class Add>
    static Buffer<Sums> running_sums(std::int64_t count, const Add& add);

    std::int64_t rows_ = 0;                       // of the tree
    std::shared_ptr<const Buffer<Sums>> before_;  // under the look of the sums
    Buffer<Sums> now_;
    bool is_true_ = true;
    double kept_ = 1.0;
};

}  // namespace astrosplat
