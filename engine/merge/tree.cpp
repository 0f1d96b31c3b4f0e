// Rows sorted along the curve make every cell of every size a run of them: nodes only need to know where runs
// begin. Sums: leaves first, each from its splats; then every node from its two children, so that the order
// of additions is that of the tree.
#include "merge/tree.h"

#include <glm/geometric.hpp>

#include "core/memory.h"
#include "core/parallel.h"
#include "splats/row_order.h"

namespace astrosplat {
namespace {

constexpr std::int64_t nodes_a_chunk = 1 << 12;

std::int64_t first_from(const Buffer<MortonRow>& rows, std::int64_t first, std::int64_t end,
                        std::uint64_t code) {
    const auto found = std::lower_bound(rows.begin() + first, rows.begin() + end, code,
                                        [](const MortonRow& row, std::uint64_t k) { return row.code < k; });
    return found - rows.begin();
}

/// The first row with the highest bit in which codes of the node differ; its first row where they
/// are all equal.
std::int64_t middle_of(const Buffer<MortonRow>& rows, const MergeNode& node) {
    const std::uint64_t low = rows[node.first].code, high = rows[node.end - 1].code;
    if (low == high) return node.first;
    const std::uint64_t bit = std::uint64_t{1} << (63 - std::countl_zero(low ^ high));
    return first_from(rows, node.first, node.end, high & ~(bit - 1));
}

/// The level below one that begins at `first` and ends with the nodes.
void add_level(const Buffer<MortonRow>& rows, std::int64_t first, Buffer<MergeNode>& nodes) {
    const auto end = std::int64_t(nodes.size());
    Buffer<std::int64_t> middles(std::size_t(end - first));
    parallel_each(end - first, nodes_a_chunk, [&](std::int64_t i) {
        const MergeNode& node = nodes[first + i];
        const bool small = node.end - node.first <= MergeTree::leaf_rows;
        middles[i] = small ? node.first : middle_of(rows, node);
    });
    for (std::int64_t i = first; i < end; ++i) {
        const MergeNode node = nodes[i];
        const std::int64_t middle = middles[i - first];
        if (middle == node.first) continue;
        nodes[i].children = std::int64_t(nodes.size());
        nodes.push_back({node.first, middle, 0});
        nodes.push_back({middle, node.end, 0});
    }
}

}  // namespace

std::int64_t MergeTree::bytes_for(std::int64_t row_count) {
    // Nodes of a lattice have from a half to all of the rows that they may have.
    const std::int64_t node_count = 2 * (2 * row_count / leaf_rows + 1);
    return row_count * std::int64_t(sizeof(std::int64_t)) + node_count * std::int64_t(sizeof(MergeNode));
}

MergeTree build_merge_tree(const SplatSet& set, const Progress& progress) {
    MergeTree tree;
    if (set.size() == 0) return tree;
    claim_memory(MergeTree::bytes_for(set.size()) + set.size() * std::int64_t(sizeof(MortonRow)),
                 "the tree of a preview");
    const Buffer<MortonRow> sorted = morton_order(set, progress);
    const std::int64_t emitting = first_from(sorted, 0, set.size(), morton_absorbs);
    if (emitting > 0) tree.nodes.push_back({0, emitting, 0});
    if (emitting < set.size()) tree.nodes.push_back({emitting, set.size(), 0});
    for (std::int64_t first = 0; first < std::int64_t(tree.nodes.size()); first = tree.levels.back()) {
        if (tree.levels.empty()) tree.levels.push_back(0);
        progress.check();
        tree.levels.push_back(std::int64_t(tree.nodes.size()));
        add_level(sorted, first, tree.nodes);
    }
    tree.rows.resize(sorted.size());
    parallel_each(sorted.size(), 1 << 16, [&](std::size_t i) { tree.rows[i] = sorted[i].row; });
    return tree;
}

SplatSet sample_tree(const MergeTree& tree, const SplatSet& set, std::int64_t count) {
    Buffer<std::int64_t> rows(std::size_t(std::min(count, set.size())));
    const auto sampled = std::int64_t(rows.size());
    for (std::int64_t i = 0; i < sampled; ++i) rows[i] = tree.rows[sampled_row(set.size(), sampled, i)];
    std::sort(rows.begin(), rows.end());
    return take_rows(set, rows);
}

namespace {

constexpr std::int64_t nodes_at_once = 1 << 10;

/// Sums while they are made, about a centre that is known.
class Adder {
  public:
    explicit Adder(const glm::dvec3& centre) : centre_(centre) {}

    /// A part with its own centre and moments about it.
    void add(double cover, const glm::dvec3& centre, const glm::dvec3& spread, const glm::dvec3& skew,
             double own, double bound) {
        const glm::dvec3 d = centre - centre_;
        spread_ += cover * (spread + d * d);
        skew_ += cover * (skew + glm::dvec3(d.y * d.z, d.z * d.x, d.x * d.y));
        own_ += cover * own;
        bound_ = std::max(bound_, glm::length(d) + bound);
    }

    void finish(double cover, NodeSums& sums) const {
        sums.centre = glm::vec3(centre_);
        sums.spread = glm::vec3(spread_ / cover);
        sums.skew = glm::vec3(skew_ / cover);
        sums.own = float(own_ / cover);
        sums.bound = float(bound_ * 1.000001);  // what rounding may take away
    }

  private:
    glm::dvec3 centre_, spread_{0.0}, skew_{0.0};
    double own_ = 0.0, bound_ = 0.0;
};

double cover_of(const ShadedSplats& splats, std::int64_t i) {
    const double radius = splats.radius[i];
    return double(splats.alpha[i]) * radius * radius;
}

NodeSums sums_of_leaf(const MergedSplats& merged, const MergeNode& node) {
    const ShadedSplats& splats = merged.splats;
    const auto each = [&](const auto& visit) {
        for (std::int64_t r = node.first; r < node.end; ++r) {
            const std::int64_t i = merged.place[merged.tree->rows[r]];
            if (i >= 0) visit(i, cover_of(splats, i));
        }
    };
    double cover = 0.0, squares = 0.0;
    glm::dvec3 light(0.0), centre(0.0);
    each([&](std::int64_t i, double c) {
        cover += c;
        squares += c * c;
        light += c * glm::dvec3(splats.color[i]);
        centre += c * glm::dvec3(splats.position[i]);
    });
    NodeSums sums;
    if (!(cover > 0.0)) return sums;
    Adder adder(centre / cover);
    each([&](std::int64_t i, double c) {
        const double radius = splats.radius[i];
        if (c > 0.0)
            adder.add(c, splats.position[i], glm::dvec3(0.0), glm::dvec3(0.0), radius * radius, radius);
    });
    const double weight = merged.weight;
    sums.cover = float(weight * cover);
    sums.squares = float(weight * squares);
    sums.light = glm::vec3(weight * light);
    adder.finish(cover, sums);
    return sums;
}

/// The sums of a + b.
NodeSums add_sums(const NodeSums& a, const NodeSums& b) {
    if (!(a.cover > 0.0f)) return b;
    if (!(b.cover > 0.0f)) return a;
    const double cover = double(a.cover) + double(b.cover);
    NodeSums sums;
    sums.cover = float(cover);
    sums.squares = a.squares + b.squares;
    sums.light = glm::vec3(glm::dvec3(a.light) + glm::dvec3(b.light));
    Adder adder((double(a.cover) * glm::dvec3(a.centre) + double(b.cover) * glm::dvec3(b.centre)) / cover);
    for (const NodeSums* part : {&a, &b})
        adder.add(part->cover, part->centre, part->spread, part->skew, part->own, part->bound);
    adder.finish(cover, sums);
    return sums;
}

/// Of each row of the set its place in `splats`, which are some of its rows in the same order.
Buffer<std::int64_t> places_of_rows(const SplatSet& set, const ShadedSplats& splats) {
    Buffer<std::int64_t> place(set.id.size());
    std::int64_t i = 0;
    for (std::int64_t row = 0; row < set.size(); ++row) {
        const bool kept = i < splats.size() && splats.id[i] == set.id[row];
        place[row] = kept ? i++ : -1;
    }
    return place;
}

}  // namespace

MergedSplats merge_splats(const MergeSource& source, ShadedSplats splats, const Progress& progress) {
    const SplatSet& set = *source.set;
    assert(source.tree->rows.size() == set.id.size());
    MergedSplats merged;
    merged.tree = source.tree;
    merged.weight = source.weight;
    const Buffer<MergeNode>& nodes = merged.tree->nodes;
    claim_memory(std::int64_t(nodes.size() * sizeof(NodeSums) + set.id.size() * sizeof(std::int64_t)),
                 "the merged splats of a preview");
    merged.place = places_of_rows(set, splats);
    merged.splats = std::move(splats);
    merged.sums.resize(nodes.size());
    const std::vector<std::int64_t>& levels = merged.tree->levels;
    for (std::size_t l = levels.size(); l-- > 1;) {
        const std::int64_t first = levels[l - 1];
        parallel_chunks(levels[l] - first, nodes_at_once, [&](std::int64_t begin, std::int64_t end, int) {
            progress.check();
            for (std::int64_t n = first + begin; n < first + end; ++n) {
                const std::int64_t children = nodes[n].children;
                merged.sums[n] = nodes[n].is_leaf()
                                     ? sums_of_leaf(merged, nodes[n])
                                     : add_sums(merged.sums[children], merged.sums[children + 1]);
            }
        });
    }
    return merged;
}

}  // namespace astrosplat
