// First each splat is prepared (its reach in voxels, its sum of weights), then pairs of blocks and splats are
// sorted by block, then each block takes its splats in their order.
#include "volumes/voxel_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <memory>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/sorting.h"
#include "volumes/voxel_splats.h"

namespace astrosplat {
namespace {

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
        const auto ny = static_cast<std::uint64_t>(hi.y - lo.y + 1),
                   nz = static_cast<std::uint64_t>(hi.z - lo.z + 1);
        return (static_cast<std::uint64_t>(x - lo.x) * ny + static_cast<std::uint64_t>(y - lo.y)) * nz +
               static_cast<std::uint64_t>(z - lo.z);
    }
    glm::ivec3 place(std::uint64_t number) const {
        const auto ny = static_cast<std::uint64_t>(hi.y - lo.y + 1),
                   nz = static_cast<std::uint64_t>(hi.z - lo.z + 1);
        return lo + glm::ivec3(number / (ny * nz), number / nz % ny, number % nz);
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
                for (int z = lo.z; z <= hi.z; ++z)
                    pairs.push_back({box.number(x, y, z), static_cast<std::uint32_t>(i)});
    }
    scratch.resize(count);
    const auto bits = static_cast<unsigned>(std::bit_width(box.number(box.hi.x, box.hi.y, box.hi.z)));
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
        grid.density[at + i] = static_cast<float>(sums[0][i]);
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
    claim_memory(static_cast<std::int64_t>(splats.size() * (sizeof(VoxelBody) + sizeof(Brought))),
                 "bodies in voxels");
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
    claim_memory(static_cast<std::int64_t>(3 * voxels * (sizeof(float) + 2 * sizeof(glm::vec3))),
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
    claim_memory(count * static_cast<std::int64_t>(2 * sizeof(Pair)), "splats by blocks of voxels");
    if (count > std::numeric_limits<std::uint32_t>::max())
        throw InputError(
            fmt::format("voxels of {:.4g} are too small: the splats would reach {} blocks of them",
                        voxel_size, human_count(double(count))));
    const BlockBox box = box_of(bodies);
    const Buffer<Pair> pairs = sorted_pairs(bodies, box, static_cast<std::size_t>(count), progress);
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (i == 0 || pairs[i].block != pairs[i - 1].block) {
            begins.push_back(i);
            grid.blocks.push_back(box.place(pairs[i].block));
        }
    begins.push_back(pairs.size());
    make_room(grid);
    std::atomic<std::size_t> done{0};
    parallel_for(static_cast<std::int64_t>(grid.blocks.size()), [&](std::int64_t block, int) {
        progress.check();
        const auto b = static_cast<std::size_t>(block);
        const auto sums = std::make_unique<BlockSums>();
        for (std::size_t i = begins[b]; i < begins[b + 1]; ++i)
            add_body(bodies[pairs[i].body], block_side * grid.blocks[b], *sums);
        store_block(*sums, b * block_voxels, grid);
        progress.at(double(++done) / double(grid.blocks.size()));
    });
    return grid;
}

}  // namespace astrosplat
