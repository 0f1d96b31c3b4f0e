#include "volumes/voxel_splats.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/memory.h"
#include "core/real.h"
#include "core/sorting.h"
#include "gaussians/appearance.h"

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
        splat.ray = glm::vec3(appearance.ray_to(seen.place));
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

}  // namespace astrosplat
