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

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "splats/candidates.h"

HWY_BEFORE_NAMESPACE();
namespace astrosplat {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Many = hn::ScalableTag<float>;  // candidates
using ManyNumbers = hn::RebindToUnsigned<Many>;
using Lanes = hn::Vec<Many>;
using Floats = hn::CappedTag<float, 16>;  // positions

template <class V>
HWY_INLINE V dot3(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

/// Writes the values of the lanes in `mask` one after the other to `to`, which has room for a whole vector
/// more. (Before AVX-512, Highway 1.0.3 copies a table of 1 KiB for each Compress, where bit by bit is
/// faster.)
template <class D, class Mask>
HWY_INLINE void append(D d, const hn::TFromD<D>* from, Mask mask, hn::TFromD<D>* to) {
#if HWY_TARGET <= HWY_AVX3
    hn::StoreU(hn::Compress(hn::LoadU(d, from), mask), d, to);
#else
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    static_assert(hn::MaxLanes(D()) <= 8);
    for (unsigned bits = bytes[0]; bits != 0; bits &= bits - 1) *to++ = from[std::countr_zero(bits)];
#endif
}

/// A multiple of sixteen positions, in the candidates' coordinates.
struct LocalPositions {
    const float *x, *y, *z;
    const float* limit;  // square of how near a bound must come to matter
    std::size_t count;
};

class Survey {
  public:
    Survey(const CandidateList& candidates, SurveyNotes& notes, float slack)
        : c_(candidates), notes_(notes), slack_(slack) {}

    static constexpr std::size_t nothing = ~std::size_t{0};

    /// Looks at every candidate from the middle of the positions, whose limits have roots of at most
    /// `widest`. The one whose disc is nearest, or `nothing` if none matters.
    std::size_t look(const LocalPositions& positions, float widest) {
        p_ = positions;
        widest_ = widest;
        find_middle();
        const Many d;
        const ManyNumbers du;
        const Lanes px = hn::Set(d, middle_.x), py = hn::Set(d, middle_.y), pz = hn::Set(d, middle_.z);
        Lanes lowest = hn::Set(d, std::numeric_limits<float>::infinity());
        auto lowest_place = hn::Zero(du), place = hn::Iota(du, 0);
        for (std::size_t i = 0; i < c_.count; i += hn::Lanes(d)) {
            const Lanes x = hn::Sub(px, hn::LoadU(d, &c_.center_x[i])),
                        y = hn::Sub(py, hn::LoadU(d, &c_.center_y[i])),
                        z = hn::Sub(pz, hn::LoadU(d, &c_.center_z[i]));
            const Lanes height = dot3(x, y, z, hn::LoadU(d, &c_.normal_x[i]), hn::LoadU(d, &c_.normal_y[i]),
                                      hn::LoadU(d, &c_.normal_z[i]));
            const Lanes squared = hn::Mul(dot3(x, y, z, x, y, z), hn::Set(d, 1.0f - 4e-6f));
            const Lanes across = hn::Sqrt(hn::Max(hn::Sub(squared, hn::Mul(height, height)), hn::Zero(d)));
            hn::StoreU(height, d, &notes_.height[i]);
            hn::StoreU(across, d, &notes_.across[i]);
            const Lanes radius = hn::LoadU(d, &c_.radius[i]), off = rounding(d, radius);
            const Lanes outside = hn::Max(hn::Sub(hn::Sub(across, radius), off), hn::Zero(d));
            const Lanes above = hn::Max(hn::Sub(hn::Abs(height), off), hn::Zero(d));
            const Lanes bound = hn::Add(hn::Mul(outside, outside), hn::Mul(above, above));
            const auto lower = hn::And(hn::Lt(bound, lowest), hn::FirstN(d, c_.count - i));
            lowest = hn::IfThenElse(lower, bound, lowest);
            lowest_place = hn::IfThenElse(hn::RebindMask(du, lower), place, lowest_place);
            place = hn::Add(place, hn::Set(du, static_cast<std::uint32_t>(hn::Lanes(d))));
        }
        const Lanes best = hn::MinOfLanes(d, lowest);
        const float farthest = (widest_ + reach_) * 1.00001f + slack_;
        if (c_.count == 0 || hn::AllTrue(d, hn::Gt(best, hn::Set(d, farthest * farthest)))) return nothing;
        const auto lane = hn::FindFirstTrue(d, hn::Eq(lowest, best));
        return lane < 0 ? 0 : hn::ExtractLane(lowest_place, static_cast<std::size_t>(lane));
    }

    /// Of each candidate: a triangle T matters to a position p when distance(p, T)^2 <= limit(p). With h the
    /// height of p above T's plane and h0 that above a reference plane, distance(p, T)^2 is at least h^2 +
    /// gap^2, where gap is how far T's disc stays outside the shadow of all positions on T's plane; and
    /// limit(p) is at most room + h0^2. So gap^2 <= room + (h0^2 - h^2), and h0^2 - h^2 is at most
    /// `allowance`, because the planes' heights differ by at most `apart` among the positions. Likewise gap^2
    /// <= widest^2 - rise, where rise is the least h^2. The reference plane is that of candidate `reference`.
    void note_gaps(std::size_t reference, float widest) {
        widest_ = widest;
        take_reference(reference);
        const Many d;
        const Lanes reach = hn::Set(d, reach_);
        for (std::size_t i = 0; i < c_.count; i += hn::Lanes(d)) {
            const Lanes similar = dot3(hn::LoadU(d, &c_.normal_x[i]), hn::LoadU(d, &c_.normal_y[i]),
                                       hn::LoadU(d, &c_.normal_z[i]), hn::Set(d, normal_.x),
                                       hn::Set(d, normal_.y), hn::Set(d, normal_.z));
            const Lanes turned_squared =
                hn::Sub(hn::Set(d, 2.0f + 1e-6f), hn::Mul(hn::Abs(similar), hn::Set(d, 2.0f)));
            const Lanes tilt = hn::Mul(hn::Sqrt(hn::Max(turned_squared, hn::Zero(d))), reach);
            const Lanes radius = hn::LoadU(d, &c_.radius[i]), off = rounding(d, radius);
            const Lanes shadow = hn::Add(hn::Add(hn::Set(d, flat_reach_), tilt), off);
            hn::StoreU(hn::Sub(hn::Sub(hn::LoadU(d, &notes_.across[i]), radius), shadow), d, &notes_.gap[i]);
            const Lanes height = hn::LoadU(d, &notes_.height[i]);
            const Lanes same_side = hn::Mul(height, hn::CopySignToAbs(hn::Set(d, 1.0f), similar));
            const Lanes apart = hn::Add(hn::Add(hn::Abs(hn::Sub(same_side, hn::Set(d, height_))), tilt), off);
            hn::StoreU(hn::Mul(apart, hn::Add(apart, hn::Set(d, 2.0f * highest_))), d, &notes_.allowance[i]);
            const Lanes least = hn::Max(hn::Sub(hn::Sub(hn::Abs(height), reach), off), hn::Zero(d));
            hn::StoreU(hn::Mul(least, least), d, &notes_.rise[i]);
        }
    }

    /// The limits have shrunk.
    void update_room(float widest) {
        widest_ = widest;
        const Floats d;
        auto room = hn::Set(d, -std::numeric_limits<float>::infinity());
        const auto normal_x = hn::Set(d, normal_.x), normal_y = hn::Set(d, normal_.y),
                   normal_z = hn::Set(d, normal_.z);
        for (std::size_t i = 0; i < p_.count; i += hn::Lanes(d)) {
            const auto rise = dot3(from_middle(p_.x, middle_.x, i), from_middle(p_.y, middle_.y, i),
                                   from_middle(p_.z, middle_.z, i), normal_x, normal_y, normal_z);
            const auto height = hn::Abs(hn::Add(rise, hn::Set(d, height_)));
            const auto least = hn::Max(hn::Sub(height, hn::Set(d, reference_off_)), hn::Zero(d));
            room = hn::Max(room, hn::Sub(hn::Load(d, p_.limit + i), hn::Mul(least, least)));
        }
        room_ = hn::GetLane(hn::MaxOfLanes(d, room));
    }

    enum class Gaps { none, some };  // the positions are over the candidate, or beside it

    /// Which of the candidates from place i on matter. Comparisons with what is not a number count as yes.
    HWY_INLINE hn::Mask<Many> matter(std::size_t i) const {
        const Many d;
        const Lanes outside = hn::Max(hn::LoadU(d, &notes_.gap[i]), hn::Zero(d));
        const Lanes most = hn::Min(hn::Add(hn::Set(d, room_), hn::LoadU(d, &notes_.allowance[i])),
                                   hn::Sub(hn::Set(d, widest_ * widest_), hn::LoadU(d, &notes_.rise[i])));
        return hn::AndNot(hn::Gt(hn::Mul(outside, outside), most), hn::FirstN(d, c_.count - i));
    }
    HWY_INLINE hn::Mask<Many> matter(std::size_t i, Gaps gaps) const {
        const Many d;
        const auto beside = hn::Gt(hn::LoadU(d, &notes_.gap[i]), hn::Zero(d));
        return gaps == Gaps::some ? hn::And(matter(i), beside) : hn::AndNot(beside, matter(i));
    }

    /// More than the rounding of a position's distance to a candidate that matters: of its normal, of the
    /// subtraction of nearly equal squares.
    float rounding(float radius) const { return (radius + widest_ + reach_) * 2e-6f + slack_; }
    const glm::vec3& middle() const { return middle_; }

  private:
    HWY_INLINE Lanes rounding(Many d, Lanes radius) const {
        return hn::Add(hn::Mul(hn::Add(radius, hn::Set(d, widest_ + reach_)), hn::Set(d, 2e-6f)),
                       hn::Set(d, slack_));
    }

    static HWY_INLINE hn::Vec<Floats> from_middle(const float* at, float middle, std::size_t i) {
        const Floats d;
        return hn::Sub(hn::Load(d, at + i), hn::Set(d, middle));
    }

    float middle_of(const float* values) const {
        const Floats d;
        auto lowest = hn::Load(d, values), highest = lowest;
        for (std::size_t i = hn::Lanes(d); i < p_.count; i += hn::Lanes(d)) {
            lowest = hn::Min(lowest, hn::Load(d, values + i));
            highest = hn::Max(highest, hn::Load(d, values + i));
        }
        return 0.5f * (hn::GetLane(hn::MinOfLanes(d, lowest)) + hn::GetLane(hn::MaxOfLanes(d, highest)));
    }

    void find_middle() {
        middle_ = {middle_of(p_.x), middle_of(p_.y), middle_of(p_.z)};
        const Floats d;
        auto farthest = hn::Zero(d);
        for (std::size_t i = 0; i < p_.count; i += hn::Lanes(d)) {
            const auto x = from_middle(p_.x, middle_.x, i), y = from_middle(p_.y, middle_.y, i),
                       z = from_middle(p_.z, middle_.z, i);
            farthest = hn::Max(farthest, dot3(x, y, z, x, y, z));
        }
        reach_ = std::sqrt(hn::GetLane(hn::MaxOfLanes(d, farthest))) * 1.00001f + slack_;
    }

    void take_reference(std::size_t place) {
        normal_ = {c_.normal_x[place], c_.normal_y[place], c_.normal_z[place]};
        height_ = notes_.height[place];
        reference_off_ = rounding(c_.radius[place]);
        const Floats d;
        auto flat = hn::Zero(d), highest = hn::Zero(d);
        const auto normal_x = hn::Set(d, normal_.x), normal_y = hn::Set(d, normal_.y),
                   normal_z = hn::Set(d, normal_.z);
        for (std::size_t i = 0; i < p_.count; i += hn::Lanes(d)) {
            const auto x = from_middle(p_.x, middle_.x, i), y = from_middle(p_.y, middle_.y, i),
                       z = from_middle(p_.z, middle_.z, i);
            const auto rise = dot3(x, y, z, normal_x, normal_y, normal_z);
            const auto squared = hn::Mul(dot3(x, y, z, x, y, z), hn::Set(d, 1.0f + 4e-6f));
            flat = hn::Max(flat, hn::Sub(squared, hn::Mul(rise, rise)));
            highest = hn::Max(highest, hn::Abs(hn::Add(rise, hn::Set(d, height_))));
        }
        flat_reach_ = std::sqrt(hn::GetLane(hn::MaxOfLanes(d, flat))) * 1.00001f + slack_;
        highest_ = hn::GetLane(hn::MaxOfLanes(d, highest)) + slack_;
        update_room(widest_);
    }

    const CandidateList& c_;
    SurveyNotes& notes_;
    LocalPositions p_;
    float slack_;
    glm::vec3 middle_, normal_;  // of the positions; of the reference plane
    float widest_, reach_;       // largest root of a limit; of the positions from the middle
    float height_, highest_;     // above the reference plane, of the middle and of all
    float flat_reach_;           // as reach_, along the reference plane
    float reference_off_, room_;
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace astrosplat
HWY_AFTER_NAMESPACE();

#endif  // toggle
