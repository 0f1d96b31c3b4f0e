// Interpolation of keyframes. A smooth position or rotation separates the way from the timing: the way is a
// curve through the keyframes with a travelled parameter (knots, or degrees turned), the timing a monotone
// cubic of that parameter over frames, so that speed is continuous at the keyframes and
// nothing runs backwards.
#include "camera/keyframe.h"

#include <glm/geometric.hpp>

#include "core/real.h"

namespace astrosplat {
namespace {

// Tangent per frame of an automatic handle: that of the neighbours; for scalars limited to three times the
// slopes on either side (Fritsch and Carlson, 1980), and 0 where the values turn.
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

namespace {

// Share of the time over which a constant-speed path with Ends::ease gathers speed, and again loses it.
constexpr double ramp = 0.1;
constexpr int pieces_per_segment = 32;  // of the arc length's quadrature

// The keyframe at or before `frame`, with 0 <= result < size - 1.
template <class T>
std::size_t segment_of(std::span<const Keyframe<T>> keyframes, double frame) {
    auto after = std::ranges::upper_bound(keyframes, frame, {}, &Keyframe<T>::frame);
    auto index = std::size_t(after - keyframes.begin());
    return std::min(index > 0 ? index - 1 : 0, keyframes.size() - 2);
}

template <class T>
double fraction_in(std::span<const Keyframe<T>> keyframes, std::size_t i, double frame) {
    return (frame - keyframes[i].frame) / (keyframes[i + 1].frame - keyframes[i].frame);
}

template <class T>
bool outside(std::span<const Keyframe<T>> keyframes, double frame) {
    return frame <= keyframes.front().frame || frame >= keyframes.back().frame;
}

template <class T>
const T& held(std::span<const Keyframe<T>> keyframes, double frame) {
    return frame <= keyframes.front().frame ? keyframes.front().value : keyframes.back().value;
}

// Cubic Hermite on [0, 1]; tangents per unit of u.
template <class T>
T hermite(const T& a, const T& tangent_a, const T& b, const T& tangent_b, double u) {
    double u2 = u * u, u3 = u2 * u;
    return a * (2.0 * u3 - 3.0 * u2 + 1.0) + tangent_a * (u3 - 2.0 * u2 + u) + b * (3.0 * u2 - 2.0 * u3) +
           tangent_b * (u3 - u2);
}

// Travelled parameter at `frame`, within [0, 1] of segment i, for ascending travelled(0), travelled(1), ...:
// a cubic with the tangents above, limited to three times the neighbouring slopes so that it stays monotone
// (Fritsch and Carlson, 1980).
template <class T, class Travelled>
double smooth_fraction(std::span<const Keyframe<T>> keyframes, const Travelled& travelled, std::size_t i,
                       double frame, Ends ends) {
    double length = travelled(i + 1) - travelled(i);
    if (!(length > 0.0)) return fraction_in(keyframes, i, frame);
    auto slope = [&](std::size_t k) {
        return (travelled(k + 1) - travelled(k)) / (keyframes[k + 1].frame - keyframes[k].frame);
    };
    auto limited = [&](std::size_t k) {
        double m = tangent(keyframes, travelled, k, ends);
        if (k > 0) m = std::fmin(m, 3.0 * slope(k - 1));
        if (k + 1 < keyframes.size()) m = std::fmin(m, 3.0 * slope(k));
        return m * (keyframes[i + 1].frame - keyframes[i].frame) / length;
    };
    return hermite(0.0, limited(i), 1.0, limited(i + 1), fraction_in(keyframes, i, frame));
}

// Positions as a curve: keyframe i lies at knot[i]; centripetal, so a knot interval is the square root of
// the distance.
struct Curve {
    std::span<const Keyframe<glm::dvec3>> keyframes;
    Ends ends;
    std::vector<double> knot;

    double interval(std::size_t i) const { return knot[i + 1] - knot[i]; }
    const glm::dvec3& point(std::size_t i) const { return keyframes[i].value; }
};

Curve make_curve(std::span<const Keyframe<glm::dvec3>> keyframes, Ends ends) {
    Curve curve{keyframes, ends, std::vector<double>(keyframes.size(), 0.0)};
    for (std::size_t i = 0; i + 1 < keyframes.size(); ++i)
        curve.knot[i + 1] =
            curve.knot[i] + std::sqrt(glm::distance(keyframes[i].value, keyframes[i + 1].value));
    return curve;
}

// dP/dknot at keyframe i. A keyframe whose neighbour coincides with it is an end of the curve: one-sided.
glm::dvec3 curve_tangent(const Curve& curve, std::size_t i) {
    bool before = i > 0 && curve.interval(i - 1) > 0.0;
    bool after = i + 1 < curve.keyframes.size() && curve.interval(i) > 0.0;
    glm::dvec3 in(0.0), out(0.0);
    if (before) in = (curve.point(i) - curve.point(i - 1)) / curve.interval(i - 1);
    if (after) out = (curve.point(i + 1) - curve.point(i)) / curve.interval(i);
    if (!before) return out;
    if (!after) return in;
    double both = curve.interval(i - 1) + curve.interval(i);
    return in + out - (curve.point(i + 1) - curve.point(i - 1)) / both;
}

// Point and derivative of segment i at u in [0, 1]. Step segments stay at their first keyframe.
glm::dvec3 curve_point(const Curve& curve, std::size_t i, double u) {
    const glm::dvec3 &a = curve.point(i), &b = curve.point(i + 1);
    if (curve.keyframes[i].interpolation == Interpolation::step) return u < 1.0 ? a : b;
    if (curve.keyframes[i].interpolation == Interpolation::linear) return a + (b - a) * u;
    if (curve.keyframes[i].interpolation == Interpolation::bezier)
        return bezier_segment(curve.keyframes, i, curve.ends).at(u);
    double h = curve.interval(i);
    return hermite(a, curve_tangent(curve, i) * h, b, curve_tangent(curve, i + 1) * h, u);
}

double curve_speed(const Curve& curve, std::size_t i, double u) {
    const glm::dvec3 &a = curve.point(i), &b = curve.point(i + 1);
    if (curve.keyframes[i].interpolation == Interpolation::step) return 0.0;
    if (curve.keyframes[i].interpolation == Interpolation::linear) return glm::distance(a, b);
    if (curve.keyframes[i].interpolation == Interpolation::bezier)
        return glm::length(bezier_segment(curve.keyframes, i, curve.ends).slope(u));
    double h = curve.interval(i);
    glm::dvec3 ta = curve_tangent(curve, i) * h, tb = curve_tangent(curve, i + 1) * h;
    double u2 = u * u;
    return glm::length((b - a) * (6.0 * u - 6.0 * u2) + ta * (3.0 * u2 - 4.0 * u + 1.0) +
                       tb * (3.0 * u2 - 2.0 * u));
}

// Length of segment i between u0 and u1: five-point Gauss-Legendre.
double piece_length(const Curve& curve, std::size_t i, double u0, double u1) {
    constexpr std::array<double, 3> node = {0.0, 0.53846931010568309, 0.90617984593866399};
    constexpr std::array<double, 3> weight = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
    double mid = 0.5 * (u0 + u1), half = 0.5 * (u1 - u0);
    double sum = weight[0] * curve_speed(curve, i, mid);
    for (std::size_t k = 1; k < 3; ++k)
        sum += weight[k] *
               (curve_speed(curve, i, mid - half * node[k]) + curve_speed(curve, i, mid + half * node[k]));
    return sum * half;
}

// Share of the path's length covered after share u of its time.
double distance_share(double u, bool ease_in, bool ease_out) {
    auto ramped = [](double t) { return ramp * t * t * t * (1.0 - 0.5 * t); };  // integral of smoothstep
    double whole = 1.0 - (ease_in ? 0.5 * ramp : 0.0) - (ease_out ? 0.5 * ramp : 0.0);
    if (ease_in && u < ramp) return ramped(u / ramp) / whole;
    if (ease_out && u > 1.0 - ramp) return 1.0 - ramped((1.0 - u) / ramp) / whole;
    return (u - (ease_in ? 0.5 * ramp : 0.0)) / whole;
}

// u in [u0, u1] of segment i at which `length` has been covered since u0: bisection, then the bracket
// is exact.
double solve_length(const Curve& curve, std::size_t i, double u0, double u1, double length) {
    double lo = u0, hi = u1;
    for (int k = 0; k < 50; ++k) {
        double mid = 0.5 * (lo + hi);
        (piece_length(curve, i, u0, mid) < length ? lo : hi) = mid;
    }
    return 0.5 * (lo + hi);
}

glm::dvec3 at_constant_speed(const Curve& curve, double frame, Ends ends) {
    std::span<const Keyframe<glm::dvec3>> keyframes = curve.keyframes;
    std::size_t segments = keyframes.size() - 1;
    auto eased = [&](std::size_t i) {
        const Interpolation way = keyframes[i].interpolation;
        return ends == Ends::ease && (way == Interpolation::smooth || way == Interpolation::bezier);
    };
    double u = (frame - keyframes.front().frame) / (keyframes.back().frame - keyframes.front().frame);
    struct Piece {
        std::size_t segment;
        double begin, end, length;  // of the segment's u
    };
    std::vector<Piece> pieces;
    double total = 0.0;
    for (std::size_t i = 0; i < segments; ++i)
        for (int k = 0; k < pieces_per_segment; ++k) {
            const double begin = double(k) / pieces_per_segment, end = double(k + 1) / pieces_per_segment;
            pieces.push_back({i, begin, end, piece_length(curve, i, begin, end)});
            total += pieces.back().length;
        }
    double rest = distance_share(u, eased(0), eased(segments - 1)) * total;
    for (const auto& [i, begin, end, length] : pieces) {
        if (rest <= length && length > 0.0)
            return curve_point(curve, i, solve_length(curve, i, begin, end, rest));
        rest -= length;
    }
    return keyframes.back().value;  // no length at all, or rounding at the end
}

glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double u) {
    double cosine = glm::dot(a, b);
    if (cosine > 1.0 - 1e-12) return glm::normalize(a + (b - a) * u);
    double angle = real::acos(cosine), sine = real::sin(angle);
    return a * (real::sin((1.0 - u) * angle) / sine) + b * (real::sin(u * angle) / sine);
}

// Unit quaternions, each on the side of the one before, so that every turn takes the shorter way.
std::vector<Keyframe<glm::dvec4>> aligned(std::span<const Keyframe<glm::dvec4>> keyframes) {
    std::vector<Keyframe<glm::dvec4>> result(keyframes.begin(), keyframes.end());
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i].value = glm::normalize(result[i].value);
        if (i > 0 && glm::dot(result[i - 1].value, result[i].value) < 0.0) result[i].value = -result[i].value;
    }
    return result;
}

}  // namespace

double evaluate_scalar(std::span<const Keyframe<double>> keyframes, double frame, Ends ends) {
    assert(!keyframes.empty());
    if (outside(keyframes, frame)) return held(keyframes, frame);
    std::size_t i = segment_of(keyframes, frame);
    double a = keyframes[i].value, b = keyframes[i + 1].value, u = fraction_in(keyframes, i, frame);
    if (keyframes[i].interpolation == Interpolation::step) return a;
    if (keyframes[i].interpolation == Interpolation::linear) return a + (b - a) * u;
    if (keyframes[i].interpolation == Interpolation::bezier) {
        const BezierSegment<double> segment = bezier_segment(keyframes, i, ends);
        return segment.at(segment.parameter(u));
    }
    double span = keyframes[i + 1].frame - keyframes[i].frame;
    auto value = [&](std::size_t k) { return keyframes[k].value; };
    double smooth = hermite(a, tangent(keyframes, value, i, ends) * span, b,
                            tangent(keyframes, value, i + 1, ends) * span, u);
    return std::clamp(smooth, std::fmin(a, b), std::fmax(a, b));
}

glm::dvec3 evaluate_position(std::span<const Keyframe<glm::dvec3>> keyframes, double frame, Ends ends,
                             bool constant_speed) {
    assert(!keyframes.empty());
    if (outside(keyframes, frame)) return held(keyframes, frame);
    Curve curve = make_curve(keyframes, ends);
    if (constant_speed) return at_constant_speed(curve, frame, ends);
    std::size_t i = segment_of(keyframes, frame);
    double u = fraction_in(keyframes, i, frame);
    if (keyframes[i].interpolation == Interpolation::smooth) {
        auto travelled = [&](std::size_t k) { return curve.knot[k]; };
        u = smooth_fraction(keyframes, travelled, i, frame, ends);
    }
    if (keyframes[i].interpolation == Interpolation::bezier)
        u = bezier_segment(keyframes, i, ends).parameter(u);
    return curve_point(curve, i, u);
}

glm::dvec4 evaluate_rotation(std::span<const Keyframe<glm::dvec4>> keyframes, double frame, Ends ends) {
    assert(!keyframes.empty());
    if (outside(keyframes, frame)) return glm::normalize(held(keyframes, frame));
    std::vector<Keyframe<glm::dvec4>> turn = aligned(keyframes);
    std::vector<double> angle(turn.size(), 0.0);
    for (std::size_t i = 0; i + 1 < turn.size(); ++i)
        angle[i + 1] = angle[i] + real::acos(glm::dot(turn[i].value, turn[i + 1].value));
    std::size_t i = segment_of(keyframes, frame);
    double u = fraction_in(keyframes, i, frame);
    if (turn[i].interpolation == Interpolation::step) return turn[i].value;
    const Interpolation way = turn[i].interpolation;
    if (way == Interpolation::smooth || way == Interpolation::bezier) {
        auto travelled = [&](std::size_t k) { return angle[k]; };
        u = smooth_fraction(keyframes, travelled, i, frame, ends);
    }
    return slerp(turn[i].value, turn[i + 1].value, u);
}

}  // namespace astrosplat
