// Greedy: each segment reaches as far as it can. Then the tolerance is lowered while the number of segments
// stays, so that the last one is no rest of the others.
#include "edit/fit_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "camera/keyframe.h"

namespace astrosplat {
namespace {

constexpr int samples = 16;               // of a segment, where it is compared with the path
constexpr double least_step = 1.0 / 512;  // of a handle's length, as a share of its segment

/// A segment whose handles have the path's velocities, `out` and `in` of its frames long.
struct FittedSegment {
    double out = 1.0 / 3.0, in = 1.0 / 3.0;
    double error = 0.0;  // the largest distance to the path at the same frame, scene units
};

class Fitter {
  public:
    Fitter(const PathInTime& path, double first, double last) : path_(path), first_(first), last_(last) {}

    /// Keyframes as counts of frames from the first.
    std::vector<double> greedy(double tolerance) const {
        std::vector<double> ends = {0.0};
        const double length = last_ - first_;
        while (ends.back() < length) {
            double lo = ends.back() + 1.0, hi = length;
            while (lo < hi) {
                const double mid = std::floor(0.5 * (lo + hi + 1.0));
                if (best(ends.back(), mid).error < tolerance)
                    lo = mid;
                else
                    hi = mid - 1.0;
            }
            ends.push_back(std::fmin(lo, length));
        }
        return ends;
    }

    /// By turns one handle, the other, or both at once, in ever smaller steps.
    FittedSegment best(double from, double to) const {
        constexpr std::array<std::array<double, 2>, 6> ways = {
            {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}};
        FittedSegment found;
        found.error = error_of(found, from, to);
        for (double step = 0.25; step > least_step;) {
            const FittedSegment before = found;
            for (const auto& [out, in] : ways) {
                FittedSegment next{std::clamp(before.out + out * step, 0.0, 1.0),
                                   std::clamp(before.in + in * step, 0.0, 1.0)};
                next.error = error_of(next, from, to);
                if (next.error < found.error) found = next;
            }
            if (found.error == before.error) step *= 0.5;
        }
        return found;
    }

    glm::dvec3 place(double at) const { return path_(first_ + at); }

    /// Scene units a frame.
    glm::dvec3 velocity(double at) const {
        constexpr double h = 1e-3;
        const double before = std::fmax(0.0, at - h), after = std::fmin(last_ - first_, at + h);
        return (place(after) - place(before)) / (after - before);
    }

  private:
    double error_of(const FittedSegment& segment, double from, double to) const {
        const double span = to - from;
        const glm::dvec3 a = place(from), d = place(to);
        const glm::dvec3 b = a + velocity(from) * (segment.out * span),
                         c = d - velocity(to) * (segment.in * span);
        double most = 0.0;
        for (int i = 1; i < samples; ++i) {
            const double u = static_cast<double>(i) / samples;
            const double at = from + span * bezier_point(0.0, segment.out, 1.0 - segment.in, 1.0, u);
            most = std::fmax(most, glm::distance(bezier_point(a, b, c, d, u), place(at)));
        }
        return most;
    }

    const PathInTime& path_;
    double first_, last_;
};

}  // namespace

std::vector<Keyframe<glm::dvec3>> fit_path(const PathInTime& path, double first, double last,
                                           double tolerance) {
    const Fitter fitter(path, first, last);
    std::vector<double> ends = fitter.greedy(tolerance);
    for (int i = 0; i < 20; ++i) {
        std::vector<double> more_even = fitter.greedy(tolerance *= 0.9);
        if (more_even.size() > ends.size()) break;
        ends = std::move(more_even);
    }
    std::vector<Keyframe<glm::dvec3>> keyframes;
    for (const double at : ends)
        keyframes.push_back({first + at, fitter.place(at), Interpolation::bezier, {}, {}});
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        const FittedSegment segment = fitter.best(ends[i], ends[i + 1]);
        const double span = ends[i + 1] - ends[i], out = segment.out * span, in = segment.in * span;
        keyframes[i].out = {HandleKind::free, out, fitter.velocity(ends[i]) * out};
        keyframes[i + 1].in = {HandleKind::free, -in, fitter.velocity(ends[i + 1]) * -in};
    }
    return keyframes;
}

}  // namespace astrosplat
