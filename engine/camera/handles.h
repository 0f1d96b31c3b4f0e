// Bezier segments between keyframes: the handles as they act, and the curve they make.
#pragma once

#include <glm/vec3.hpp>

#include "camera/bezier.h"
#include "camera/keyframe.h"

namespace astrosplat {

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

    /// The parameter at a share of the segment's frames.
    double parameter(double share) const { return bezier_parameter(out, in, share); }
    T at(double u) const { return bezier_point(a, b, c, d, u); }
    T slope(double u) const { return bezier_slope(a, b, c, d, u); }
};

template <class T>
BezierSegment<T> bezier_segment(std::span<const Keyframe<T>> keyframes, std::size_t i, Ends ends) {
    const Keyframe<T>&from = keyframes[i], &to = keyframes[i + 1];
    const double span = to.frame - from.frame;
    const Handle<T> out = handle_after(keyframes, i, ends), in = handle_before(keyframes, i + 1, ends);
    return {from.value, from.value + out.value, to.value + in.value,
            to.value,   out.frames / span,      1.0 + in.frames / span};
}

}  // namespace astrosplat
