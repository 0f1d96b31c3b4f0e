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

class GroupQuery {
  public:
    GroupQuery(const BlockMeasure& measure, BlockScratch& scratch, BlockPositions& local,
               BlockAnswers& answers, std::size_t first)
        : m_(measure),
          c_(scratch.chosen),
          rows_(scratch.rows),
          notes_(scratch.notes),
          answers_(answers),
          first_position_(first),
          positions_(local.part(first, group)),
          limit_(local.limit + first) {
        g_.x = &answers.x[first], g_.y = &answers.y[first], g_.z = &answers.z[first];
        std::fill_n(g_.squared, group, m_.max_distance * m_.max_distance);
        std::fill_n(g_.triangle, group, static_cast<double>(ClosestPoint::none));
        std::fill_n(g_.v, group, 0.0);
        std::fill_n(g_.w, group, 0.0);
    }

    /// Measures the candidate that is nearest to the group's middle. False when none matters.
    bool measure_nearest(const CandidateList& candidates) {
        update_limits();
        box_ = box_around(positions_, m_.slack);
        const std::size_t nearest = Survey(candidates, notes_, m_.slack).nearest(box_, widest_);
        if (nearest == Survey::nothing) {
            std::fill_n(limit_, group, -1.0f);  // the block need not care
            return false;
        }
        first_ = candidates.slot[nearest];
        reference_ = candidates.bound(nearest);
        measure(first_);
        update_limits();
        return true;
    }

    /// Measures what is left of the chosen candidates.
    void measure_chosen() {
        rows_.count = 0;
        std::fill_n(lowest_, group, std::numeric_limits<float>::infinity());
        std::fill_n(lowest_row_, group, 0u);
        Survey survey(c_, notes_, m_.slack);
        survey.note(positions_, box_, reference_, widest_);
        bound(survey, Survey::Gaps::none);
        measure_lowest();
        survey.update_room(widest_);
        bound(survey, Survey::Gaps::some);
        measure_rest();
    }

    /// Measures all candidates of a short list.
    void measure_all_of(const CandidateList& candidates) {
        for (std::size_t i = 0; i < candidates.count; ++i) measure(candidates.slot[i]);
    }

    void finish() {
        const std::size_t first = first_position_;
        for (std::size_t i = 0; i < group; ++i) {
            answers_.distance_squared[first + i] = g_.squared[i];
            answers_.triangle[first + i] = static_cast<std::uint32_t>(g_.triangle[i]);
            answers_.v[first + i] = g_.v[i];
            answers_.w[first + i] = g_.w[i];
        }
    }

    float widest() const { return widest_; }
    const TriangleBound& reference() const { return reference_; }

  private:
    // True when the triangle is nearest for a position of the group.
    bool measure(std::uint32_t slot) {
        const ClusteredTriangle& triangle = m_.triangles[slot];
        const TriangleShape s = triangle_shape(triangle.corners);
        if (has_no_inside(s)) return offer_thin(s, triangle.number, g_);
        bool any = false;
        const ShapeLanes lanes = same_shape(s, triangle.number);
        for (std::size_t i = 0; i < group; i += hn::Lanes(Doubles())) any |= offer(lanes, g_, i);
        return any;
    }

    // As ClosestPointIndex's queries widen their radius.
    void update_limits() {
        const Doubles d;
        const hn::Rebind<float, Doubles> df;
        auto widest = hn::Zero(df);
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto distance = hn::DemoteTo(df, hn::Sqrt(hn::Load(d, g_.squared + i)));
            const auto limit = hn::Add(hn::Mul(distance, hn::Set(df, 1.00001f)), hn::Set(df, m_.slack));
            hn::StoreU(hn::Mul(limit, limit), df, limit_ + i);
            widest = hn::Max(widest, limit);
        }
        widest_ = hn::GetLane(hn::MaxOfLanes(df, widest));
    }

    // New rows, for the candidates that matter.
    void bound(const Survey& survey, Survey::Gaps gaps) {
        const Many d;
        const ManyNumbers du;
        const std::size_t first_row = rows_.count;
        for (std::size_t i = 0; i < c_.count; i += hn::Lanes(d)) {
            const auto taken = hn::RebindMask(du, survey.matter(i, gaps));
            append(du, &all_places[i], taken, &rows_.place[rows_.count]);
            rows_.count += hn::CountTrue(du, taken);
        }
        for (std::size_t i = 0; i < group; i += hn::Lanes(Floats())) bound_lanes(survey, first_row, i);
    }

    // Rows from first_row on, for one vector of positions, and the lowest of them.
    void bound_lanes(const Survey& survey, std::size_t first_row, std::size_t i) {
        const Floats d;
        const hn::RebindToUnsigned<Floats> du;
        const auto px = hn::Load(d, positions_.x + i), py = hn::Load(d, positions_.y + i),
                   pz = hn::Load(d, positions_.z + i);
        auto lowest = hn::Load(d, lowest_ + i);
        auto lowest_row = hn::Load(du, lowest_row_ + i);
        for (std::size_t row = first_row; row < rows_.count; ++row) {
            const std::size_t place = rows_.place[row];
            const auto bound = bound_of(survey, place, hn::Sub(px, hn::Set(d, c_.center_x[place])),
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
    HWY_INLINE hn::Vec<Floats> bound_of(const Survey& survey, std::size_t place, hn::Vec<Floats> x,
                                        hn::Vec<Floats> y, hn::Vec<Floats> z) const {
        const Floats d;
        const float normal_x = c_.normal_x[place], normal_y = c_.normal_y[place],
                    normal_z = c_.normal_z[place];
        const auto along = [&](float nx, float ny, float nz) HWY_ATTR {
            return dot3(x, y, z, hn::Set(d, nx), hn::Set(d, ny), hn::Set(d, nz));
        };
        const auto off = hn::Set(d, survey.rounding(c_.radius[place]));
        auto height = hn::Abs(along(normal_x, normal_y, normal_z)), outside = hn::Zero(d);
        if (!has_plane(place)) {
            outside = hn::Sub(hn::Sqrt(dot3(x, y, z, x, y, z)), hn::Set(d, c_.radius[place]));
        } else {
            const TriangleEdges& e = m_.triangles[c_.slot[place]].edges;
            const auto beyond = [&](std::size_t k) HWY_ATTR {
                return hn::Sub(along(e.normal_x[k], e.normal_y[k], e.normal_z[k]), hn::Set(d, e.offset[k]));
            };
            outside = hn::Max(hn::Max(beyond(0), beyond(1)), beyond(2));
        }
        height = hn::Max(hn::Sub(height, off), hn::Zero(d));
        outside = hn::Max(hn::Sub(outside, off), hn::Zero(d));
        return hn::Add(hn::Mul(height, height), hn::Mul(outside, outside));
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
                offer(shapes_of(m_.triangles, slots + i), g_, i);
        }
        for (std::size_t i = 0; i < group; ++i)
            rows_.bound[lowest_row_[i] * group + i] = std::numeric_limits<float>::infinity();
        update_limits();
    }

    void measure_rest() {
        for (std::size_t row = 0; row < rows_.count; ++row) {
            if (matters(row, 0, group) && slot(row) != first_ && measure_row(row)) update_limits();
        }
    }

    // As measure(), for the vectors of positions to which the row matters.
    bool measure_row(std::size_t row) {
        const ClusteredTriangle& triangle = m_.triangles[slot(row)];
        const TriangleShape s = triangle_shape(triangle.corners);
        if (has_no_inside(s)) return offer_thin(s, triangle.number, g_);
        bool any = false;
        const ShapeLanes lanes = same_shape(s, triangle.number);
        for (std::size_t i = 0; i < group; i += hn::Lanes(Doubles()))
            if (matters(row, i, hn::Lanes(Doubles()))) any |= offer(lanes, g_, i);
        return any;
    }

    // To one of `count` positions of the group.
    bool matters(std::size_t row, std::size_t first, std::size_t count) const {
        const hn::CappedTag<float, 16> d;
        if (count < hn::Lanes(d)) return matters_to(hn::Rebind<float, Doubles>(), row, first);
        for (std::size_t i = first; i < first + count; i += hn::Lanes(d))
            if (matters_to(d, row, i)) return true;
        return false;
    }
    template <class D>
    HWY_INLINE bool matters_to(D d, std::size_t row, std::size_t i) const {
        const auto bound = hn::LoadU(d, &rows_.bound[row * group + i]);
        return !hn::AllFalse(d, hn::Le(bound, hn::LoadU(d, limit_ + i)));
    }

    const BlockMeasure& m_;
    const CandidateList& c_;
    BoundRows& rows_;
    SurveyNotes& notes_;
    BlockAnswers& answers_;
    std::size_t first_position_;
    LocalPositions positions_;
    float* limit_;
    PositionsBox box_;
    Group g_;
    float widest_ = 0.0f;      // largest root of a limit
    std::uint32_t first_ = 0;  // the triangle that was measured first
    TriangleBound reference_;  // its bound
    alignas(64) float lowest_[group];
    alignas(64) std::uint32_t lowest_row_[group];
};

// --- the block ---

void to_local(const double* at, double origin, float* local) {
    for (std::size_t i = 0; i < block_positions; ++i) local[i] = static_cast<float>(at[i] - origin);
}

void choose(const CandidateList& from, const Survey& survey, CandidateList& to) {
    const Many d;
    const ManyNumbers du;
    to.count = 0;
    for (std::size_t i = 0; i < from.count; i += hn::Lanes(d)) {
        const auto taken = survey.matter(i);
        if (hn::AllFalse(d, taken)) continue;
        const auto copy = [&](const auto& source, auto& target)
                              HWY_ATTR { append(d, &source[i], taken, &target[to.count]); };
        append(du, &from.slot[i], hn::RebindMask(du, taken), &to.slot[to.count]);
        copy(from.center_x, to.center_x), copy(from.center_y, to.center_y), copy(from.center_z, to.center_z);
        copy(from.normal_x, to.normal_x), copy(from.normal_y, to.normal_y), copy(from.normal_z, to.normal_z);
        copy(from.radius, to.radius);
        to.count += hn::CountTrue(d, taken);
    }
}

float distance_squared(const glm::vec3& a, const glm::vec3& b) {
    const glm::vec3 apart = a - b;
    return apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
}

// To scratch.chosen, what the groups that are near something need. The reference is that of the group which
// is nearest to the block's middle.
void choose_candidates(const BlockMeasure& m, BlockScratch& scratch, const BlockPositions& local,
                       const std::array<GroupQuery*, block_groups>& near, std::size_t near_count) {
    const LocalPositions positions = local.part(0, block_positions);
    const PositionsBox box = box_around(positions, m.slack);
    const TriangleBound* reference = nullptr;
    float widest = 0.0f;
    for (std::size_t i = 0; i < near_count; ++i) {
        const TriangleBound& other = near[i]->reference();
        const bool nearer = !reference || distance_squared(other.center, box.middle) <
                                              distance_squared(reference->center, box.middle);
        if (nearer) reference = &other;
        widest = std::max(widest, near[i]->widest());
    }
    Survey survey(scratch.candidates, scratch.notes, m.slack);
    survey.note(positions, box, *reference, widest);
    choose(scratch.candidates, survey, scratch.chosen);
    for (std::size_t i = 0; i < scratch.chosen.count; ++i) {  // most will be needed soon
        const auto* triangle = reinterpret_cast<const char*>(&m.triangles[scratch.chosen.slot[i]]);
        __builtin_prefetch(triangle), __builtin_prefetch(triangle + 64);
    }
}

void measure_all(const BlockMeasure& measure, BlockScratch& scratch, BlockAnswers& answers) {
    constexpr std::size_t few = 3;  // candidates that are measured in less time than bounded
    const bool all = scratch.candidates.count <= few;
    BlockPositions local;
    if (!all) {
        to_local(answers.x.data(), measure.origin.x, local.x);
        to_local(answers.y.data(), measure.origin.y, local.y);
        to_local(answers.z.data(), measure.origin.z, local.z);
    }
    const auto query = [&](std::size_t g)
                           HWY_ATTR { return GroupQuery(measure, scratch, local, answers, g * group); };
    std::array<GroupQuery, block_groups> groups{query(0), query(1), query(2), query(3)};
    std::array<GroupQuery*, block_groups> near;
    std::size_t near_count = 0;
    for (GroupQuery& g : groups) {
        if (all)
            g.measure_all_of(scratch.candidates);
        else if (g.measure_nearest(scratch.candidates))
            near[near_count++] = &g;
    }
    if (near_count > 0) choose_candidates(measure, scratch, local, near, near_count);
    for (std::size_t i = 0; i < near_count; ++i) near[i]->measure_chosen();
    for (GroupQuery& g : groups) g.finish();
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

void measure_block(const BlockMeasure& measure, BlockScratch& scratch, BlockAnswers& answers) {
    HWY_DYNAMIC_DISPATCH(measure_all)(measure, scratch, answers);
}

}  // namespace astrosplat
#endif
