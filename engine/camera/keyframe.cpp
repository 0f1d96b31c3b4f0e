#include "camera/keyframe.h"

#include <algorithm>
#include <cmath>

namespace astrosplat {

namespace {

// Tangent per frame of an automatic handle: that of the neighbours; for scalars limited to three times the
// slopes beside it (Fritsch and Carlson, 1980), and 0 where the values turn.
glm::dvec3 automatic_tangent(std::span<const Keyframe<glm::dvec3>> keyframes, std::size_t i, Ends ends) {
    return tangent(
        keyframes, [&](std::size_t k) { return keyframes[k].value; }, i, ends);
}

double automatic_tangent(std::span<const Keyframe<double>> keyframes, std::size_t i, Ends ends) {
    const double m = tangent(
        keyframes, [&](std::size_t k) { return keyframes[k].value; }, i, ends);
    if (i == 0 || i + 1 == keyframes.size()) return m;
    const auto slope = [&](std::size_t k) {
        return (keyframes[k + 1].value - keyframes[k].value) / (keyframes[k + 1].frame - keyframes[k].frame);
    };
    const double before = slope(i - 1), after = slope(i);
    if (before * after <= 0.0) return 0.0;
    const double most = 3.0 * std::fmin(std::fabs(before), std::fabs(after));
    return std::clamp(m, -most, most);
}

// A handle of keyframe i towards the neighbour `span` frames away, which is below 0 before it.
template <class T>
Handle<T> acting_handle(std::span<const Keyframe<T>> keyframes, const Handle<T>& handle, std::size_t i,
                        double span, Ends ends) {
    if (handle.kind != HandleKind::free) {
        const double frames = span / 3.0;
        const bool flat = handle.kind == HandleKind::flat;
        return {handle.kind, frames, flat ? T(0.0) : T(automatic_tangent(keyframes, i, ends) * frames)};
    }
    if (std::fabs(handle.frames) <= std::fabs(span)) return handle;
    return {handle.kind, span, handle.value * (span / handle.frames)};
}

}  // namespace

template <class T>
Handle<T> handle_before(std::span<const Keyframe<T>> keyframes, std::size_t i, Ends ends) {
    if (i == 0) return {};
    return acting_handle(keyframes, keyframes[i].in, i, keyframes[i - 1].frame - keyframes[i].frame, ends);
}

template <class T>
Handle<T> handle_after(std::span<const Keyframe<T>> keyframes, std::size_t i, Ends ends) {
    if (i + 1 >= keyframes.size()) return {};
    return acting_handle(keyframes, keyframes[i].out, i, keyframes[i + 1].frame - keyframes[i].frame, ends);
}

template Handle<double> handle_before(std::span<const Keyframe<double>>, std::size_t, Ends);
template Handle<double> handle_after(std::span<const Keyframe<double>>, std::size_t, Ends);
template Handle<glm::dvec3> handle_before(std::span<const Keyframe<glm::dvec3>>, std::size_t, Ends);
template Handle<glm::dvec3> handle_after(std::span<const Keyframe<glm::dvec3>>, std::size_t, Ends);

}  // namespace astrosplat
