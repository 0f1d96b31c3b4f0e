// Keyframes and what lies between them (DESIGN 6): linear, smooth, step and Bezier scalars, centripetal
// Catmull-Rom and Bezier positions (optionally at constant speed), slerped rotations; and the handles that
// shape Bezier segments, as they stand and as they act. A value at frame k is a function of the keyframes and
// k alone.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <type_traits>

#include "core/text.h"

namespace astrosplat {

enum class Interpolation { linear, smooth, step, bezier };
constexpr auto names_of(Interpolation) {
    return names_up_to<Interpolation::bezier>("linear", "smooth", "step", "bezier");
}
enum class Ends { ease, through };
constexpr auto names_of(Ends) { return names_up_to<Ends::through>("ease", "through"); }

enum class HandleKind { automatic, flat, free };

/// Where the control point of a Bezier segment lies from the keyframe at its end. Automatic and flat ones lie
/// a third of the segment away: automatic ones in the direction of the neighbouring keyframes (scalars:
/// without leaving their range), flat ones at the keyframe's value.
template <class T>
struct Handle {
    HandleKind kind;
    double frames;  // free: <= 0 before the keyframe, >= 0 after it
    T value;        // free: from the keyframe's

    // Constructors in place of defaults of the members: g++ 12 fails on those of templates.
    Handle(HandleKind kind_ = HandleKind::automatic, double frames_ = 0.0, const T& value_ = T(0))
        : kind(kind_), frames(frames_), value(value_) {}
    bool operator==(const Handle&) const = default;
};

template <class T>
struct Keyframe {
    double frame;
    T value;
    Interpolation interpolation;  // the way to the next keyframe
    Handle<T> in, out;            // used where the segment before it, or after it, is Bezier
    bool broken;                  // the two are shaped one by one: for editing only

    Keyframe(double frame_, const T& value_, Interpolation way, const Handle<T>& in_ = {},
             const Handle<T>& out_ = {}, bool broken_ = false)
        : frame(frame_), value(value_), interpolation(way), in(in_), out(out_), broken(broken_) {}
    bool operator==(const Keyframe&) const = default;
};

/// Tangent per frame at keyframe i of the values value(0), value(1), ...
template <class T, class Value>
auto tangent(std::span<const Keyframe<T>> keyframes, const Value& value, std::size_t i, Ends ends) {
    using Number = std::decay_t<decltype(value(i))>;
    bool end = i == 0 || i + 1 == keyframes.size();
    if (end && ends == Ends::ease) return Number(0.0);
    std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, keyframes.size() - 1);
    return Number((value(after) - value(before)) / (keyframes[after].frame - keyframes[before].frame));
}

/// The point at u in [0, 1] of the curve from a to d.
template <class T>
T bezier_point(const T& a, const T& b, const T& c, const T& d, double u) {
    const double v = 1.0 - u;
    return a * (v * v * v) + b * (3.0 * v * v * u) + c * (3.0 * v * u * u) + d * (u * u * u);
}

// T is double or glm::dvec3. Keyframes are ascending in frame.

/// The handles of keyframe i as they act: free ones shortened to their segment, the others worked out. 0
/// where there is no segment.
template <class T>
Handle<T> handle_before(std::span<const Keyframe<T>> keyframes, std::size_t i, Ends ends);
template <class T>
Handle<T> handle_after(std::span<const Keyframe<T>> keyframes, std::size_t i, Ends ends);

/// Segment i as a Bezier curve.
template <class T>
struct BezierSegment {
    T a, b, c, d;
    double out, in;  // frames of b and c, as shares of the segment's

    /// u at a share of the segment's frames, of which the curve from 0 to 1 with the control points `out` and
    /// `in`, both in [0, 1], rises all the way.
    double parameter(double share) const {
        double lo = 0.0, hi = 1.0;
        for (int k = 0; k < 54; ++k) {
            const double mid = 0.5 * (lo + hi);
            (bezier_point(0.0, out, in, 1.0, mid) < share ? lo : hi) = mid;
        }
        return 0.5 * (lo + hi);
    }
    T at(double u) const { return bezier_point(a, b, c, d, u); }
    /// The derivative with respect to u.
    T slope(double u) const {
        const double v = 1.0 - u;
        return (b - a) * (3.0 * v * v) + (c - b) * (6.0 * v * u) + (d - c) * (3.0 * u * u);
    }
};

template <class T>
BezierSegment<T> bezier_segment(std::span<const Keyframe<T>> keyframes, std::size_t i, Ends ends) {
    const Keyframe<T>&from = keyframes[i], &to = keyframes[i + 1];
    const double span = to.frame - from.frame;
    const Handle<T> out = handle_after(keyframes, i, ends), in = handle_before(keyframes, i + 1, ends);
    return {from.value, from.value + out.value, to.value + in.value,
            to.value,   out.frames / span,      1.0 + in.frames / span};
}

// Keyframes are ascending in frame, at least one; before the first and after the last the value is held.
// Ends::ease: a smooth track starts and ends at rest; through: with one-sided tangents.

/// Smooth: cubic Hermite with tangent (v[i+1]-v[i-1])/(t[i+1]-t[i-1]), clamped to the range of the segment's
/// two keyframes. Bezier: the curve of frame and value through both handles.
double evaluate_scalar(std::span<const Keyframe<double>> keyframes, double frame, Ends ends);

/// Smooth: a centripetal Catmull-Rom curve (one-sided at the ends and where two keyframes coincide), run
/// through with a speed that is continuous at the keyframes. `constant_speed`: the length covered since the
/// first keyframe grows evenly with the frame, whatever the frames of the keyframes between; with Ends::ease
/// a smooth path gathers its speed over the first tenth of the time and loses it over the last. Step segments
/// are jumps without length then. Bezier: the handles are control points in space, their frames the timing.
glm::dvec3 evaluate_position(std::span<const Keyframe<glm::dvec3>> keyframes, double frame, Ends ends,
                             bool constant_speed);

/// Quaternions x y z w of any length above 0; the result has length 1. Slerp the shorter way; smooth: with an
/// angular speed that is continuous at the keyframes; Bezier is taken for smooth.
glm::dvec4 evaluate_rotation(std::span<const Keyframe<glm::dvec4>> keyframes, double frame, Ends ends);

}  // namespace astrosplat
