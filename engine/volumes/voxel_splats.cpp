#include "volumes/voxel_splats.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/memory.h"
#include "core/real.h"
#include "core/sorting.h"
#include "gaussians/gaussians.h"

namespace astrosplat {

namespace {

/// m m^T times `square`.
Symmetric covariance_of(const glm::dmat3& m, double square) {
    const auto entry = [&](int i, int j) {
        return square * (m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j]);
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

double mean_deviation(const VoxelSplat& splat) {
    const Symmetric& c = splat.covariance;
    return std::sqrt((c[0] + c[1] + c[2]) / 3.0);
}

}  // namespace

double footprint_area(const Symmetric& c, const glm::dvec3& n) {
    const double xx = c[1] * c[2] - c[5] * c[5], yy = c[0] * c[2] - c[4] * c[4],
                 zz = c[0] * c[1] - c[3] * c[3], xy = c[4] * c[5] - c[3] * c[2],
                 xz = c[3] * c[5] - c[4] * c[1], yz = c[3] * c[4] - c[5] * c[0];
    const double form = n.x * n.x * xx + n.y * n.y * yy + n.z * n.z * zz +
                        2.0 * (n.x * n.y * xy + n.x * n.z * xz + n.y * n.z * yz);
    return 2.0 * real::pi * std::sqrt(std::max(0.0, form));
}

void add_voxel_splats(const RenderLayer& layer, const Camera& camera, double gain,
                      std::vector<VoxelSplat>& out, BakeCounts& counts) {
    const std::size_t all = out.size() + layer.splats->position.size();
    claim_memory(static_cast<std::int64_t>(all * sizeof(VoxelSplat)), "splats that fill voxels");
    out.reserve(all);
    const LayerAppearance appearance(layer, camera, gain);
    const bool ball = layer.splats->stretch.empty();
    for (std::size_t i = 0; i < layer.splats->position.size(); ++i) {
        const SplatAppearance seen = appearance.of(i, counts);
        VoxelSplat splat;
        splat.place = seen.place;
        splat.ray = glm::vec3(direction_to(camera, seen.place));
        splat.ball = ball;
        const double square = seen.sigma * seen.sigma;
        splat.covariance = ball ? Symmetric{square, square, square, 0.0, 0.0, 0.0}
                                : covariance_of(appearance.axes_of(i), square);
        splat.shows = static_cast<float>(seen.shows);
        splat.hides = static_cast<float>(seen.hides);
        splat.light = glm::vec3(seen.light);
        const bool shines = splat.light != glm::vec3(0.0f) || splat.hides > 0.0f;
        if (shines && footprint_area(splat.covariance, glm::dvec3(splat.ray)) > 0.0)
            out.push_back(splat);
        else
            ++counts.unseen;
    }
}

double default_voxel_size(const std::vector<VoxelSplat>& splats) {
    constexpr double reach = 3.0;  // standard deviations
    glm::dvec3 lo(1e300), hi(-1e300);
    std::vector<float> deviations;
    deviations.reserve(splats.size());
    for (const VoxelSplat& splat : splats) {
        const double deviation = mean_deviation(splat);
        deviations.push_back(static_cast<float>(deviation));
        lo = glm::min(lo, splat.place - reach * deviation);
        hi = glm::max(hi, splat.place + reach * deviation);
    }
    const double longest = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    return std::clamp(double(median(deviations)), longest / 512.0, longest / 128.0);
}

namespace {

constexpr double filter_variance = 0.25;  // square voxels
constexpr double cut = 4.0;               // standard deviations

Symmetric inverse(const Symmetric& c) {
    const double xx = c[1] * c[2] - c[5] * c[5], xy = c[4] * c[5] - c[3] * c[2],
                 xz = c[3] * c[5] - c[4] * c[1];
    const double d = c[0] * xx + c[3] * xy + c[4] * xz;
    return {xx / d, (c[0] * c[2] - c[4] * c[4]) / d, (c[0] * c[1] - c[3] * c[3]) / d, xy / d,
            xz / d, (c[3] * c[4] - c[5] * c[0]) / d};
}

double gauss(double square) { return real::exp(-0.5 * square); }

double sum_of_weights(const VoxelBody& body) {
    double sum = 0.0;
    if (body.ball) {
        std::array<double, 3> sums{};
        for (int k = 0; k < 3; ++k)
            for (int i = body.lo[k]; i <= body.hi[k]; ++i) sums[k] += weight_along(body, k, i);
        return sums[0] * sums[1] * sums[2];
    }
    for (int x = body.lo.x; x <= body.hi.x; ++x)
        for (int y = body.lo.y; y <= body.hi.y; ++y)
            for (int z = body.lo.z; z <= body.hi.z; ++z) sum += weight_of_ellipsoid(body, {x, y, z});
    return sum;
}

}  // namespace

double voxel_reach(const Symmetric& c, double voxel_size) {
    return cut * std::sqrt(std::max({c[0], c[1], c[2]}) + filter_variance * voxel_size * voxel_size);
}

double weight_along(const VoxelBody& body, int k, int i) {
    const double d = i - body.centre[k];
    return gauss(body.precision[0] * d * d);
}

double weight_of_ellipsoid(const VoxelBody& body, const glm::ivec3& voxel) {
    const Symmetric& p = body.precision;
    const glm::dvec3 d = glm::dvec3(voxel) - body.centre;
    const double square = p[0] * d.x * d.x + p[1] * d.y * d.y + p[2] * d.z * d.z +
                          2.0 * (p[3] * d.x * d.y + p[4] * d.x * d.z + p[5] * d.y * d.z);
    return square <= cut * cut ? gauss(square) : 0.0;
}

VoxelBody voxel_body(const VoxelSplat& splat, double voxel_size, Brought& brought) {
    VoxelBody body;
    body.ball = splat.ball;
    body.centre = splat.place / voxel_size;
    Symmetric narrow{}, wide{};
    for (std::size_t k = 0; k < wide.size(); ++k) {
        narrow[k] = splat.covariance[k] / (voxel_size * voxel_size);
        wide[k] = narrow[k] + (k < 3 ? filter_variance : 0.0);
    }
    for (int k = 0; k < 3; ++k) {
        const double reach = cut * std::sqrt(wide[static_cast<std::size_t>(k)]);
        body.lo[k] = static_cast<int>(std::ceil(body.centre[k] - reach));
        body.hi[k] = static_cast<int>(std::floor(body.centre[k] + reach));
    }
    body.precision = inverse(wide);
    const glm::dvec3 ray(splat.ray);
    const double area = footprint_area(splat.covariance, ray);
    const double hidden = splat.hides * footprint_area(narrow, ray) / footprint_area(wide, ray);
    const double put = hidden > 0.0 ? area * optical_depth_that_hides(hidden) / hidden : area;
    brought.density = put * splat.hides;
    brought.emission = put * glm::dvec3(splat.light);
    const double scale = 1.0 / (sum_of_weights(body) * voxel_size * voxel_size * voxel_size);
    body.share = {scale * brought.density, scale * brought.emission.x, scale * brought.emission.y,
                  scale * brought.emission.z, scale * put * splat.shows};
    return body;
}

double optical_depth_that_hides(double hidden) {
    double t = hidden;
    for (int step = 0; step < 8; ++step) {
        // Ein(t), and its derivative (1 - e^-t) / t, as series.
        double power = 1.0, ein = 0.0, slope = 0.0;
        for (int k = 1; k <= 40; ++k) {
            slope += power / k;  // power: (-t)^(k-1) / (k-1)!
            ein += power * t / (double(k) * k);
            power *= -t / k;
        }
        t += (hidden - ein) / slope;
    }
    return t;
}

}  // namespace astrosplat
