// Leaves first, each from its splats; then every node from its two children, so that the order of additions
// is that of the tree.
#include "merge/sums.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "core/memory.h"
#include "core/parallel.h"

namespace astrosplat {
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
        sums.own = static_cast<float>(own_ / cover);
        sums.bound = static_cast<float>(bound_ * 1.000001);  // what rounding may take away
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
    sums.cover = static_cast<float>(weight * cover);
    sums.squares = static_cast<float>(weight * squares);
    sums.light = glm::vec3(weight * light);
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

NodeSums add_sums(const NodeSums& a, const NodeSums& b) {
    if (!(a.cover > 0.0f)) return b;
    if (!(b.cover > 0.0f)) return a;
    const double cover = double(a.cover) + double(b.cover);
    NodeSums sums;
    sums.cover = static_cast<float>(cover);
    sums.squares = a.squares + b.squares;
    sums.light = glm::vec3(glm::dvec3(a.light) + glm::dvec3(b.light));
    Adder adder((double(a.cover) * glm::dvec3(a.centre) + double(b.cover) * glm::dvec3(b.centre)) / cover);
    for (const NodeSums* part : {&a, &b})
        adder.add(part->cover, part->centre, part->spread, part->skew, part->own, part->bound);
    adder.finish(cover, sums);
    return sums;
}

MergedSplats merge_splats(const MergeSource& source, ShadedSplats splats, const Progress& progress) {
    const SplatSet& set = *source.set;
    assert(source.tree->rows.size() == set.id.size());
    MergedSplats merged;
    merged.tree = source.tree;
    merged.weight = source.weight;
    const Buffer<MergeNode>& nodes = merged.tree->nodes;
    claim_memory(
        static_cast<std::int64_t>(nodes.size() * sizeof(NodeSums) + set.id.size() * sizeof(std::int64_t)),
        "the merged dots of a preview");
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
