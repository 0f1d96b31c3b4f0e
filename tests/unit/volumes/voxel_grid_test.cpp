// Splats in voxels: sums, middles and widths in closed form, what is seen through the grid by going along its
// columns, and the same bits for any threads.
#include "volumes/voxel_grid.h"

#include <numbers>

#include "support/test.h"

namespace astrosplat::test {
namespace {

constexpr double pi = std::numbers::pi;

VoxelSplat ball(const glm::dvec3& place, double sigma, float hides, const glm::vec3& light) {
    VoxelSplat splat;
    splat.place = place;
    splat.ray = {0.0f, 0.0f, -1.0f};
    splat.covariance = {sigma * sigma, sigma * sigma, sigma * sigma, 0.0, 0.0, 0.0};
    splat.shows = splat.hides = hides;
    splat.light = light;
    return splat;
}

/// Visits every voxel with its place in the world, in order.
template <class Visit>
void each_voxel(const VoxelGrid& grid, const Visit& visit) {
    for (std::size_t i = 0; i < grid.density.size(); ++i) {
        const auto in = int(i % block_voxels);
        const glm::ivec3 voxel =
            block_side * grid.blocks[i / block_voxels] + glm::ivec3(in / 64, in / 8 % 8, in % 8);
        visit(grid.voxel_size * glm::dvec3(voxel), i);
    }
}

double volume_of(const VoxelGrid& grid) { return std::pow(grid.voxel_size, 3.0); }

struct Moments {
    double sum = 0.0;
    glm::dvec3 middle{0.0};
    Symmetric spread{};
};

Moments moments_of(const VoxelGrid& grid) {
    Moments m;
    each_voxel(grid, [&](const glm::dvec3& p, std::size_t i) {
        m.sum += grid.density[i];
        m.middle += double(grid.density[i]) * p;
    });
    m.middle /= m.sum;
    each_voxel(grid, [&](const glm::dvec3& p, std::size_t i) {
        const glm::dvec3 d = p - m.middle;
        const double w = grid.density[i] / m.sum;
        const std::array<double, 6> products = {d.x * d.x, d.y * d.y, d.z * d.z,
                                                d.x * d.y, d.x * d.z, d.y * d.z};
        for (std::size_t k = 0; k < 6; ++k) m.spread[k] += w * products[k];
    });
    m.sum *= volume_of(grid);
    return m;
}

TEST(Voxels, OfAThinSplatHaveItsIntegralMiddleAndWidth) {
    for (const double h : {0.02, 0.1, 0.35}) {
        const double sigma = 0.1;
        const glm::dvec3 place(0.123, -0.456, 7.891);
        const VoxelGrid grid = fill_voxels({ball(place, sigma, 1e-4f, {2e-4f, 1e-4f, 0.0f})}, h);
        const Moments m = moments_of(grid);
        const double put = 2.0 * pi * sigma * sigma * 1e-4;
        EXPECT_NEAR(m.sum / put, 1.0, 1e-4) << h;
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(m.middle[k], place[k], 0.025 * h) << h;
            EXPECT_NEAR(m.spread[std::size_t(k)], sigma * sigma + 0.25 * h * h,
                        0.03 * h * h + 0.004 * sigma * sigma)
                << h;
        }
        glm::dvec3 light(0.0);
        each_voxel(grid, [&](const glm::dvec3&, std::size_t i) { light += glm::dvec3(grid.emission[i]); });
        EXPECT_NEAR(light.x * volume_of(grid) / (2.0 * put), 1.0, 1e-4);
        EXPECT_NEAR(light.y * volume_of(grid) / put, 1.0, 1e-4);
        EXPECT_EQ(light.z, 0.0);
        EXPECT_NEAR(grid.density_put / put, 1.0, 1e-4);
    }
}

TEST(Voxels, StandAtMultiplesOfTheirSide) {
    const VoxelGrid grid = fill_voxels({ball({-3.0, 0.5, 2.0}, 0.02, 0.5f, glm::vec3(0.5f))}, 0.5);
    double most = 0.0;
    glm::dvec3 place(0.0);
    each_voxel(grid, [&](const glm::dvec3& p, std::size_t i) {
        if (grid.density[i] > most) most = grid.density[i], place = p;
    });
    EXPECT_EQ(place, glm::dvec3(-3.0, 0.5, 2.0));
    EXPECT_EQ(grid.blocks.size(), 2u);  // two voxels each way from (-6, 1, 4): -8..-4, -1..3, 2..6
}

// Ein(1) = 0.7965995992970531 (Abramowitz and Stegun 5.1.40: E1(1) + ln 1 + gamma).
TEST(Voxels, OpticalDepthHidesWhatIsAsked) {
    EXPECT_NEAR(optical_depth_that_hides(0.7965995992970531), 1.0, 1e-12);
    EXPECT_EQ(optical_depth_that_hides(0.0), 0.0);
    for (const double t : {1e-6, 0.3, 1.3, 2.4}) {
        double ein = 0.0;  // by the midpoint rule over (1 - e^-x) / x
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double x = t * (i + 0.5) / steps;
            ein += (1.0 - std::exp(-x)) / x * t / steps;
        }
        EXPECT_NEAR(optical_depth_that_hides(ein), t, 1e-8 * std::max(1.0, t));
    }
}

struct Seen {
    double hidden = 0.0, light = 0.0;
};

/// Light that leaves a grid of one splat along z; each voxel hides a part of its own.
Seen seen_along_z(const VoxelGrid& grid) {
    std::map<std::pair<double, double>, std::vector<std::size_t>> columns;
    each_voxel(grid, [&](const glm::dvec3& p, std::size_t i) { columns[{p.x, p.y}].push_back(i); });
    Seen seen;
    for (const auto& [place, column] : columns) {
        double through = 1.0;
        for (const std::size_t i : column) {  // ascending z: from behind, which is the same for one splat
            const double depth = grid.density[i] * grid.voxel_size;
            const double share = depth > 1e-9 ? (1.0 - std::exp(-depth)) / depth : 1.0;
            seen.light += through * share * grid.emission[i].x * grid.voxel_size;
            through *= std::exp(-depth);
        }
        seen.hidden += 1.0 - through;
    }
    seen.hidden *= grid.voxel_size * grid.voxel_size;
    seen.light *= grid.voxel_size * grid.voxel_size;
    return seen;
}

TEST(Voxels, OfASplatAloneHideAndShineWhatItDoes) {
    const double sigma = 0.1, area = 2.0 * pi * sigma * sigma;
    for (const float hides : {0.05f, 0.5f, 1.0f, 1.386f})
        for (const double h : {0.02, 0.1, 0.3}) {
            const VoxelSplat splat = ball({0.02, 0.03, 0.04}, sigma, hides, glm::vec3(0.75f * hides));
            const Seen seen = seen_along_z(fill_voxels({splat}, h));
            // Of a splat a third as wide as a voxel only three samples a side count.
            const double limit = h > sigma ? 0.01 : 0.002;
            EXPECT_NEAR(seen.hidden / (hides * area), 1.0, limit) << hides << " in voxels of " << h;
            EXPECT_NEAR(seen.light / (0.75 * hides * area), 1.0, limit) << hides << " in voxels of " << h;
        }
}

TEST(Voxels, OfLightThatHidesNothingHoldItAll) {
    VoxelSplat splat = ball({0.0, 0.0, 0.0}, 0.1, 0.5f, {1.5f, 0.75f, 0.0f});
    splat.hides = 0.0f;
    const VoxelGrid grid = fill_voxels({splat}, 0.05);
    glm::dvec3 light(0.0);
    double density = 0.0;
    each_voxel(grid, [&](const glm::dvec3&, std::size_t i) {
        light += glm::dvec3(grid.emission[i]);
        density += grid.density[i];
        if (grid.emission[i].x > 0.0f) {
            EXPECT_NEAR(grid.color[i].x, 3.0f, 1e-5f);
            EXPECT_NEAR(grid.color[i].y, 1.5f, 1e-5f);
        }
    });
    EXPECT_EQ(density, 0.0);
    EXPECT_NEAR(light.x * volume_of(grid), 1.5 * 2.0 * pi * 0.01, 1e-6);
}

TEST(Voxels, ColourTimesDensityIsTheLightOfWhatBlendsOver) {
    std::vector<VoxelSplat> splats;
    for (int i = 0; i < 20; ++i)
        splats.push_back(ball({0.05 * i, 0.02 * (i % 5), 0.01 * i}, 0.03 + 0.004 * i, 0.04f * float(i + 1),
                              0.04f * float(i + 1) * glm::vec3(0.1f * float(i % 7), 0.5f, 1.0f)));
    const VoxelGrid grid = fill_voxels(splats, 0.04);
    float worst = 0.0f;
    each_voxel(grid, [&](const glm::dvec3&, std::size_t i) {
        for (int k = 0; k < 3; ++k)
            worst = std::max(worst, std::fabs(grid.color[i][k] * grid.density[i] - grid.emission[i][k]) /
                                        (grid.emission[i][k] + 1e-30f));
    });
    EXPECT_LT(worst, 1e-5f);
}

/// A needle along (1, 2, 2) / 3, three times as long as wide.
VoxelSplat needle(const glm::vec3& ray) {
    const double wide = 0.01,
                 more = 0.08;  // variances: of the width, and by how much that of the length is larger
    VoxelSplat splat = ball({0.3, 0.2, 0.1}, 0.1, 1e-4f, glm::vec3(1e-4f));
    splat.ball = false;
    splat.ray = ray;
    splat.covariance = {wide + more / 9, wide + more * 4 / 9, wide + more * 4 / 9,
                        more * 2 / 9,    more * 2 / 9,        more * 4 / 9};
    return splat;
}

TEST(Voxels, OfANeedleHaveTheFootprintThatIsSeen) {
    const double wide = 0.1, longer = 0.3, h = 0.05;
    const VoxelGrid across = fill_voxels({needle(glm::vec3(2.0f, 1.0f, -2.0f) / 3.0f)}, h);
    const VoxelGrid along = fill_voxels({needle(glm::vec3(1.0f, 2.0f, 2.0f) / 3.0f)}, h);
    const Moments a = moments_of(across), b = moments_of(along);
    EXPECT_NEAR(a.sum / (2.0 * pi * wide * longer * 1e-4), 1.0, 2e-3);
    EXPECT_NEAR(b.sum / (2.0 * pi * wide * wide * 1e-4), 1.0, 2e-3);
    const Symmetric expected = needle({}).covariance;
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(a.spread[k], expected[k] + (k < 3 ? 0.25 * h * h : 0.0), 5e-4) << k;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.middle[k], (glm::dvec3(0.3, 0.2, 0.1))[k], 1e-3);
}

TEST(Voxels, AreAsWideAsTheSplatsWithinBounds) {
    std::vector<VoxelSplat> splats = {ball({0.0, 0.0, 0.0}, 0.004, 1.0f, glm::vec3(1.0f)),
                                      ball({1.0, 0.0, 0.0}, 0.004, 1.0f, glm::vec3(1.0f)),
                                      ball({0.5, 0.0, 0.0}, 0.004, 1.0f, glm::vec3(1.0f))};
    EXPECT_NEAR(default_voxel_size(splats), 0.004, 1e-6);
    for (VoxelSplat& splat : splats) splat.covariance = {1e-10, 1e-10, 1e-10, 0.0, 0.0, 0.0};
    EXPECT_NEAR(default_voxel_size(splats), 1.0 / 512, 1e-5);
    splats.resize(1);
    EXPECT_NEAR(default_voxel_size(splats), 6e-5 / 128, 1e-10);
}

TEST(Voxels, TooSmallAreRefused) {
    const auto message = [](const VoxelSplat& splat, double h) -> std::string {
        try {
            fill_voxels({splat}, h);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    const char* const expected = "voxels of 0.001 are too small: the splats reach further than";
    EXPECT_EQ(message(ball({1e4, 0.0, 0.0}, 0.1, 1.0f, glm::vec3(1.0f)), 1e-3).rfind(expected, 0), 0u);
    EXPECT_NE(message(ball({0.0, 0.0, 0.0}, 100.0, 1.0f, glm::vec3(1.0f)), 2e-3), "");
}

}  // namespace
}  // namespace astrosplat::test
