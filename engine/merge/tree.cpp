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
    const std::int64_t stars = first_from(sorted, emitting, set.size(), morton_stars);
    if (emitting < stars) tree.nodes.push_back({emitting, stars, 0});
    if (stars < set.size()) tree.nodes.push_back({stars, set.size(), 0});
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
    return take_rows(set, rows);
}

MergeSource sample_light(const SplatSet& set, std::int64_t count) {
    constexpr float dark = 0.1f;  // light that those without any count as having
    const auto light_of = [&](std::int64_t i) {
        const glm::vec3& c = set.color[i];
        return double(set.alpha[i] * set.radius[i] * set.radius[i] *
                      (dark + std::fabs(std::max({c.x, c.y, c.z}))));
    };
    double all = 0.0;
    for (std::int64_t i = 0; i < set.size(); ++i) all += light_of(i);
    const double each = all / double(std::max<std::int64_t>(1, count));
    Buffer<std::int64_t> rows;
    std::vector<float> weights;
    // One in each share of the light, at another place of it each time (golden ratio): rows lie in lattices
    // of texels, with which even steps would beat as stripes.
    constexpr double golden = 0.6180339887498949;
    double passed = 0.0, next = 0.5 * each;
    std::int64_t taken = 0;
    for (std::int64_t i = 0; i < set.size(); ++i) {
        const double light = light_of(i);
        passed += std::min(light, each);
        if (passed < next) continue;
        const double turn = double(++taken) * golden;
        next = (double(taken) + turn - std::floor(turn)) * each;
        rows.push_back(i);
        weights.push_back(float(std::max(1.0, each / light)));
    }
    MergeSource sample;
    sample.set = std::make_shared<const SplatSet>(take_rows(set, rows));
    sample.weight = float(double(set.size()) / double(std::max<std::size_t>(1, rows.size())));
    sample.weights = std::make_shared<const std::vector<float>>(std::move(weights));
    return sample;
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

/// Of a place among the tree's rows.
double weight_of(const MergedSplats& merged, std::int64_t r) {
    return double(merged.weights ? (*merged.weights)[std::size_t(merged.tree->rows[r])] : merged.weight);
}

NodeSums sums_of_leaf(const MergedSplats& merged, const MergeNode& node) {
    const ShadedSplats& splats = merged.splats;
    const auto each = [&](const auto& visit) {
        for (std::int64_t r = node.first; r < node.end; ++r) {
            const std::int64_t i = merged.place[merged.tree->rows[r]];
            if (i >= 0) visit(i, cover_of(splats, i), weight_of(merged, r));
        }
    };
    double cover = 0.0, squares = 0.0;
    glm::dvec3 light(0.0), centre(0.0);
    each([&](std::int64_t i, double c, double weight) {
        squares += weight * c * c;
        c *= weight;
        cover += c;
        light += c * glm::dvec3(splats.color[i]);
        centre += c * glm::dvec3(splats.position[i]);
    });
    NodeSums sums;
    if (!(cover > 0.0)) return sums;
    Adder adder(centre / cover);
    each([&](std::int64_t i, double c, double weight) {
        const double radius = splats.radius[i];
        if (c > 0.0)
            adder.add(weight * c, splats.position[i], glm::dvec3(0.0), glm::dvec3(0.0), radius * radius,
                      radius);
    });
    sums.cover = float(cover);
    sums.squares = float(squares);
    sums.light = glm::vec3(light);
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
    merged.weights = source.weights;
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

namespace {

constexpr std::int64_t least_sampled = 8;  // rows that factors are of

float ratio(double now, double before, double otherwise) {
    return static_cast<float>(before > 0.0 ? now / before : otherwise);
}

}  // namespace

void Relight::Sums::add(const ShadedSplats& splats, std::int64_t i) {
    const double c = cover_of(splats, i), radius = splats.radius[i];
    cover += c;
    squares += c * c;
    own += c * radius * radius;
    light += c * glm::dvec3(splats.color[i]);
}

Relight::Sums Relight::Sums::plus(const Sums& other, double times) const {
    return {cover + times * other.cover, squares + times * other.squares, own + times * other.own,
            light + times * other.light};
}

/// In blocks, whose sums are then added to: of rows without light the difference is exactly 0, across blocks,
/// too, since the sum before a block is worked out as that at the end of the one before.
template <class Add>
Buffer<Relight::Sums> Relight::running_sums(std::int64_t count, const Add& add) {
    constexpr std::int64_t block = 4096;  // rows
    Buffer<Sums> running(std::size_t(count) + 1);
    std::vector<Sums> before(std::size_t(count / block) + 2);
    parallel_chunks(count + 1, block, [&](std::int64_t begin, std::int64_t end, int) {
        Sums sums;
        for (std::int64_t i = begin; i < end; ++i) {
            running[i] = sums;
            if (i < count) add(i, sums);
        }
        before[std::size_t(begin / block) + 1] = sums;
    });
    for (std::size_t b = 1; b < before.size(); ++b) before[b] = before[b - 1].plus(before[b]);
    parallel_each(count + 1, block,
                  [&](std::int64_t i) { running[i] = before[std::size_t(i / block)].plus(running[i]); });
    return running;
}

Relight::Relight(const MergedSplats& merged, const SplatSet& sample, const ShadedSplats& splats,
                 const Relight* last)
    : rows_(std::ssize(merged.tree->rows)) {
    const std::int64_t count = sample.size();
    const Buffer<std::int64_t> places = places_of_rows(sample, splats);
    if (last) before_ = last->before_;
    if (!before_)
        before_ = std::make_shared<const Buffer<Sums>>(running_sums(count, [&](std::int64_t i, Sums& sums) {
            const std::int64_t was = merged.place[merged.tree->rows[sampled_row(rows_, count, i)]];
            if (was >= 0) sums.add(merged.splats, was);
        }));
    now_ = running_sums(count, [&](std::int64_t i, Sums& sums) {
        if (places[i] >= 0) sums.add(splats, places[i]);
    });
    const Buffer<Sums>& before = *before_;
    double appeared = 0.0;
    for (std::int64_t first = 0, end = least_sampled; end <= count; first = end, end += least_sampled)
        if (!(before[end].cover > before[first].cover)) appeared += now_[end].cover - now_[first].cover;
    constexpr double most_appeared = 0.02;  // of the cover
    is_true_ = count >= least_sampled && appeared <= most_appeared * now_.back().cover;
    kept_ = double(splats.size()) / double(std::max<std::int64_t>(1, count));
}

Relight::Factors Relight::of(std::int64_t first, std::int64_t end) const {
    const std::int64_t count = std::ssize(now_) - 1;
    const double sampled_per_row = double(count) / double(rows_);
    auto lo = std::int64_t(double(first) * sampled_per_row), hi = std::int64_t(double(end) * sampled_per_row);
    if (hi - lo < least_sampled) {
        lo = std::clamp<std::int64_t>((lo + hi - least_sampled) / 2, 0, count - least_sampled);
        hi = lo + least_sampled;
    }
    const Sums before = (*before_)[hi].plus((*before_)[lo], -1.0), now = now_[hi].plus(now_[lo], -1.0);
    Factors found;
    found.cover = ratio(now.cover, before.cover, 1.0);
    found.squares = ratio(now.squares, before.squares, 1.0);
    found.own = found.cover > 0.0f ? ratio(now.own, before.own, 1.0) / found.cover : 1.0f;
    for (int c = 0; c < 3; ++c) found.light[c] = ratio(now.light[c], before.light[c], found.cover);
    return found;
}

}  // namespace astrosplat
