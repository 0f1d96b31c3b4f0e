// Keyframes: a value at a frame, how it goes on to the next one, and the handles that shape Bezier segments.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>

#include "core/enum_names.h"

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

}  // namespace astrosplat
