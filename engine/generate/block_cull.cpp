// The octree over lattice blocks, level by level so that each level is one parallel loop.
#include "generate/block_cull.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <tuple>

#include "core/parallel.h"
#include "generate/cluster_filter.h"

namespace astrosplat {
namespace {

// How much farther than the closest place the one may be that is found, in radii of a block.
constexpr double tolerated = 0.2;

// Blocks of the next finer level that begin inside the lattice; corners reach one cell further than centres.
std::vector<LatticeBlock> split(const std::vector<LatticeBlock>& parents, const Lattice& lattice,
                                std::int64_t child_cells) {
    const glm::i64vec3 last = lattice.n / child_cells;
    std::vector<LatticeBlock> children;
    children.reserve(parents.size() * 8);
    for (const LatticeBlock& parent : parents) {
        for (int child = 0; child < 8; ++child) {
            const glm::i64vec3 at =
                parent.at * std::int64_t{2} + glm::i64vec3(child & 1, child >> 1 & 1, child >> 2);
            if (at.x <= last.x && at.y <= last.y && at.z <= last.z)
                children.push_back({at, 0.0, parent.near_slot, 0, nullptr});
        }
    }
    return children;
}

void drop_far(std::vector<LatticeBlock>& blocks, std::int64_t cells, const ClosestPointIndex& index,
              const Lattice& lattice, const CullSettings& settings) {
    parallel_chunks(
        static_cast<std::int64_t>(blocks.size()), 256, [&](std::int64_t begin, std::int64_t end, int) {
            for (std::int64_t i = begin; i < end; ++i) {
                LatticeBlock& block = blocks[static_cast<std::size_t>(i)];
                const BlockBall ball = block_ball(lattice, settings.jitter, block.at * cells, cells);
                const NearPlace near = index.near_place(ball.center, settings.max_distance + ball.radius,
                                                        tolerated * ball.radius, block.near_slot);
                block.near_slot = near.slot;
                block.distance = near.distance;
            }
        });
    std::erase_if(blocks, [](const LatticeBlock& block) { return block.near_slot == ClosestPoint::none; });
}

Bisectors bisectors_of(const BlockBall& ball, const NearPlace& near, const glm::dvec3& origin, double slack) {
    const glm::dvec3 middle = ball.center - near.at;
    const double reach = glm::length(middle) + glm::length(ball.half);
    return {near.at - origin, middle - ball.half, middle + ball.half,
            static_cast<float>(32.0 * (reach + slack) * (slack + 1e-6 * reach))};
}

// One thread's lists of clusters, in pieces that stay where they are.
class ClusterStore {
  public:
    // Room for `count` numbers, of which take() then keeps some.
    std::uint32_t* room(std::size_t count) {
        if (static_cast<std::size_t>(end_ - next_) < count) {
            constexpr std::size_t piece = std::size_t{1} << 20;  // whole huge pages
            next_ = pieces_.emplace_back(std::max(piece, count)).data();
            end_ = next_ + pieces_.back().size();
        }
        return next_;
    }
    void take(std::size_t count) { next_ += count; }
    std::vector<Buffer<std::uint32_t>>& pieces() { return pieces_; }

  private:
    std::vector<Buffer<std::uint32_t>> pieces_;
    std::uint32_t *next_ = nullptr, *end_ = nullptr;
};

// What a tile of 2^3 blocks knows is enough for each of its blocks.
class TileCull {
  public:
    TileCull(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings)
        : index_(index), lattice_(lattice), settings_(settings) {}

    void run(const LatticeBlock& tile, std::vector<LatticeBlock>& found) {
        const std::int64_t cells = 2 * block_cells;
        const BlockBall ball = block_ball(lattice_, settings_.jitter, tile.at * cells, cells);
        known_ = index_.collect(ball.center, candidate_radius(settings_, ball, tile.distance), list_);
        for (LatticeBlock& block : split({tile}, lattice_, block_cells)) add_if_near(block, found);
    }

    ClusterStore& clusters() { return clusters_; }

  private:
    void add_if_near(LatticeBlock& block, std::vector<LatticeBlock>& found) {
        const BlockBall ball = block_ball(lattice_, settings_.jitter, block.at * block_cells, block_cells);
        const double reach = settings_.max_distance + ball.radius;
        const double tolerance = tolerated * ball.radius;
        if (known_) measure_boxes(list_, glm::vec3(ball.center - index_.origin()));
        const NearPlace near = known_ ? index_.near_place(list_, ball.center, reach, tolerance)
                                      : index_.near_place(ball.center, reach, tolerance, block.near_slot);
        if (near.slot == ClosestPoint::none) return;
        block.near_slot = near.slot;
        block.distance = near.distance;
        if (known_ && !add_clusters(ball, near, block)) return;
        found.push_back(block);
    }

    // From the list, whose distances are those from the ball's middle. False when no cluster can matter,
    // which happens where the near place is of a disc that comes nearer than its triangle.
    bool add_clusters(const BlockBall& ball, const NearPlace& near, LatticeBlock& block) {
        const double slack = index_.slack(ball.center, 2.0 * ball.radius);
        const double radius = candidate_radius(settings_, ball, block.distance) * 1.00001 + slack;
        const auto limit = static_cast<float>(radius * radius);
        Bisectors bisectors = bisectors_of(ball, near, index_.origin(), slack);
        if (!index_.has_plane(near.slot)) bisectors.rounding = std::numeric_limits<float>::infinity();
        std::uint32_t* const numbers = clusters_.room(list_.count + 64);
        const std::size_t count = filter_clusters(list_, limit, bisectors, numbers);
        if (count <= LatticeBlock::most_clusters) {
            block.clusters = numbers;
            block.cluster_count = static_cast<std::uint32_t>(count);
            clusters_.take(count);
        }
        return count > 0;
    }

    const ClosestPointIndex& index_;
    const Lattice& lattice_;
    const CullSettings& settings_;
    ClusterList list_;   // of the tile
    bool known_ = true;  // whether all of its clusters fit in there
    ClusterStore clusters_;
};

NearBlocks blocks_of(const std::vector<LatticeBlock>& tiles, const ClosestPointIndex& index,
                     const Lattice& lattice, const CullSettings& settings) {
    constexpr std::size_t chunk = 32;
    std::vector<std::vector<LatticeBlock>> chunks((tiles.size() + chunk - 1) / chunk);
    std::vector<std::unique_ptr<TileCull>> culls(static_cast<std::size_t>(thread_count()));
    parallel_for(static_cast<std::int64_t>(chunks.size()), [&](std::int64_t number, int worker) {
        const auto c = static_cast<std::size_t>(number);
        std::unique_ptr<TileCull>& cull = culls[static_cast<std::size_t>(worker)];
        if (!cull) cull = std::make_unique<TileCull>(index, lattice, settings);
        for (std::size_t i = c * chunk; i < std::min((c + 1) * chunk, tiles.size()); ++i)
            cull->run(tiles[i], chunks[c]);
    });
    NearBlocks near;
    near.blocks.reserve(8 * tiles.size());
    for (const std::vector<LatticeBlock>& found : chunks)
        near.blocks.insert(near.blocks.end(), found.begin(), found.end());
    for (const std::unique_ptr<TileCull>& cull : culls) {
        if (!cull) continue;
        for (Buffer<std::uint32_t>& piece : cull->clusters().pieces())
            near.clusters.push_back(std::move(piece));
    }
    return near;
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
    const glm::dvec3 half = spacing * ((high - low) * 0.5);
    return {lattice.box.lo + spacing * ((low + high) * 0.5), glm::length(half) * (1.0 + 1e-9) + rounding,
            half * (1.0 + 1e-9) + rounding};
}

// A triangle that is closest to a position p of the ball is no farther from its middle than |p - middle| +
// distance(p), and distance(p) is at most both max_distance and distance(middle) + |p - middle|.
double candidate_radius(const CullSettings& settings, const BlockBall& ball, double distance) {
    return (ball.radius + std::min(settings.max_distance, distance + ball.radius)) * (1.0 + 1e-9);
}

NearBlocks blocks_near(const ClosestPointIndex& index, const Lattice& lattice, const CullSettings& settings,
                       const Progress& progress) {
    constexpr std::int64_t tile_cells = 2 * block_cells;
    std::int64_t cells = tile_cells;
    while (cells <= std::max({lattice.n.x, lattice.n.y, lattice.n.z})) cells *= 2;
    std::vector<LatticeBlock> tiles{{glm::i64vec3(0), 0.0, ClosestPoint::none, 0, nullptr}};
    while (true) {
        progress.check();
        drop_far(tiles, cells, index, lattice, settings);
        if (cells == tile_cells) break;
        cells /= 2;
        tiles = split(tiles, lattice, cells);
    }
    NearBlocks near = blocks_of(tiles, index, lattice, settings);
    std::sort(near.blocks.begin(), near.blocks.end(), [](const LatticeBlock& a, const LatticeBlock& b) {
        return std::tie(a.at.z, a.at.y, a.at.x) < std::tie(b.at.z, b.at.y, b.at.x);
    });
    return near;
}

}  // namespace astrosplat
