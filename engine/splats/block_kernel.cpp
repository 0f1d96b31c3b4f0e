// Each group of sixteen positions measures the candidate nearest to its middle. With what that leaves
// possible the block chooses the candidates that can matter to it, and each group does the same with those.
// The ones over which a group lies come first: each position is measured against the one whose bound is
// lowest there. What that leaves of the others is little; it is measured where its bounds ask for it.
#include "splats/block_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splats/block_kernel.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/glsl.h"
#include "splats/closest_lanes-inl.h"
#include "splats/survey-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace astrosplat::glsl;

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "maths.glsl"
#pragma GCC diagnostic pop

// --- positions ---

struct Jitter {
    std::uint32_t seed, purpose;
    double half_range;
};

// As jitter_offset: half_range * (2 uniform - 1), added to the lattice position.
HWY_FLATTEN void add_jitter(const uint* HWY_RESTRICT id_low, const uint* HWY_RESTRICT id_high, Jitter jitter,
                            double* HWY_RESTRICT at) {
    for (std::size_t s = 0; s < block_positions; ++s) {
        const float random = as_uniform(as_hash(jitter.seed, id_low[s], id_high[s], jitter.purpose));
        at[s] = at[s] + jitter.half_range * (2.0 * static_cast<double>(random) - 1.0);
    }
}

void place(const BlockPlaces& places, BlockAnswers& answers) {
    std::array<uint, block_positions> id_low, id_high;
    for (std::size_t k = 0; k < block_cells; ++k) {
        for (std::size_t j = 0; j < block_cells; ++j) {
            for (std::size_t i = 0; i < block_cells; ++i) {
                const std::size_t s = block_slot(i, j, k);
                const std::uint64_t id = places.first_id + i + j * places.row_ids + k * places.slice_ids;
                id_low[s] = static_cast<uint>(id);
                id_high[s] = static_cast<uint>(id >> 32);
                answers.x[s] = places.x[i];
                answers.y[s] = places.y[j];
                answers.z[s] = places.z[k];
            }
        }
    }
    const glm::dvec3& range = places.half_range;
    const auto add = [&](std::uint32_t purpose, double half_range, double* at) HWY_ATTR {
        add_jitter(id_low.data(), id_high.data(), {places.seed, purpose, half_range}, at);
    };
    add(PURPOSE_JITTER_X, range.x, answers.x.data());
    add(PURPOSE_JITTER_Y, range.y, answers.y.data());
    add(PURPOSE_JITTER_Z, range.z, answers.z.data());
}

// --- groups ---

/// A block's positions in the candidates' coordinates.
struct BlockPositions {
    alignas(64) float x[block_positions], y[block_positions], z[block_positions], limit[block_positions];

    LocalPositions part(std::size_t first, std::size_t count) const {
        return {x + first, y + first, z + first, limit + first, count};
    }
};

// 0, 1, 2 ..., to pick from.
constexpr auto all_places = [] {
    std::array<std::uint32_t, CandidateList::most + 64> places{};
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = static_cast<std::uint32_t>(i);
    return places;
}();

constexpr std::size_t block_groups = block_positions / group;

constexpr int most_paired = 6;  // positions; more are measured against one triangle together

class GroupQuery {
  public:
    GroupQuery(const BlockMeasure& measure, BlockScratch& scratch, BlockPositions& local,
               const BestAnswers& best, Pairs& pairs, std::size_t first)
        : m_(measure),
          c_(scratch.chosen),
          rows_(scratch.rows),
          notes_(scratch.notes),
          best_(best),
          pairs_(pairs),
          first_place_(first),
          positions_(local.part(first, group)),
          limit_(local.limit + first) {}

    /// Measures a first triangle.
    void measure_first(std::uint32_t slot) {
        first_ = slot;
        measure(slot);
        update_limits();
    }

    /// Measures the chosen candidates that matter.
    void measure_chosen() {
        const PositionsBox box = box_around(positions_, m_.slack);
        const std::size_t nearest = nearest_disc(c_, box.middle);
        if (c_.slot[nearest] != first_) measure_first(c_.slot[nearest]);
        View view(positions_, box, c_.bound(nearest), widest_, m_.slack);
        if (!note(view)) return;
        rows_.count = 0;
        std::fill_n(lowest_, group, std::numeric_limits<float>::infinity());
        std::fill_n(lowest_row_, group, 0u);
        bound(view, Gaps::none);
        measure_lowest();
        view.update_room(widest_);
        bound(view, Gaps::some);
        measure_rest();
    }

    void measure(const TriangleCluster& cluster, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) measure(cluster.slot[i]);
    }

    float widest() const { return widest_; }

  private:
    // True when the triangle is nearest for a position of the group.
    bool measure(std::uint32_t slot) {
        const ClusteredTriangle& triangle = m_.triangles[slot];
        const TriangleShape s = triangle_shape(triangle.corners);
        if (has_no_inside(s)) return offer_thin(s, triangle.number, best_, first_place_);
        bool any = false;
        const ShapeLanes lanes = same_shape(s, triangle.number);
        for (std::size_t i = 0; i < group; i += hn::Lanes(Doubles())) any |= offer(lanes, best_, first_place_ + i);
        return any;
    }

    // As ClosestPointIndex's queries widen their radius.
    void update_limits() {
        const Doubles d;
        const hn::Rebind<float, Doubles> df;
        auto widest = hn::Zero(df);
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto distance = hn::DemoteTo(df, hn::Sqrt(hn::Load(d, best_.squared + first_place_ + i)));
            const auto limit = hn::Add(hn::Mul(distance, hn::Set(df, 1.00001f)), hn::Set(df, m_.slack));
            hn::StoreU(hn::Mul(limit, limit), df, limit_ + i);
            widest = hn::Max(widest, limit);
        }
        widest_ = hn::GetLane(hn::MaxOfLanes(df, widest));
    }

    // About each candidate. False when none matters.
    bool note(const View& view) {
        const Many d;
        bool any = false;
        for (std::size_t i = 0; i < c_.count; i += hn::Lanes(d)) {
            const View::Note n = view.note(bounds_of(c_, i));
            hn::StoreU(n.gap, d, &notes_.gap[i]);
            hn::StoreU(n.need, d, &notes_.need[i]);
            hn::StoreU(n.away, d, &notes_.away[i]);
            any |= !hn::AllFalse(d, hn::And(view.matter(n.need, n.away), hn::FirstN(d, c_.count - i)));
        }
        return any;
    }

    enum class Gaps { none, some };  // the group is over the candidate, or beside it

    // New rows, for the candidates that matter.
    void bound(const View& view, Gaps gaps) {
        const Many d;
        const ManyNumbers du;
        const std::size_t first_row = rows_.count;
        for (std::size_t i = 0; i < c_.count; i += hn::Lanes(d)) {
            const auto matter = hn::And(view.matter(hn::LoadU(d, &notes_.need[i]), hn::LoadU(d, &notes_.away[i])),
                                        hn::FirstN(d, c_.count - i));
            const auto beside = hn::Gt(hn::LoadU(d, &notes_.gap[i]), hn::Zero(d));
            const auto taken = hn::RebindMask(
                du, gaps == Gaps::some ? hn::And(matter, beside) : hn::AndNot(beside, matter));
            append(du, &all_places[i], taken, &rows_.place[rows_.count]);
            rows_.count += hn::CountTrue(du, taken);
        }
        for (std::size_t i = 0; i < group; i += hn::Lanes(Floats())) bound_lanes(view, first_row, i);
    }

    // Rows from first_row on, for one vector of positions, and the lowest of them.
    void bound_lanes(const View& view, std::size_t first_row, std::size_t i) {
        const Floats d;
        const hn::RebindToUnsigned<Floats> du;
        const auto px = hn::Load(d, positions_.x + i), py = hn::Load(d, positions_.y + i),
                   pz = hn::Load(d, positions_.z + i);
        auto lowest = hn::Load(d, lowest_ + i);
        auto lowest_row = hn::Load(du, lowest_row_ + i);
        for (std::size_t row = first_row; row < rows_.count; ++row) {
            const std::size_t place = rows_.place[row];
            const auto bound = bound_of(view, place, hn::Sub(px, hn::Set(d, c_.center_x[place])),
                                        hn::Sub(py, hn::Set(d, c_.center_y[place])),
                                        hn::Sub(pz, hn::Set(d, c_.center_z[place])));
            hn::Store(bound, d, &rows_.bound[row * group + i]);
            const auto lower = hn::RebindMask(du, hn::Lt(bound, lowest));
            lowest = hn::Min(bound, lowest);
            lowest_row = hn::IfThenElse(lower, hn::Set(du, static_cast<std::uint32_t>(row)), lowest_row);
        }
        hn::Store(lowest, d, lowest_ + i);
        hn::Store(lowest_row, du, lowest_row_ + i);
    }

    // Square of at most the distance from a triangle, for positions relative to its disc's middle: the height
    // above its plane, and how far outside one of its edges a position lies.
    HWY_INLINE hn::Vec<Floats> bound_of(const View& view, std::size_t place, hn::Vec<Floats> x,
                                        hn::Vec<Floats> y, hn::Vec<Floats> z) const {
        const Floats d;
        const float normal_x = c_.normal_x[place], normal_y = c_.normal_y[place],
                    normal_z = c_.normal_z[place];
        const auto along = [&](float nx, float ny, float nz) HWY_ATTR {
            return dot3(x, y, z, hn::Set(d, nx), hn::Set(d, ny), hn::Set(d, nz));
        };
        const auto off = hn::Set(d, view.rounding(c_.radius[place]));
        auto height = hn::Abs(along(normal_x, normal_y, normal_z)), outside = hn::Zero(d);
        if (!has_plane(place)) {
            outside = hn::Sub(hn::Sqrt(dot3(x, y, z, x, y, z)), hn::Set(d, c_.radius[place]));
        } else {
            const TriangleEdges& e = m_.triangles[c_.slot[place]].edges;
            const auto beyond = [&](std::size_t k) HWY_ATTR {
                const auto along_z = hn::MulSub(z, hn::Set(d, e.normal_z[k]), hn::Set(d, e.offset[k]));
                return hn::MulAdd(x, hn::Set(d, e.normal_x[k]),
                                  hn::MulAdd(y, hn::Set(d, e.normal_y[k]), along_z));
            };
            outside = hn::Max(hn::Max(beyond(0), beyond(1)), beyond(2));
        }
        height = hn::Max(hn::Sub(height, off), hn::Zero(d));
        outside = hn::Max(hn::Sub(outside, off), hn::Zero(d));
        return hn::MulAdd(height, height, hn::Mul(outside, outside));
    }

    // Otherwise the candidate's bound is a ball.
    bool has_plane(std::size_t place) const {
        return c_.normal_x[place] != 0.0f || c_.normal_y[place] != 0.0f || c_.normal_z[place] != 0.0f;
    }

    std::uint32_t slot(std::size_t row) const { return c_.slot[rows_.place[row]]; }

    // Each position against the row whose bound is lowest there.
    void measure_lowest() {
        if (rows_.count == 0) return;
        std::uint32_t slots[group];
        bool same = true, usable = true;
        for (std::size_t i = 0; i < group; ++i) {
            slots[i] = slot(lowest_row_[i]);
            same = same && slots[i] == slots[0];
            usable = usable && has_plane(rows_.place[lowest_row_[i]]);
        }
        if (same && slots[0] == first_) return;
        if (!same && !usable) return;  // to measure_rest
        if (same) {
            measure(slots[0]);
        } else {
            for (std::size_t i = 0; i < group; i += hn::Lanes(Doubles()))
                offer(shapes_of(m_.triangles, slots + i), best_, first_place_ + i);
        }
        for (std::size_t i = 0; i < group; ++i)
            rows_.bound[lowest_row_[i] * group + i] = std::numeric_limits<float>::infinity();
        update_limits();
    }

    // Each position against the rows that matter to it: several rows at once where few positions care.
    void measure_rest() {
        for (std::size_t row = 0; row < rows_.count; ++row) {
            const unsigned positions = positions_for(row);
            if (positions == 0 || slot(row) == first_) continue;
            if (std::popcount(positions) > most_paired || !has_plane(rows_.place[row])) {
                if (measure(slot(row))) update_limits();
            } else {
                pair(slot(row), positions);
            }
        }
    }

    void pair(std::uint32_t slot, unsigned positions) {
        for (; positions != 0; positions &= positions - 1) {
            const auto place = first_place_ + static_cast<std::size_t>(std::countr_zero(positions));
            pairs_.slot[pairs_.count] = slot;
            pairs_.place[pairs_.count++] = static_cast<std::uint32_t>(place);
            if (pairs_.count == Pairs::most) {
                offer_pairs(m_.triangles, pairs_, best_);
                update_limits();
            }
        }
    }

    // As bits.
    unsigned positions_for(std::size_t row) const {
        const Floats d;
        unsigned positions = 0;
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto bound = hn::Load(d, &rows_.bound[row * group + i]);
            positions |= static_cast<unsigned>(bits_of(d, hn::Le(bound, hn::Load(d, limit_ + i)))) << i;
        }
        return positions;
    }

    const BlockMeasure& m_;
    const CandidateList& c_;
    BoundRows& rows_;
    SurveyNotes& notes_;
    const BestAnswers& best_;
    Pairs& pairs_;  // still to be measured
    std::size_t first_place_;
    LocalPositions positions_;
    float* limit_;
    float widest_ = 0.0f;      // largest root of a limit
    std::uint32_t first_ = 0;  // the triangle that was measured first
    alignas(64) float lowest_[group];
    alignas(64) std::uint32_t lowest_row_[group];
};

// --- the block ---

void to_local(const double* at, double origin, float* local) {
    for (std::size_t i = 0; i < block_positions; ++i) local[i] = static_cast<float>(at[i] - origin);
}

// Bounds of the triangles of cluster i of some, and of the clusters after it where a vector holds more.
HWY_INLINE BoundLanes bounds_of(const TriangleCluster* all, const std::uint32_t* clusters, std::size_t i) {
    const Many d;
    constexpr std::size_t size = TriangleCluster::size;
#if HWY_TARGET <= HWY_AVX3
    const hn::Half<Many> half;
    const TriangleCluster &one = all[clusters[i / size]], &two = all[clusters[i / size + 1]];
    const auto load = [&](const auto& first, const auto& second) HWY_ATTR {
        return hn::Combine(d, hn::LoadU(half, second.data()), hn::LoadU(half, first.data()));
    };
    return {load(one.center_x, two.center_x), load(one.center_y, two.center_y),
            load(one.center_z, two.center_z), load(one.normal_x, two.normal_x),
            load(one.normal_y, two.normal_y), load(one.normal_z, two.normal_z),
            load(one.radius, two.radius)};
#else
    const TriangleCluster& c = all[clusters[i / size]];
    const auto load = [&](const auto& values) HWY_ATTR { return hn::LoadU(d, &values[i % size]); };
    return {load(c.center_x), load(c.center_y), load(c.center_z), load(c.normal_x),
            load(c.normal_y), load(c.normal_z), load(c.radius)};
#endif
}
HWY_INLINE hn::Vec<ManyNumbers> slots_of(const TriangleCluster* all, const std::uint32_t* clusters, std::size_t i) {
    const ManyNumbers d;
    constexpr std::size_t size = TriangleCluster::size;
#if HWY_TARGET <= HWY_AVX3
    const hn::Half<ManyNumbers> half;
    return hn::Combine(d, hn::LoadU(half, all[clusters[i / size + 1]].slot.data()), hn::LoadU(half, all[clusters[i / size]].slot.data()));
#else
    return hn::LoadU(d, &all[clusters[i / size]].slot[i % size]);
#endif
}

template <class D, class V, class M, class A>
HWY_INLINE void append_lanes(D d, V v, M mask, A& to, std::size_t count) {
#if HWY_TARGET <= HWY_AVX3
    hn::StoreU(hn::Compress(v, mask), d, &to[count]);
#else
    alignas(32) hn::TFromD<D> from[hn::MaxLanes(D())];
    hn::Store(v, d, from);
    append(d, from, mask, &to[count]);
#endif
}

// To scratch.chosen, what can matter to the block's positions; false when it does not fit.
bool choose_candidates(const BlockMeasure& m, const BlockSurroundings& around, const View& view,
                       CandidateList& to) {
    const Many d;
    const ManyNumbers du;
    to.count = 0;
    const std::size_t count = around.clusters.size() * TriangleCluster::size;
    std::uint32_t last_two[2] = {around.clusters.back(), around.clusters.back()};
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const bool last = i + hn::Lanes(d) > count;
        const std::uint32_t* clusters = last ? last_two : around.clusters.data();
        const std::size_t at = last ? 0 : i;
        const BoundLanes b = bounds_of(m.clusters, clusters, at);
        const View::Note n = view.note(b);
        const auto taken = hn::And(view.matter(n.need, n.away), hn::FirstN(d, count - i));
        if (hn::AllFalse(d, taken)) continue;
        if (to.count + hn::Lanes(d) > CandidateList::most) return false;
        const auto copy = [&](Lanes values, auto& target) HWY_ATTR { append_lanes(d, values, taken, target, to.count); };
        append_lanes(du, slots_of(m.clusters, clusters, at), hn::RebindMask(du, taken), to.slot, to.count);
        copy(b.center_x, to.center_x), copy(b.center_y, to.center_y), copy(b.center_z, to.center_z);
        copy(b.normal_x, to.normal_x), copy(b.normal_y, to.normal_y), copy(b.normal_z, to.normal_z);
        copy(b.radius, to.radius);
        to.count += hn::CountTrue(d, taken);
    }
    for (std::size_t i = 0; i < to.count; ++i) {  // most will be needed soon
        const auto* triangle = reinterpret_cast<const char*>(&m.triangles[to.slot[i]]);
        __builtin_prefetch(triangle), __builtin_prefetch(triangle + 64);
    }
    return true;
}

std::size_t distinct(const TriangleCluster& cluster) {
    std::size_t count = TriangleCluster::size;
    while (count > 1 && cluster.slot[count - 1] == cluster.slot[count - 2]) --count;
    return count;
}

bool measure_all(const BlockMeasure& measure, const BlockSurroundings& around, BlockScratch& scratch,
                 BlockAnswers& answers) {
    constexpr std::size_t few = 3;  // candidates that are measured in less time than bounded
    const TriangleCluster& first = measure.clusters[around.clusters[0]];
    const bool all = around.clusters.size() == 1 && distinct(first) <= few;
    BlockPositions local;
    if (!all) {
        to_local(answers.x.data(), measure.origin.x, local.x);
        to_local(answers.y.data(), measure.origin.y, local.y);
        to_local(answers.z.data(), measure.origin.z, local.z);
    }
    Pairs pairs;
    alignas(64) double triangles[block_positions];
    const BestAnswers best{answers.x.data(), answers.y.data(), answers.z.data(), answers.distance_squared.data(), triangles, answers.v.data(), answers.w.data()};
    answers.distance_squared.fill(measure.max_distance * measure.max_distance);
    std::fill_n(triangles, block_positions, static_cast<double>(ClosestPoint::none));
    answers.v.fill(0.0);
    answers.w.fill(0.0);
    const auto query = [&](std::size_t g)
                           HWY_ATTR { return GroupQuery(measure, scratch, local, best, pairs, g * group); };
    std::array<GroupQuery, block_groups> groups{query(0), query(1), query(2), query(3)};
    float widest = 0.0f;
    for (GroupQuery& g : groups) {
        if (all)
            g.measure(first, distinct(first));
        else
            g.measure_first(around.near_slot);
        widest = std::max(widest, g.widest());
    }
    if (!all) {
        const LocalPositions positions = local.part(0, block_positions);
        const std::uint32_t size = TriangleCluster::size;
        const TriangleBound reference = measure.clusters[around.near_slot / size].bound(around.near_slot % size);
        const View view(positions, box_around(positions, measure.slack), reference, widest, measure.slack);
        if (!choose_candidates(measure, around, view, scratch.chosen)) return false;
        if (scratch.chosen.count > 0)
            for (GroupQuery& g : groups) g.measure_chosen();
    }
    if (pairs.count > 0) offer_pairs(measure.triangles, pairs, best);
    for (std::size_t i = 0; i < block_positions; ++i)
        answers.triangle[i] = static_cast<std::uint32_t>(triangles[i]);
    return true;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(place);
HWY_EXPORT(measure_all);

void place_block(const BlockPlaces& places, BlockAnswers& answers) {
    HWY_DYNAMIC_DISPATCH(place)(places, answers);
}

bool measure_block(const BlockMeasure& measure, const BlockSurroundings& around, BlockScratch& scratch,
                   BlockAnswers& answers) {
    return HWY_DYNAMIC_DISPATCH(measure_all)(measure, around, scratch, answers);
}

}  // namespace astrosplat
#endif
