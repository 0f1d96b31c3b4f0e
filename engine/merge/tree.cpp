// Rows sorted along the curve make every cell of every size a run of them: nodes only need to know where runs
// begin.
#include "merge/tree.h"

#include <algorithm>
#include <bit>

#include "core/memory.h"
#include "core/parallel.h"
#include "splats/row_order.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

constexpr std::int64_t nodes_a_chunk = 1 << 12;

std::int64_t first_from(const Buffer<MortonRow>& rows, std::int64_t first, std::int64_t end,
                        std::uint64_t code) {
    const auto found = std::lower_bound(rows.begin() + first, rows.begin() + end, code,
                                        [](const MortonRow& row, std::uint64_t k) { return row.code < k; });
    return found - rows.begin();
}

/// The first row with the highest bit in which codes of the node differ; its first row where they are all
/// equal.
std::int64_t middle_of(const Buffer<MortonRow>& rows, const MergeNode& node) {
    const std::uint64_t low = rows[node.first].code, high = rows[node.end - 1].code;
    if (low == high) return node.first;
    const std::uint64_t bit = std::uint64_t{1} << (63 - std::countl_zero(low ^ high));
    return first_from(rows, node.first, node.end, high & ~(bit - 1));
}

/// The level below one that begins at `first` and ends with the nodes.
void add_level(const Buffer<MortonRow>& rows, std::int64_t first, Buffer<MergeNode>& nodes) {
    const auto end = static_cast<std::int64_t>(nodes.size());
    Buffer<std::int64_t> middles(static_cast<std::size_t>(end - first));
    parallel_each(end - first, nodes_a_chunk, [&](std::int64_t i) {
        const MergeNode& node = nodes[first + i];
        const bool small = node.end - node.first <= MergeTree::leaf_rows;
        middles[i] = small ? node.first : middle_of(rows, node);
    });
    for (std::int64_t i = first; i < end; ++i) {
        const MergeNode node = nodes[i];
        const std::int64_t middle = middles[i - first];
        if (middle == node.first) continue;
        nodes[i].children = static_cast<std::int64_t>(nodes.size());
        nodes.push_back({node.first, middle, 0});
        nodes.push_back({middle, node.end, 0});
    }
}

}  // namespace

std::int64_t MergeTree::bytes_for(std::int64_t row_count) {
    // Nodes of a lattice have from a half to all of the rows that they may have.
    const std::int64_t node_count = 2 * (2 * row_count / leaf_rows + 1);
    return row_count * static_cast<std::int64_t>(sizeof(std::int64_t)) +
           node_count * static_cast<std::int64_t>(sizeof(MergeNode));
}

MergeTree build_merge_tree(const SplatSet& set, const Progress& progress) {
    MergeTree tree;
    if (set.size() == 0) return tree;
    claim_memory(MergeTree::bytes_for(set.size()) + set.size() * static_cast<std::int64_t>(sizeof(MortonRow)),
                 "the tree of a preview");
    const Buffer<MortonRow> sorted = morton_order(set, progress);
    const std::int64_t emitting = first_from(sorted, 0, set.size(), morton_absorbs);
    if (emitting > 0) tree.nodes.push_back({0, emitting, 0});
    if (emitting < set.size()) tree.nodes.push_back({emitting, set.size(), 0});
    for (std::int64_t first = 0; first < static_cast<std::int64_t>(tree.nodes.size());
         first = tree.levels.back()) {
        if (tree.levels.empty()) tree.levels.push_back(0);
        progress.check();
        tree.levels.push_back(static_cast<std::int64_t>(tree.nodes.size()));
        add_level(sorted, first, tree.nodes);
    }
    tree.rows.resize(sorted.size());
    parallel_each(sorted.size(), 1 << 16, [&](std::size_t i) { tree.rows[i] = sorted[i].row; });
    return tree;
}

SplatSet sample_tree(const MergeTree& tree, const SplatSet& set, std::int64_t count) {
    Buffer<std::int64_t> rows(static_cast<std::size_t>(std::min(count, set.size())));
    const auto sampled = static_cast<std::int64_t>(rows.size());
    for (std::int64_t i = 0; i < sampled; ++i) rows[i] = tree.rows[sampled_row(set.size(), sampled, i)];
    std::sort(rows.begin(), rows.end());
    return take_rows(set, rows);
}

}  // namespace astrosplat
