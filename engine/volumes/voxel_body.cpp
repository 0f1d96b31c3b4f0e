#include "volumes/voxel_body.h"

#include <algorithm>
#include <cmath>

#include "core/real.h"

namespace astrosplat {
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
