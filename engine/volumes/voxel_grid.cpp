// First each splat becomes a body (its reach in voxels, its sum of weights), then pairs of blocks and bodies
// are sorted by block, then each block takes its bodies in their order.
#include "volumes/voxel_grid.h"

#include <fmt/format.h>

#include <glm/common.hpp>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/real.h"
#include "core/sorting.h"

namespace astrosplat {
namespace {

/// m m^T times `square`.
Symmetric covariance_of(const glm::dmat3& m, double square) {
    const auto entry = [&](int i, int j) {
        return square * (m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j]);
    };
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

Symmetric adjugate_of(const Symmetric& c) {
    return {c[1] * c[2] - c[5] * c[5], c[0] * c[2] - c[4] * c[4], c[0] * c[1] - c[3] * c[3],
            c[4] * c[5] - c[3] * c[2], c[3] * c[5] - c[4] * c[1], c[3] * c[4] - c[5] * c[0]};
}

/// Area that the weight e^(-d^2 / 2) of a covariance has on a frame across `n`, in its square units:
/// 2 pi sqrt(n . adj(covariance) n).
double footprint_area(const Symmetric& covariance, const glm::dvec3& n) {
    const Symmetric a = adjugate_of(covariance);
    const double form = n.x * n.x * a[0] + n.y * n.y * a[1] + n.z * n.z * a[2] +
                        2.0 * (n.x * n.y * a[3] + n.x * n.z * a[4] + n.y * n.z * a[5]);
    return 2.0 * real::pi * std::sqrt(std::max(0.0, form));
}

double mean_deviation(const VoxelSplat& splat) {
    const Symmetric& c = splat.covariance;
    return std::sqrt((c[0] + c[1] + c[2]) / 3.0);
}

}  // namespace

void add_voxel_splats(const RenderLayer& layer, const Camera& camera, double gain,
                      std::vector<VoxelSplat>& out, BakeCounts& counts) {
    const std::size_t all = out.size() + layer.splats->position.size();
    claim_memory(std::int64_t(all * sizeof(VoxelSplat)), "splats that fill voxels");
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
        splat.shows = float(seen.shows);
        splat.hides = float(seen.hides);
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
        deviations.push_back(float(deviation));
        lo = glm::min(lo, splat.place - reach * deviation);
        hi = glm::max(hi, splat.place + reach * deviation);
    }
    const double longest = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    return std::clamp(double(median(deviations)), longest / 512.0, longest / 128.0);
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

namespace {

constexpr double filter_variance = 0.25;  // square voxels
constexpr double cut = 4.0;               // standard deviations

/// Sums of a voxel: density, three channels of light, and what shows.
constexpr int voxel_channels = 5;

/// In voxels; voxel (i, j, k) is sampled at the point (i, j, k).
struct VoxelBody {
    glm::dvec3 centre{0.0};
    glm::ivec3 lo{0}, hi{0};  // voxels that it reaches, both included
    bool ball = true;
    Symmetric precision{};                       // inverse of the covariance
    std::array<double, voxel_channels> share{};  // what it brings to a voxel of weight 1
};

/// The whole of what a splat adds, square scene units.
struct Brought {
    double density = 0.0;
    glm::dvec3 emission{0.0};
};

Symmetric inverse(const Symmetric& c) {
    Symmetric a = adjugate_of(c);
    const double determinant = c[0] * a[0] + c[3] * a[3] + c[4] * a[4];
    for (double& entry : a) entry /= determinant;
    return a;
}

double gauss(double square) { return real::exp(-0.5 * square); }

/// e^(-d^2 / 2) of a ball along axis k at voxel i; its weight is the product of three.
double weight_along(const VoxelBody& body, int k, int i) {
    const double d = i - body.centre[k];
    return gauss(body.precision[0] * d * d);
}

/// The weight of a body that is no ball, 0 beyond four standard deviations.
double weight_of_ellipsoid(const VoxelBody& body, const glm::ivec3& voxel) {
    const Symmetric& p = body.precision;
    const glm::dvec3 d = glm::dvec3(voxel) - body.centre;
    const double square = p[0] * d.x * d.x + p[1] * d.y * d.y + p[2] * d.z * d.z +
                          2.0 * (p[3] * d.x * d.y + p[4] * d.x * d.z + p[5] * d.y * d.z);
    return square <= cut * cut ? gauss(square) : 0.0;
}

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

/// How far a splat may reach from its centre, scene units.
double voxel_reach(const Symmetric& c, double voxel_size) {
    return cut * std::sqrt(std::max({c[0], c[1], c[2]}) + filter_variance * voxel_size * voxel_size);
}

/// The body of a splat; its weights times its shares, times the voxel's volume, sum up to what it brings.
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
        const double reach = cut * std::sqrt(wide[k]);
        body.lo[k] = int(std::ceil(body.centre[k] - reach));
        body.hi[k] = int(std::floor(body.centre[k] + reach));
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

constexpr double farthest = 1 << 20;  // voxels from the origin

struct Pair {
    std::uint64_t block;
    std::uint32_t body;
};

glm::ivec3 block_of(const glm::ivec3& voxel) { return voxel >> 3; }

/// Numbers blocks of a box in ascending order of x, y, z.
struct BlockBox {
    glm::ivec3 lo{std::numeric_limits<int>::max()}, hi{std::numeric_limits<int>::min()};

    std::uint64_t number(int x, int y, int z) const {
        const glm::u64vec3 side(hi - lo + 1), from_lo(glm::ivec3(x, y, z) - lo);
        return (from_lo.x * side.y + from_lo.y) * side.z + from_lo.z;
    }
    glm::ivec3 place(std::uint64_t number) const {
        const glm::u64vec3 side(hi - lo + 1);
        return lo + glm::ivec3(number / (side.y * side.z), number / side.z % side.y, number % side.z);
    }
};

/// Pairs in ascending order of block, then body.
Buffer<Pair> sorted_pairs(const std::vector<VoxelBody>& bodies, const BlockBox& box, std::size_t count,
                          const Progress& progress) {
    Buffer<Pair> pairs, scratch;
    pairs.reserve(count);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const glm::ivec3 lo = block_of(bodies[i].lo), hi = block_of(bodies[i].hi);
        for (int x = lo.x; x <= hi.x; ++x)
            for (int y = lo.y; y <= hi.y; ++y)
                for (int z = lo.z; z <= hi.z; ++z) pairs.push_back({box.number(x, y, z), std::uint32_t(i)});
    }
    scratch.resize(count);
    const auto bits = unsigned(std::bit_width(box.number(box.hi.x, box.hi.y, box.hi.z)));
    const Pair* sorted = radix_sort<11>(
        pairs.data(), scratch.data(), count, 0, bits, [](const Pair& pair) { return pair.block; },
        [&] { progress.check(); });
    return sorted == pairs.data() ? std::move(pairs) : std::move(scratch);
}

using BlockSums = std::array<std::array<double, block_voxels>, voxel_channels>;

/// Adds a body's part of the block whose first voxel is `first`.
void add_body(const VoxelBody& body, const glm::ivec3& first, BlockSums& sums) {
    const glm::ivec3 lo = glm::max(body.lo - first, glm::ivec3(0)),
                     hi = glm::min(body.hi - first, glm::ivec3(block_side - 1));
    std::array<std::array<double, block_side>, 3> along{};
    if (body.ball)
        for (int k = 0; k < 3; ++k)
            for (int i = lo[k]; i <= hi[k]; ++i) {
                along[k][i] = weight_along(body, k, first[k] + i);
            }
    for (int x = lo.x; x <= hi.x; ++x)
        for (int y = lo.y; y <= hi.y; ++y) {
            std::array<double, block_side> weight{};
            if (body.ball)
                for (int z = 0; z < block_side; ++z) weight[z] = along[0][x] * along[1][y] * along[2][z];
            else
                for (int z = lo.z; z <= hi.z; ++z)
                    weight[z] = weight_of_ellipsoid(body, first + glm::ivec3(x, y, z));
            const int row = (x * block_side + y) * block_side;
            for (int c = 0; c < voxel_channels; ++c)
                for (int z = 0; z < block_side; ++z) sums[c][row + z] += body.share[c] * weight[z];
        }
}

void store_block(const BlockSums& sums, std::size_t at, VoxelGrid& grid) {
    for (std::size_t i = 0; i < block_voxels; ++i) {
        const glm::dvec3 light(sums[1][i], sums[2][i], sums[3][i]);
        grid.density[at + i] = float(sums[0][i]);
        grid.emission[at + i] = glm::vec3(light);
        grid.color[at + i] = sums[4][i] > 0.0 ? glm::vec3(light / sums[4][i]) : glm::vec3(0.0f);
    }
}

void refuse_too_far(const std::vector<VoxelSplat>& splats, double voxel_size) {
    for (const VoxelSplat& splat : splats) {
        const double reach = voxel_reach(splat.covariance, voxel_size) + 2.0 * block_side * voxel_size;
        for (int k = 0; k < 3; ++k)
            if (!(std::fabs(splat.place[k]) + reach < farthest * voxel_size))
                throw InputError(fmt::format(
                    "voxels of {:.4g} are too small: the splats reach further than {} of them from "
                    "the scene's origin",
                    voxel_size, farthest));
    }
}

/// The bodies of all splats; what they bring goes into the grid.
std::vector<VoxelBody> bodies_of(const std::vector<VoxelSplat>& splats, VoxelGrid& grid,
                                 const Progress& progress) {
    claim_memory(std::int64_t(splats.size() * (sizeof(VoxelBody) + sizeof(Brought))), "bodies in voxels");
    std::vector<VoxelBody> bodies(splats.size());
    std::vector<Brought> brought(splats.size());
    parallel_each(splats.size(), 1 << 10, [&](std::size_t i) {
        if (i % 64 == 0) progress.check();
        bodies[i] = voxel_body(splats[i], grid.voxel_size, brought[i]);
    });
    for (const Brought& one : brought) {
        grid.density_put += one.density;
        grid.emission_put += one.emission;
    }
    return bodies;
}

BlockBox box_of(const std::vector<VoxelBody>& bodies) {
    BlockBox box;
    for (const VoxelBody& body : bodies) {
        box.lo = glm::min(box.lo, block_of(body.lo));
        box.hi = glm::max(box.hi, block_of(body.hi));
    }
    return box;
}

/// How many blocks all bodies reach, each counted for itself.
std::int64_t pairs_of(const std::vector<VoxelBody>& bodies) {
    std::int64_t count = 0;
    for (const VoxelBody& body : bodies) {
        const glm::i64vec3 side(block_of(body.hi) - block_of(body.lo) + 1);
        count += side.x * side.y * side.z;
    }
    return count;
}

void make_room(VoxelGrid& grid) {
    const std::size_t voxels = grid.blocks.size() * block_voxels;
    // Once here, once in the tree that is written, and once more in the file's bytes.
    claim_memory(std::int64_t(3 * voxels * (sizeof(float) + 2 * sizeof(glm::vec3))),
                 fmt::format("{} voxels of {:.4g}", human_count(double(voxels)), grid.voxel_size));
    grid.density.resize(voxels);
    grid.emission.resize(voxels);
    grid.color.resize(voxels);
}

}  // namespace

VoxelGrid fill_voxels(const std::vector<VoxelSplat>& splats, double voxel_size, const Progress& progress) {
    refuse_too_far(splats, voxel_size);
    VoxelGrid grid;
    grid.voxel_size = voxel_size;
    const std::vector<VoxelBody> bodies = bodies_of(splats, grid, progress);
    const std::int64_t count = pairs_of(bodies);
    claim_memory(count * std::int64_t(2 * sizeof(Pair)), "splats by blocks of voxels");
    if (count > std::numeric_limits<std::uint32_t>::max())
        throw InputError(
            fmt::format("voxels of {:.4g} are too small: the splats would reach {} blocks of them",
                        voxel_size, human_count(double(count))));
    const BlockBox box = box_of(bodies);
    const Buffer<Pair> pairs = sorted_pairs(bodies, box, std::size_t(count), progress);
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (i == 0 || pairs[i].block != pairs[i - 1].block) {
            begins.push_back(i);
            grid.blocks.push_back(box.place(pairs[i].block));
        }
    begins.push_back(pairs.size());
    make_room(grid);
    std::atomic<std::size_t> done{0};
    parallel_for(std::int64_t(grid.blocks.size()), [&](std::int64_t block, int) {
        progress.check();
        const auto b = std::size_t(block);
        const auto sums = std::make_unique<BlockSums>();
        for (std::size_t i = begins[b]; i < begins[b + 1]; ++i)
            add_body(bodies[pairs[i].body], block_side * grid.blocks[b], *sums);
        store_block(*sums, b * block_voxels, grid);
        progress.at(double(++done) / double(grid.blocks.size()));
    });
    return grid;
}

}  // namespace astrosplat
