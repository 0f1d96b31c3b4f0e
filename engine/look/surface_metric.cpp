// A least-squares plane says how places follow from u and v; its metric turns a width into steps of u and v.
#include "look/surface_metric.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace astrosplat {
namespace {

constexpr double least_samples = 8.0;  // of a block, for a plane through them
constexpr double share_about_one = 0.125, share_on_surface = 0.75;
constexpr double least_part = 24.0;  // samples

// Places as a linear function of u and v, by least squares, and the direction in which they lie off it.
struct Plane {
    glm::dvec2 middle{0.0};
    glm::dvec3 place{0.0}, along_u{0.0}, along_v{0.0}, normal{0.0};
    bool known = false;
};

void fit_slopes(const SurfaceSamples& samples, std::size_t count, Plane& plane) {
    for (std::size_t i = 0; i < count; ++i) plane.middle += samples[i].at, plane.place += samples[i].place;
    plane.middle /= static_cast<double>(count), plane.place /= static_cast<double>(count);
    double uu = 0.0, uv = 0.0, vv = 0.0;
    glm::dvec3 pu(0.0), pv(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec2 d = samples[i].at - plane.middle;
        uu += d.x * d.x, uv += d.x * d.y, vv += d.y * d.y;
        pu += (samples[i].place - plane.place) * d.x, pv += (samples[i].place - plane.place) * d.y;
    }
    const double spread = uu * vv - uv * uv;
    plane.known = uu > 0.0 && vv > 0.0 && spread > 1e-6 * uu * vv;
    if (!plane.known) return;
    plane.along_u = (pu * vv - pv * uv) / spread, plane.along_v = (pv * uu - pu * uv) / spread;
}

glm::dvec3 off_plane(const Plane& plane, const SurfaceSample& sample) {
    const glm::dvec2 d = sample.at - plane.middle;
    return sample.place - plane.place - plane.along_u * d.x - plane.along_v * d.y;
}

// Where positions lie off the plane most, by powers of their covariance. The plane itself leans by chance,
// where a thick layer has few samples; its slopes along the normal are that chance.
void find_normal(const SurfaceSamples& samples, std::size_t count, Plane& plane) {
    glm::dmat3 covariance(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 off = off_plane(plane, samples[i]);
        for (int c = 0; c < 3; ++c) covariance[c] += off * off[c];
    }
    int most = 0;
    for (int c = 1; c < 3; ++c)
        if (covariance[c][c] > covariance[most][most]) most = c;
    glm::dvec3 normal = covariance[most];
    for (int n = 0; n < 16 && glm::dot(normal, normal) > 0.0; ++n) {
        normal /= std::sqrt(glm::dot(normal, normal));
        normal = covariance[0] * normal.x + covariance[1] * normal.y + covariance[2] * normal.z;
    }
    const double length = std::sqrt(glm::dot(normal, normal));
    plane.normal = length > 0.0 ? normal / length : glm::dvec3(0.0);
    plane.along_u -= plane.normal * glm::dot(plane.along_u, plane.normal);
    plane.along_v -= plane.normal * glm::dot(plane.along_v, plane.normal);
}

Plane plane_through(const SurfaceSamples& samples, std::size_t count) {
    Plane plane;
    if (static_cast<double>(count) < least_samples) return plane;
    fit_slopes(samples, count, plane);
    if (plane.known) find_normal(samples, count, plane);
    return plane;
}

// Squared distance along the plane from where u and v put a sample.
double astray(const Plane& plane, const SurfaceSample& sample) {
    const glm::dvec3 off = off_plane(plane, sample);
    const double across = glm::dot(off, plane.normal);
    return glm::dot(off, off) - across * across;
}

// The part that lies about one of them: other parts of the mesh may have the same u and v. Of these the ones
// that are most astray are left out: positions beyond the edge of a mesh have the edge's u and v.
Plane surface_plane(SurfaceSamples& samples, const glm::dvec2& middle) {
    const auto first = [&](double share) {
        const double part = static_cast<double>(samples.size()) * share;
        return static_cast<std::ptrdiff_t>(
            std::min(static_cast<double>(samples.size()), std::max(part, least_part)));
    };
    if (samples.empty()) return {};
    const auto off = [](const auto& d) { return glm::dot(d, d); };
    const glm::dvec3 about = std::ranges::min_element(samples, {}, [&](const SurfaceSample& s) {
                                 return off(s.at - middle);
                             })->place;
    const std::ptrdiff_t near = first(share_about_one), kept = first(share_about_one * share_on_surface);
    std::ranges::nth_element(samples, samples.begin() + near, {},
                             [&](const SurfaceSample& s) { return off(s.place - about); });
    Plane plane = plane_through(samples, static_cast<std::size_t>(near));
    for (int round = 0; round < 2 && plane.known; ++round) {
        std::ranges::nth_element(samples.begin(), samples.begin() + kept, samples.begin() + near, {},
                                 [&](const SurfaceSample& s) { return astray(plane, s); });
        plane = plane_through(samples, static_cast<std::size_t>(kept));
    }
    return plane;
}

}  // namespace

SurfaceMetric surface_metric(SurfaceSamples& samples, const glm::dvec2& middle, double falloff_variance) {
    const Plane plane = surface_plane(samples, middle);
    double light = 0.0, light_r2 = 0.0;
    for (const SurfaceSample& s : samples) light += s.light, light_r2 += s.light * s.r2;
    if (!plane.known || !(light > 0.0)) return {};
    const double e = glm::dot(plane.along_u, plane.along_u), f = glm::dot(plane.along_u, plane.along_v),
                 g = glm::dot(plane.along_v, plane.along_v);
    const double determinant = e * g - f * f;
    if (!(determinant > 1e-6 * e * g)) return {};
    const double variance = falloff_variance * light_r2 / light;
    return {std::sqrt(variance * g / determinant), std::sqrt(variance * e / determinant),
            std::sqrt(determinant)};
}

}  // namespace astrosplat
