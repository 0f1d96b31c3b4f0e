// Eight positions at a time walk down the tree of triangles: eight boxes at once are asked whether they may
// hold a closest point, then each triangle that is left by its disc, then what is left of those exactly.
#include "generate/lattice_cull.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "generate/block_query.cpp"
#include <hwy/foreach_target.h>
// after foreach_target.h
#include <hwy/highway.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t group = 8;               // positions
using Doubles = hn::CappedTag<double, group>;  // a group's coordinates, in one vector or several

// Positions, and the best answer so far for each: arrays of whole groups.
struct BestAnswers {
    const double *x, *y, *z;             // scene units
    double *squared, *triangle, *v, *w;  // as ClosestPoint; triangles' numbers are exact
};

struct Vector3 {
    hn::Vec<Doubles> x, y, z;
};

HWY_INLINE hn::Vec<Doubles> dot(const Vector3& a, const Vector3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vector3 set(const glm::dvec3& p) {
    const Doubles d;
    return {hn::Set(d, p.x), hn::Set(d, p.y), hn::Set(d, p.z)};
}

struct ClosestLanes {
    hn::Vec<Doubles> squared, v, w;  // as ClosestPoint
};

// Ericson's regions as masks: closest_on_triangle without branches, to the same bits.
HWY_INLINE ClosestLanes closest_lanes(const TriangleShape& s, const Vector3& p) {
    const Doubles d;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const Vector3 ab = set(s.ab), ac = set(s.ac), a = set(s.a);
    const Vector3 ap{hn::Sub(p.x, a.x), hn::Sub(p.y, a.y), hn::Sub(p.z, a.z)};
    const auto ab_ab = hn::Set(d, s.ab_ab), ab_ac = hn::Set(d, s.ab_ac), ac_ac = hn::Set(d, s.ac_ac);
    const auto d1 = dot(ab, ap), d2 = dot(ac, ap);
    const auto d3 = hn::Sub(d1, ab_ab), d4 = hn::Sub(d2, ab_ac), d5 = hn::Sub(d1, ab_ac),
               d6 = hn::Sub(d2, ac_ac);
    const auto vc = hn::Sub(hn::Mul(d1, d4), hn::Mul(d3, d2));
    const auto vb = hn::Sub(hn::Mul(d5, d2), hn::Mul(d1, d6));
    const auto va = hn::Sub(hn::Mul(d3, d6), hn::Mul(d5, d4));
    const auto to_c = hn::Sub(d4, d3), to_b = hn::Sub(d5, d6);
    const auto all = [](auto m, auto n, auto o) HWY_ATTR { return hn::And(hn::And(m, n), o); };
    const auto at_a = hn::And(hn::Le(d1, zero), hn::Le(d2, zero));
    const auto at_b = hn::And(hn::Ge(d3, zero), hn::Le(d4, d3));
    const auto at_c = hn::And(hn::Ge(d6, zero), hn::Le(d5, d6));
    const auto on_ab = all(hn::Le(vc, zero), hn::Ge(d1, zero), hn::Le(d3, zero));
    const auto on_ac = all(hn::Le(vb, zero), hn::Ge(d2, zero), hn::Le(d6, zero));
    const auto on_bc = all(hn::Le(va, zero), hn::Ge(to_c, zero), hn::Ge(to_b, zero));
    // From the last region Ericson asks for to the first, which wins. One division serves them all.
    auto top = hn::IfThenElse(on_bc, to_c, one);
    top = hn::IfThenElse(on_ab, d1, hn::IfThenElse(on_ac, d2, top));
    auto below = hn::IfThenElse(on_bc, hn::Add(to_c, to_b), hn::Add(hn::Add(va, vb), vc));
    below = hn::IfThenElse(on_ab, ab_ab, hn::IfThenElse(on_ac, ac_ac, below));
    const auto q = hn::Div(top, below);
    auto v = hn::IfThenElse(on_bc, hn::Sub(one, q), hn::Mul(vb, q));
    v = hn::IfThenElse(on_ab, q, hn::IfThenElse(on_ac, zero, v));
    v = hn::IfThenElse(at_b, one, hn::IfThenElse(at_c, zero, v));
    v = hn::IfThenElse(at_a, zero, v);
    auto w = hn::IfThenElse(hn::Or(on_bc, on_ac), q, hn::Mul(vc, q));
    w = hn::IfThenElse(on_ab, zero, w);
    w = hn::IfThenElse(at_b, zero, hn::IfThenElse(at_c, one, w));
    w = hn::IfThenElse(at_a, zero, w);
    const auto left = [&](auto from, auto b, auto c)
                          HWY_ATTR { return hn::Sub(hn::Sub(from, hn::Mul(b, v)), hn::Mul(c, w)); };
    const Vector3 r{left(ap.x, ab.x, ac.x), left(ap.y, ab.y, ac.y), left(ap.z, ab.z, ac.z)};
    return {dot(r, r), v, w};
}

// For the vector of positions from place i on. True when the triangle is nearest for one of them.
HWY_INLINE bool offer(const TriangleShape& s, double number, const BestAnswers& g, std::size_t i) {
    const Doubles d;
    const ClosestLanes c =
        closest_lanes(s, {hn::LoadU(d, g.x + i), hn::LoadU(d, g.y + i), hn::LoadU(d, g.z + i)});
    const auto best = hn::Load(d, g.squared + i), triangle = hn::Load(d, g.triangle + i);
    const auto this_one = hn::Set(d, number);
    const auto tie_won = hn::And(hn::Eq(c.squared, best), hn::Lt(this_one, triangle));
    const auto nearer = hn::Or(hn::Lt(c.squared, best), tie_won);
    if (hn::AllFalse(d, nearer)) return false;
    hn::Store(hn::IfThenElse(nearer, c.squared, best), d, g.squared + i);
    hn::Store(hn::IfThenElse(nearer, this_one, triangle), d, g.triangle + i);
    hn::Store(hn::IfThenElse(nearer, c.v, hn::Load(d, g.v + i)), d, g.v + i);
    hn::Store(hn::IfThenElse(nearer, c.w, hn::Load(d, g.w + i)), d, g.w + i);
    return true;
}

// The same for a triangle without a usable inside, by the scalar code, and for one position.
inline void offer_thin(const TriangleShape& shape, double number, const BestAnswers& g, std::size_t i) {
    const ClosestPoint c = closest_on_triangle({g.x[i], g.y[i], g.z[i]}, shape);
    const bool tie_won = c.distance_squared == g.squared[i] && number < g.triangle[i];
    if (!(c.distance_squared < g.squared[i] || tie_won)) return;
    g.squared[i] = c.distance_squared, g.triangle[i] = number;
    g.v[i] = c.barycentric.x, g.w[i] = c.barycentric.y;
}

using Floats = hn::CappedTag<float, group>;  // of eight positions or of eight boxes, in one vector or two
using Lanes = hn::Vec<Floats>;
static_assert(group == TriangleTree::fan);

// Along one axis: the least of y^2 - 2 p y over p in low .. high and y in from .. to.
HWY_INLINE Lanes least_power(float low, float high, Lanes from, Lanes to) {
    const Floats d;
    const auto end = [&](float p) HWY_ATTR {
        const Lanes y = hn::Min(hn::Max(hn::Set(d, p), from), to);
        return hn::Mul(y, hn::Sub(y, hn::Set(d, 2.0f * p)));
    };
    return hn::Min(end(low), end(high));
}

class GroupQuery {
  public:
    GroupQuery(const TriangleTree& tree, double max_distance, const BestAnswers& answers,
               std::vector<std::uint32_t>& found)
        : tree_(tree), g_(answers), found_(found) {
        std::fill_n(g_.squared, group, max_distance * max_distance);
        std::fill_n(g_.triangle, group, double(ClosestPoint::none));
        std::fill_n(g_.v, group, 0.0), std::fill_n(g_.w, group, 0.0);
        to_local();
    }

    // `near`: a triangle that is close to all of the positions, and a point of it.
    void run(std::uint32_t near, const glm::dvec3& on_it) {
        measure(near, ~0u);
        set_reference(near, on_it);
        walk();
        expect_middles();
        for (const std::uint32_t slot : found_) {
            const unsigned positions = slot == near ? 0u : who_asks_for(tree_.triangles[slot].disc);
            if (positions != 0) measure(slot, positions);
        }
    }

  private:
    void to_local() {
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
        for (std::size_t i = 0; i < group; ++i) {
            const glm::dvec3 p = glm::dvec3(g_.x[i], g_.y[i], g_.z[i]) - tree_.origin;
            low = glm::min(low, p), high = glm::max(high, p);
            x_[i] = float(p.x), y_[i] = float(p.y), z_[i] = float(p.z);
            limit_[i] = std::numeric_limits<float>::max();
        }
        low_ = glm::vec3(low), high_ = glm::vec3(high);
        slack_ = float(tree_.slack(glm::max(glm::abs(low), glm::abs(high))));
    }

    // Exactly, for the positions in `asking`; what they have then limits what may still matter.
    void measure(std::uint32_t slot, unsigned asking) {
        const TriangleShape shape = tree_.shape(slot);
        const double number = tree_.triangles[slot].number;
        if (has_no_inside(shape)) {
            for (std::size_t i = 0; i < group; ++i) offer_thin(shape, number, g_, i);
            return update_limits();
        }
        constexpr std::size_t lanes = hn::MaxLanes(Doubles());
        bool improved = false;
        for (std::size_t i = 0; i < group; i += lanes)
            if (asking >> i & ((1u << lanes) - 1u)) improved |= offer(shape, number, g_, i);
        if (improved) update_limits();
    }

    // As widened().
    void update_limits() {
        const Doubles d;
        const hn::Rebind<float, Doubles> df;
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto distance = hn::Sqrt(hn::Load(d, g_.squared + i));
            const auto limit = hn::Add(hn::Mul(distance, hn::Set(d, 1.00001)), hn::Set(d, double{slack_}));
            hn::Store(hn::Min(hn::DemoteTo(df, limit), hn::Load(df, limit_ + i)), df, limit_ + i);
        }
    }

    // A point y can only be closer to a position p than the meshes' point c if it is on p's side of the plane
    // midway between them: with y and p relative to c, if y^2 - 2 p y <= 0. The rounding is more than float
    // can make of such a sum; nothing is concluded from triangles too narrow for a reliable point.
    void set_reference(std::uint32_t near, const glm::dvec3& on_it) {
        const glm::dvec3 local = on_it - tree_.origin;
        const glm::dvec3 low = glm::dvec3(low_) - local, high = glm::dvec3(high_) - local;
        const double reach = glm::length(glm::max(glm::abs(low), glm::abs(high))), slack = slack_;
        reference_ = glm::vec3(local), from_reference_low_ = glm::vec3(low),
        from_reference_high_ = glm::vec3(high);
        widest_ = *std::max_element(limit_, limit_ + group);
        rounding_ = tree_.triangles[near].disc.has_plane()
                        ? float(32.0 * (reach + slack) * (slack + 1e-6 * reach))
                        : std::numeric_limits<float>::infinity();
    }

    // As bits: which of the eight boxes from `first` on may hold a point that is closest to a position.
    HWY_INLINE unsigned may_hold_closest(const TreeLevel& boxes, std::size_t first) const {
        const Floats d;
        unsigned bits = 0;
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            Lanes gap = hn::Zero(d), power = hn::Zero(d);
            const auto add = [&](const Buffer<float>& los, const Buffer<float>& his, int axis) HWY_ATTR {
                const Lanes lo = hn::LoadU(d, &los[first + i]), hi = hn::LoadU(d, &his[first + i]);
                const Lanes beside = hn::Max(
                    hn::Max(hn::Sub(lo, hn::Set(d, high_[axis])), hn::Sub(hn::Set(d, low_[axis]), hi)),
                    hn::Zero(d));
                gap = hn::Add(gap, hn::Mul(beside, beside));
                const Lanes c = hn::Set(d, reference_[axis]);
                power = hn::Add(power, least_power(from_reference_low_[axis], from_reference_high_[axis],
                                                   hn::Sub(lo, c), hn::Sub(hi, c)));
            };
            add(boxes.lo_x, boxes.hi_x, 0), add(boxes.lo_y, boxes.hi_y, 1), add(boxes.lo_z, boxes.hi_z, 2);
            const auto far =
                hn::Or(hn::Gt(gap, hn::Set(d, widest_ * widest_)), hn::Gt(power, hn::Set(d, rounding_)));
            bits |= (~bits_of(d, far) & ((1u << hn::MaxLanes(d)) - 1u)) << i;
        }
        return bits;
    }

    // To `found_`: the slots of the triangles whose boxes may hold a closest point.
    void walk() {
        struct Siblings {
            std::size_t level, first;
        };
        std::array<Siblings, 12 * group> open;  // more levels than 32 bits of triangles have
        std::size_t count = 0;
        open[count++] = {tree_.levels.size() - 1, 0};
        found_.clear();
        while (count > 0) {
            const auto [level, first] = open[--count];
            const TreeLevel& boxes = tree_.levels[level];
            unsigned near = may_hold_closest(boxes, first);
            if (boxes.count - first < group) near &= (1u << (boxes.count - first)) - 1u;
            for (; near != 0; near &= near - 1) {
                const std::size_t box = first + std::size_t(std::countr_zero(near));
                if (level == 0)
                    found_.push_back(std::uint32_t(box));
                else
                    open[count++] = {level - 1, box * group};
            }
        }
    }

    struct FromDisc {
        Lanes middle_squared, height;
    };
    HWY_INLINE FromDisc from_disc(const TriangleDisc& disc, std::size_t i) const {
        const Floats d;
        const Lanes x = hn::Sub(hn::Load(d, x_ + i), hn::Set(d, disc.center.x));
        const Lanes y = hn::Sub(hn::Load(d, y_ + i), hn::Set(d, disc.center.y));
        const Lanes z = hn::Sub(hn::Load(d, z_ + i), hn::Set(d, disc.center.z));
        const auto sum = [](Lanes a, Lanes b, Lanes c) HWY_ATTR { return hn::Add(hn::Add(a, b), c); };
        return {sum(hn::Mul(x, x), hn::Mul(y, y), hn::Mul(z, z)),
                sum(hn::Mul(x, hn::Set(d, disc.normal.x)), hn::Mul(y, hn::Set(d, disc.normal.y)),
                    hn::Mul(z, hn::Set(d, disc.normal.z)))};
    }

    // The middle of a disc is on its triangle: no position needs to look farther than the nearest of them.
    void expect_middles() {
        const Floats d;
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            Lanes nearest = hn::Set(d, std::numeric_limits<float>::infinity());
            for (const std::uint32_t slot : found_) {
                const TriangleDisc& disc = tree_.triangles[slot].disc;
                if (disc.has_plane()) nearest = hn::Min(nearest, from_disc(disc, i).middle_squared);
            }
            const Lanes limit =
                hn::Add(hn::Mul(hn::Sqrt(nearest), hn::Set(d, 1.00002f)), hn::Set(d, 2.0f * slack_));
            hn::Store(hn::Min(limit, hn::Load(d, limit_ + i)), d, limit_ + i);
        }
    }

    // As bits: the positions that a triangle may be closest to, as far as its disc tells.
    HWY_INLINE unsigned who_asks_for(const TriangleDisc& disc) const {
        const Floats d;
        unsigned bits = 0;
        for (std::size_t i = 0; i < group; i += hn::Lanes(d)) {
            const auto [squared, height] = from_disc(disc, i);
            const Lanes limit = hn::Load(d, limit_ + i), radius = hn::Set(d, disc.radius);
            const Lanes off = hn::Add(hn::Set(d, slack_), hn::Mul(hn::Add(limit, radius), hn::Set(d, 2e-6f)));
            const Lanes flat = hn::Sub(hn::Mul(squared, hn::Set(d, 1.0f - 4e-6f)), hn::Mul(height, height));
            const Lanes across = hn::Sqrt(hn::Max(flat, hn::Zero(d)));
            const Lanes outside = hn::Max(hn::Sub(across, hn::Add(radius, off)), hn::Zero(d));
            const Lanes above = hn::Max(hn::Sub(hn::Abs(height), off), hn::Zero(d));
            const Lanes least = hn::Add(hn::Mul(outside, outside), hn::Mul(above, above));
            const auto far = hn::Gt(least, hn::Mul(limit, limit));
            bits |= (~bits_of(d, far) & ((1u << hn::MaxLanes(d)) - 1u)) << i;
        }
        return bits;
    }

    const TriangleTree& tree_;
    BestAnswers g_;
    std::vector<std::uint32_t>& found_;
    // Relative to the tree's origin, and that to the reference point; float, scene units.
    alignas(64) float x_[group], y_[group], z_[group];
    alignas(64) float limit_[group];  // how near a triangle's bound must come to matter to the position
    glm::vec3 low_, high_, reference_, from_reference_low_, from_reference_high_;
    float slack_, widest_, rounding_;
};

void measure_block(const TriangleTree& tree, double max_distance, std::uint32_t near, const glm::dvec3& on_it,
                   std::vector<std::uint32_t>& scratch, BlockAnswers& a) {
    alignas(64) double triangle[group];
    for (std::size_t i = 0; i < block_positions; i += group) {
        const BestAnswers eight{&a.x[i],  &a.y[i], &a.z[i], &a.distance_squared[i],
                                triangle, &a.v[i], &a.w[i]};
        GroupQuery(tree, max_distance, eight, scratch).run(near, on_it);
        for (std::size_t k = 0; k < group; ++k) a.triangle[i + k] = std::uint32_t(triangle[k]);
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace astrosplat {

HWY_EXPORT(measure_block);

// Places beyond the lattice's end were measured with the rest.
static void drop_outside(const Lattice& lattice, const LatticeBlock& block, Positions kind,
                         BlockAnswers& answers) {
    const glm::i64vec3 count = lattice.n + std::int64_t{kind == Positions::corners};
    const glm::i64vec3 inside = glm::min(count - block.at * block_cells, block_cells);
    if (inside == glm::i64vec3(block_cells)) return;
    for (std::size_t s = 0; s < block_positions; ++s) {
        const auto bit = [&](unsigned n) { return std::int64_t(s >> n & 1u); };
        const glm::i64vec3 at(bit(3) * 2 + bit(0), bit(4) * 2 + bit(1), bit(5) * 2 + bit(2));
        if (at.x >= inside.x || at.y >= inside.y || at.z >= inside.z)
            answers.triangle[s] = ClosestPoint::none;
    }
}

void query_block(const TriangleTree& tree, const Lattice& lattice, const CullSettings& settings,
                 const LatticeBlock& block, Positions kind, std::vector<std::uint32_t>& scratch,
                 BlockAnswers& answers) {
    place_block(lattice, settings, block, kind, answers);
    const BlockBall ball = block_ball(lattice, settings.jitter, block.at * block_cells, block_cells);
    const TriangleShape shape = tree.shape(block.near_slot);
    const glm::dvec2 weights = closest_on_triangle(ball.center, shape).barycentric;
    const glm::dvec3 on_it = shape.a + shape.ab * weights.x + shape.ac * weights.y;
    HWY_DYNAMIC_DISPATCH(measure_block)
    (tree, settings.max_distance, block.near_slot, on_it, scratch, answers);
    drop_outside(lattice, block, kind, answers);
}

}  // namespace astrosplat
#endif
