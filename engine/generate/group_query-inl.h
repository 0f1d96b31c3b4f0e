// Sixteen positions against the candidates that their block chose. In: candidates with bounds. Out: the
// closest points, in double. Included once per instruction set.
#if defined(ASTROSPLAT_SPLATS_GROUP_QUERY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_SPLATS_GROUP_QUERY_INL_H
#undef ASTROSPLAT_SPLATS_GROUP_QUERY_INL_H
#else
#define ASTROSPLAT_SPLATS_GROUP_QUERY_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "generate/block_kernel.h"
#include "generate/closest_lanes-inl.h"
#include "generate/survey-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// A block's positions in the candidates' coordinates.
struct BlockPositions {
    alignas(64) float x[block_positions], y[block_positions], z[block_positions], limit[block_positions];

    LocalPositions part(std::size_t first, std::size_t count) const {
        return {x + first, y + first, z + first, limit + first, count};
    }
};

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

    /// Instead of measure_first, and less: limits from the middle of a triangle's disc, which lies on it.
    void expect(const TriangleBound& near) {
        const Floats d;
        const auto farthest = hn::Set(d, static_cast<float>(m_.max_distance));
        auto widest = hn::Zero(d);
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto x = hn::Sub(hn::Load(d, positions_.x + i), hn::Set(d, near.center.x)),
                       y = hn::Sub(hn::Load(d, positions_.y + i), hn::Set(d, near.center.y)),
                       z = hn::Sub(hn::Load(d, positions_.z + i), hn::Set(d, near.center.z));
            widest = hn::Max(widest, set_limit(d, i, hn::Min(hn::Sqrt(dot3(x, y, z, x, y, z)), farthest)));
        }
        widest_ = hn::GetLane(hn::MaxOfLanes(d, widest));
    }

    /// Measures the chosen candidates that matter.
    void measure_chosen() {
        const PositionsBox box = box_around(positions_, m_.slack);
        const std::size_t nearest = nearest_candidate(c_, box.middle);
        if (c_.slot[nearest] != first_) measure_first(c_.slot[nearest]);
        View view(positions_, box, c_.bound(nearest), widest_, m_.slack);
        rows_.count = 0;
        std::fill_n(lowest_, group, std::numeric_limits<float>::infinity());
        std::fill_n(lowest_row_, group, 0u);
        survey(view);
        bound(view, 0);
        measure_lowest();
        view.update_room(widest_);
        const std::size_t over = rows_.count;
        add_beside(view);
        bound(view, over);
        measure_rest();
    }

    /// Measures the first triangles of a cluster.
    void measure_all(const TriangleCluster& cluster, std::size_t count) {
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
        for (std::size_t i = 0; i < group; i += hn::Lanes(Doubles()))
            any |= offer(lanes, best_, first_place_ + i);
        return any;
    }

    // For positions from place i on, as ClosestPointIndex's queries widen their radius. Returns the roots.
    template <class Tag>
    HWY_INLINE hn::Vec<Tag> set_limit(Tag d, std::size_t i, hn::Vec<Tag> distance) {
        const auto limit = hn::Add(hn::Mul(distance, hn::Set(d, 1.00001f)), hn::Set(d, m_.slack));
        hn::StoreU(hn::Mul(limit, limit), d, limit_ + i);
        return limit;
    }

    void update_limits() {
        const Doubles d;
        const hn::Rebind<float, Doubles> df;
        auto widest = hn::Zero(df);
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto distance = hn::DemoteTo(df, hn::Sqrt(hn::Load(d, best_.squared + first_place_ + i)));
            widest = hn::Max(widest, set_limit(df, i, distance));
        }
        widest_ = hn::GetLane(hn::MaxOfLanes(df, widest));
    }

    // Of the candidates that matter, those over which the group lies become rows. The others, beside it, wait
    // until the limits are narrower.
    void survey(const View& view) {
        const Many d;
        const ManyNumbers du;
        auto place = counting(du);
        notes_.count = 0;
        for (std::size_t i = 0; i < c_.count; i += hn::Lanes(d)) {
            const View::Note n = view.note(bounds_of(c_, i));
            const auto matter = hn::And(view.matter(n.need, n.away), hn::FirstN(d, c_.count - i));
            const auto beside = hn::And(matter, hn::Gt(n.gap, hn::Zero(d)));
            add_rows(place, hn::AndNot(beside, matter));
            append(du, place, hn::RebindMask(du, beside), &notes_.place[notes_.count]);
            append(d, n.need, beside, &notes_.need[notes_.count]);
            append(d, n.away, beside, &notes_.away[notes_.count]);
            notes_.count += hn::CountTrue(d, beside);
            place = hn::Add(place, hn::Set(du, static_cast<std::uint32_t>(hn::Lanes(du))));
        }
    }

    // Of the candidates beside the group, those that still matter.
    void add_beside(const View& view) {
        const Many d;
        for (std::size_t i = 0; i < notes_.count; i += hn::Lanes(d)) {
            const auto matter = view.matter(hn::LoadU(d, &notes_.need[i]), hn::LoadU(d, &notes_.away[i]));
            add_rows(hn::LoadU(ManyNumbers(), &notes_.place[i]),
                     hn::And(matter, hn::FirstN(d, notes_.count - i)));
        }
    }

    HWY_INLINE void add_rows(hn::Vec<ManyNumbers> places, hn::Mask<Many> taken) {
        const ManyNumbers du;
        append(du, places, hn::RebindMask(du, taken), &rows_.place[rows_.count]);
        rows_.count += hn::CountTrue(Many(), taken);
    }

    void bound(const View& view, std::size_t first_row) {
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

    // Otherwise the candidate's bound is a ball. (Its normal's zeros are +0; three comparisons of floats cost
    // a fourth of bound_of.)
    bool has_plane(std::size_t place) const {
        const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
        return (bits(c_.normal_x[place]) | bits(c_.normal_y[place]) | bits(c_.normal_z[place])) != 0;
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
    float widest_ = 0.0f;                       // largest root of a limit
    std::uint32_t first_ = ClosestPoint::none;  // the triangle that was measured first
    alignas(64) float lowest_[group];
    alignas(64) std::uint32_t lowest_row_[group];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#endif  // toggle
