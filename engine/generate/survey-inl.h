// A few positions look at many candidates from their middle: which of them can be closest to one of the
// positions? In: positions and candidates in float, and what the positions have already. Out: a mask of
// candidates. Included once per instruction set.
#if defined(ASTROSPLAT_SPLATS_SURVEY_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASTROSPLAT_SPLATS_SURVEY_INL_H
#undef ASTROSPLAT_SPLATS_SURVEY_INL_H
#else
#define ASTROSPLAT_SPLATS_SURVEY_INL_H
#endif

#include <hwy/highway.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "core/append-inl.h"
#include "generate/candidates.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Many = hn::ScalableTag<float>;  // candidates
using ManyNumbers = hn::RebindToUnsigned<Many>;
using Lanes = hn::Vec<Many>;
using Floats = hn::CappedTag<float, 16>;  // positions

/// For bounds only, which allow for rounding: multiplications and additions may be fused.
template <class V>
HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

/// A multiple of sixteen positions, in the candidates' coordinates.
struct LocalPositions {
    const float *x, *y, *z;
    const float* limit;  // square of how near a bound must come to matter
    std::size_t count;
};

/// The box around positions along the axes.
struct PositionsBox {
    glm::vec3 middle, half;

    float reach() const { return std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z) * 1.00001f; }
};

HWY_INLINE void middle_of(const float* values, std::size_t count, float slack, float& middle, float& half) {
    const Floats d;
    auto lowest = hn::Load(d, values), highest = lowest;
    for (std::size_t i = hn::Lanes(d); i < count; i += hn::Lanes(d)) {
        lowest = hn::Min(lowest, hn::Load(d, values + i));
        highest = hn::Max(highest, hn::Load(d, values + i));
    }
    const float low = hn::GetLane(hn::MinOfLanes(d, lowest)), high = hn::GetLane(hn::MaxOfLanes(d, highest));
    middle = 0.5f * (low + high);
    half = 0.5f * (high - low) + slack;
}

HWY_INLINE PositionsBox box_around(const LocalPositions& p, float slack) {
    PositionsBox box;
    middle_of(p.x, p.count, slack, box.middle.x, box.half.x);
    middle_of(p.y, p.count, slack, box.middle.y, box.half.y);
    middle_of(p.z, p.count, slack, box.middle.z, box.half.z);
    return box;
}

/// Bounds of as many candidates as a vector has lanes.
struct BoundLanes {
    Lanes center_x, center_y, center_z, normal_x, normal_y, normal_z, radius;
};

HWY_INLINE BoundLanes bounds_of(const CandidateList& list, std::size_t i) {
    const Many d;
    return {hn::LoadU(d, &list.center_x[i]), hn::LoadU(d, &list.center_y[i]), hn::LoadU(d, &list.center_z[i]),
            hn::LoadU(d, &list.normal_x[i]), hn::LoadU(d, &list.normal_y[i]), hn::LoadU(d, &list.normal_z[i]),
            hn::LoadU(d, &list.radius[i])};
}

// A disc seen from the middle of a box.
struct Disc {
    Lanes x, y, z;         // from the disc's middle to the box's
    Lanes height, across;  // of the box's middle: along the normal and, at most, in the plane
};

HWY_INLINE Disc seen_from(const glm::vec3& middle, const BoundLanes& b) {
    const Many d;
    Disc disc;
    disc.x = hn::Sub(hn::Set(d, middle.x), b.center_x);
    disc.y = hn::Sub(hn::Set(d, middle.y), b.center_y);
    disc.z = hn::Sub(hn::Set(d, middle.z), b.center_z);
    disc.height = dot3(disc.x, disc.y, disc.z, b.normal_x, b.normal_y, b.normal_z);
    const Lanes squared =
        hn::Mul(dot3(disc.x, disc.y, disc.z, disc.x, disc.y, disc.z), hn::Set(d, 1.0f - 4e-6f));
    disc.across = hn::Sqrt(hn::Max(hn::NegMulAdd(disc.height, disc.height, squared), hn::Zero(d)));
    return disc;
}

/// A candidate that is as good as the nearest to a point: the one in whose ball the point lies deepest, by
/// its power |p - center|^2 - radius^2. Where the balls are around the triangles' circumcircles, two powers
/// are equal above the edge that two triangles share. 0 for none.
HWY_INLINE std::size_t nearest_candidate(const CandidateList& list, const glm::vec3& point) {
    const Many d;
    const ManyNumbers du;
    Lanes lowest = hn::Set(d, std::numeric_limits<float>::infinity());
    auto lowest_place = hn::Zero(du), place = counting(du);
    for (std::size_t i = 0; i < list.count; i += hn::Lanes(d)) {
        const Lanes x = hn::Sub(hn::LoadU(d, &list.center_x[i]), hn::Set(d, point.x));
        const Lanes y = hn::Sub(hn::LoadU(d, &list.center_y[i]), hn::Set(d, point.y));
        const Lanes z = hn::Sub(hn::LoadU(d, &list.center_z[i]), hn::Set(d, point.z));
        const Lanes radius = hn::LoadU(d, &list.radius[i]);
        const Lanes power = hn::NegMulAdd(radius, radius, dot3(x, y, z, x, y, z));
        const auto lower = hn::And(hn::Lt(power, lowest), hn::FirstN(d, list.count - i));
        lowest = hn::IfThenElse(lower, power, lowest);
        lowest_place = hn::IfThenElse(hn::RebindMask(du, lower), place, lowest_place);
        place = hn::Add(place, hn::Set(du, static_cast<std::uint32_t>(hn::Lanes(d))));
    }
    const auto lane = hn::FindFirstTrue(d, hn::Eq(lowest, hn::MinOfLanes(d, lowest)));
    return lane < 0 ? 0 : hn::ExtractLane(lowest_place, static_cast<std::size_t>(lane));
}

/// A few positions, and what they have: which candidates can matter to them?
class View {
  public:
    /// The roots of the positions' limits are at most `widest`.
    View(const LocalPositions& positions, const PositionsBox& box, const TriangleBound& reference,
         float widest, float slack)
        : p_(positions), box_(box), slack_(slack), widest_(widest), reach_(box.reach()) {
        take_reference(reference);
    }

    struct Note {
        Lanes gap, need, away;
    };

    /// Of a candidate: a triangle T matters to a position p when distance(p, T)^2 <= limit(p). With h the
    /// height of p above T's plane and h0 that above a reference plane, distance(p, T)^2 is at least h^2 +
    /// gap^2, where gap is how far T's disc stays outside the shadow of the positions' box on T's plane, in
    /// the direction of the box's middle; and limit(p) is at most room + h0^2. So gap^2 <= room + (h0^2 -
    /// h^2). With D = h0 - h, h0^2 - h^2 = D (2 h0 - D): among the positions D and h0 lie in intervals, and
    /// its largest value there is subtracted from gap^2 to give what T `need`s for room. Likewise T is
    /// `away`, at least: gap^2 and the least h^2, to be compared with widest^2.
    HWY_INLINE Note note(const BoundLanes& b) const {
        const Many d;
        const Disc disc = seen_from(box_.middle, b);
        const Lanes off = rounding(b.radius);
        const auto flat = [&](Lanes to, Lanes normal)
                              HWY_ATTR { return hn::NegMulAdd(normal, disc.height, to); };
        const Lanes toward =
            box_along(flat(disc.x, b.normal_x), flat(disc.y, b.normal_y), flat(disc.z, b.normal_z));
        const Lanes shadow = hn::Add(hn::Div(toward, disc.across), off);
        const Lanes gap = hn::Sub(hn::Sub(disc.across, b.radius), shadow);
        const Lanes outside = hn::Max(gap, hn::Zero(d));
        const Lanes least =
            hn::Max(hn::Sub(hn::Sub(hn::Abs(disc.height), hn::Set(d, reach_)), off), hn::Zero(d));
        return {gap, hn::MulSub(outside, outside, allowance(b, disc.height, off)),
                hn::MulAdd(outside, outside, hn::Mul(least, least))};
    }

    /// Which of them can matter. Comparisons with what is not a number count as yes.
    HWY_INLINE hn::Mask<Many> matter(Lanes need, Lanes away) const {
        const Many d;
        return hn::Not(hn::Or(hn::Gt(need, hn::Set(d, room_)), hn::Gt(away, hn::Set(d, widest_ * widest_))));
    }

    /// The limits have shrunk.
    void update_room(float widest) {
        widest_ = widest;
        const Floats d;
        auto room = hn::Set(d, -std::numeric_limits<float>::infinity());
        for (std::size_t i = 0; i < p_.count; i += hn::Lanes(d)) {
            const auto least =
                hn::Max(hn::Sub(hn::Abs(height_of(i)), hn::Set(d, reference_off_)), hn::Zero(d));
            room = hn::Max(room, hn::Sub(hn::Load(d, p_.limit + i), hn::Mul(least, least)));
        }
        room_ = hn::GetLane(hn::MaxOfLanes(d, room));
    }

    /// More than the rounding of a position's distance to a candidate that matters: of its normal, of the
    /// subtraction of nearly equal squares.
    float rounding(float radius) const { return rounding_of(radius, widest_ + reach_); }

  private:
    // How far the box reaches from its middle along vectors, times their lengths.
    HWY_INLINE Lanes box_along(Lanes x, Lanes y, Lanes z) const {
        const Many d;
        return dot3(hn::Abs(x), hn::Abs(y), hn::Abs(z), hn::Set(d, box_.half.x), hn::Set(d, box_.half.y),
                    hn::Set(d, box_.half.z));
    }

    // The largest h0^2 - h^2.
    HWY_INLINE Lanes allowance(const BoundLanes& b, Lanes height, Lanes off) const {
        const Many d;
        const Lanes similar = dot3(b.normal_x, b.normal_y, b.normal_z, hn::Set(d, normal_.x),
                                   hn::Set(d, normal_.y), hn::Set(d, normal_.z));
        const Lanes side = hn::CopySignToAbs(hn::Set(d, 1.0f), similar);
        const auto turned = [&](float normal, Lanes other)
                                HWY_ATTR { return hn::NegMulAdd(other, side, hn::Set(d, normal)); };
        const Lanes tilt = hn::Add(box_along(turned(normal_.x, b.normal_x), turned(normal_.y, b.normal_y),
                                             turned(normal_.z, b.normal_z)),
                                   hn::Add(off, hn::Set(d, reference_off_)));
        const Lanes apart = hn::NegMulAdd(height, side, hn::Set(d, height_));
        const Lanes least = hn::Sub(apart, tilt), most = hn::Add(apart, tilt);
        const auto largest = [&](float reference_height) HWY_ATTR {
            const Lanes h0 = hn::Set(d, reference_height), difference = hn::Min(hn::Max(h0, least), most);
            return hn::Mul(difference, hn::Sub(hn::Add(h0, h0), difference));
        };
        return hn::Max(largest(lowest_), largest(highest_));
    }

    float rounding_of(float radius, float around) const { return (radius + around) * 2e-6f + slack_; }
    HWY_INLINE Lanes rounding(Lanes radius) const {
        const Many d;
        return hn::MulAdd(radius, hn::Set(d, 2e-6f), hn::Set(d, rounding(0.0f)));
    }

    // Of positions from place i on, above the reference plane.
    HWY_INLINE hn::Vec<Floats> height_of(std::size_t i) const {
        const Floats d;
        const auto at = [&](const float* values, float middle)
                            HWY_ATTR { return hn::Sub(hn::Load(d, values + i), hn::Set(d, middle)); };
        const auto rise = dot3(at(p_.x, box_.middle.x), at(p_.y, box_.middle.y), at(p_.z, box_.middle.z),
                               hn::Set(d, normal_.x), hn::Set(d, normal_.y), hn::Set(d, normal_.z));
        return hn::Add(rise, hn::Set(d, height_));
    }

    void take_reference(const TriangleBound& reference) {
        normal_ = reference.normal;
        const glm::vec3 from = box_.middle - reference.center;
        height_ = from.x * normal_.x + from.y * normal_.y + from.z * normal_.z;
        reference_off_ = rounding(reference.radius);
        const Floats d;
        auto lowest = height_of(0), highest = lowest;
        for (std::size_t i = hn::Lanes(d); i < p_.count; i += hn::Lanes(d)) {
            lowest = hn::Min(lowest, height_of(i));
            highest = hn::Max(highest, height_of(i));
        }
        lowest_ = hn::GetLane(hn::MinOfLanes(d, lowest)) - reference_off_;
        highest_ = hn::GetLane(hn::MaxOfLanes(d, highest)) + reference_off_;
        update_room(widest_);
    }

    LocalPositions p_;
    PositionsBox box_;
    float slack_;
    float widest_, reach_;             // largest root of a limit; of the box from its middle
    glm::vec3 normal_;                 // of the reference plane
    float height_, lowest_, highest_;  // above the reference plane, of the middle and of the positions
    float reference_off_, room_;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#endif  // toggle
