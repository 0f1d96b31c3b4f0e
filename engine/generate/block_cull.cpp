// The octree over lattice blocks, level by level so that each level is one parallel loop.
#include "generate/block_cull.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tuple>

#include "core/parallel.h"

namespace astrosplat {
namespace {

// Blocks of the next finer level that begin inside the lattice and reach into the range; corners reach one
// cell further than centres.
std::vector<LatticeBlock> split(const std::vector<LatticeBlock>& parents, const Lattice& lattice,
                                const CellRange& range, std::int64_t child_cells) {
    const glm::i64vec3 first = range.lo / child_cells;
    const glm::i64vec3 last = glm::min(lattice.n, range.hi - std::int64_t{1}) / child_cells;
    std::vector<LatticeBlock> children;
    children.reserve(parents.size() * 8);
    for (const LatticeBlock& parent : parents) {
        for (int child = 0; child < 8; ++child) {
            const glm::i64vec3 at =
                parent.at * std::int64_t{2} + glm::i64vec3(child & 1, child >> 1 & 1, child >> 2);
            if (at.x >= first.x && at.y >= first.y && at.z >= first.z && at.x <= last.x && at.y <= last.y &&
                at.z <= last.z)
                children.push_back({at, parent.near_slot});
        }
    }
    return children;
}

void drop_far(std::vector<LatticeBlock>& blocks, std::int64_t cells, const TriangleTree& tree,
              const Lattice& lattice, const CullSettings& settings) {
    parallel_each(blocks.size(), 256, [&](std::size_t i) {
        LatticeBlock& block = blocks[i];
        const BlockBall ball = block_ball(lattice, settings.jitter, block.at * cells, cells);
        block.near_slot =
            closest_point(tree, ball.center, settings.max_distance + ball.radius, block.near_slot).slot;
    });
    std::erase_if(blocks, [](const LatticeBlock& block) { return block.near_slot == ClosestPoint::none; });
}

}  // namespace

BlockBall block_ball(const Lattice& lattice, double jitter, const glm::i64vec3& first, std::int64_t cells) {
    const glm::i64vec3 last_corner = glm::min(first + (cells - 1), lattice.n);
    const glm::i64vec3 last_centre = glm::min(first + (cells - 1), lattice.n - std::int64_t{1});
    const glm::dvec3 last = glm::max(glm::dvec3(last_corner), glm::dvec3(last_centre) + 0.5);
    const glm::dvec3 low = glm::dvec3(first) - 0.5 * jitter, high = last + 0.5 * jitter;
    const glm::dvec3 spacing = lattice.spacing();
    const glm::dvec3 size = glm::max(glm::abs(lattice.box.lo), glm::abs(lattice.box.hi));
    const double rounding =
        1e-14 * (size.x + size.y + size.z);  // of positions and of the middle, many times over
    return {lattice.box.lo + spacing * ((low + high) * 0.5),
            glm::length(spacing * ((high - low) * 0.5)) * (1.0 + 1e-9) + rounding};
}

std::vector<LatticeBlock> blocks_near(const TriangleTree& tree, const Lattice& lattice,
                                      const CullSettings& settings, const Progress& progress,
                                      const CellRange& range) {
    std::int64_t cells = block_cells;
    while (cells <= std::max({lattice.n.x, lattice.n.y, lattice.n.z})) cells *= 2;
    std::vector<LatticeBlock> blocks{{glm::i64vec3(0), ClosestPoint::none}};
    while (true) {
        progress.check();
        drop_far(blocks, cells, tree, lattice, settings);
        if (cells == block_cells) break;
        cells /= 2;
        blocks = split(blocks, lattice, range, cells);
    }
    std::ranges::sort(blocks, [](const LatticeBlock& a, const LatticeBlock& b) {
        return std::tie(a.at.z, a.at.y, a.at.x) < std::tie(b.at.z, b.at.y, b.at.x);
    });
    return blocks;
}

}  // namespace astrosplat
