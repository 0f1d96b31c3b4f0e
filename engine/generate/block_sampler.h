// The splats of lattice blocks. In: a row of blocks, the meshes' index, what their triangles look like. Out:
// the splats of the row's corners, and of its centres those near enough to become one, in the stores of the
// thread that asks; both depend on the row alone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "generate/block_cull.h"
#include "generate/block_kernel.h"
#include "generate/closest_point.h"
#include "generate/kept_store.h"
#include "generate/surface.h"

namespace astrosplat {

/// A position that is near enough, before the picture says whether it is kept.
struct Hit {
    std::uint64_t id;
    glm::vec3 position;
    float distance;
    glm::vec2 uv;
    std::uint32_t triangle;
};

/// Blocks too small to stay mapped once they are freed (core/buffer): they make room for the set.
using HitStore = RunStore<Hit, std::size_t{3} << 20>;

/// What one thread works with and what it finds.
struct SamplerWorker {
    std::vector<BlockAnswers> answers;
    std::unique_ptr<BlockScratch> scratch = std::make_unique<BlockScratch>();
    KeptStore kept;
    HitStore centres;
    std::int64_t zero_alpha = 0;  // positions dropped because their alpha is exactly 0
};

/// Refers to what it is made from.
class BlockSampler {
  public:
    static constexpr std::size_t longest_row = 32;  // blocks: their answers stay in the second-level cache

    BlockSampler(const ClosestPointIndex& index, const Buffer<SurfaceTriangle>& surface,
                 const Lattice& lattice, const CullSettings& settings)
        : index_(index), surface_(surface), lattice_(lattice), settings_(settings) {}

    /// Keeps the splats of the corners, and the hits of the centres, of 1..longest_row blocks with the same
    /// (y, z) and ascending x.
    void measure(std::span<const LatticeBlock> row, SamplerWorker& worker) const;

    /// Keeps the splats of hits.
    void keep(std::span<const HitStore::Run> runs, SamplerWorker& worker) const;

  private:
    template <class Store, class Visit>
    void each_hit(std::span<const LatticeBlock> row, Positions kind, std::span<const BlockAnswers> answers,
                  Store& store, const Visit& visit) const;
    template <class Visit>
    void each_hit_of_block(const glm::i64vec3& first, Positions kind, std::size_t j, std::size_t k,
                           const BlockAnswers& answers, const Visit& visit) const;
    Hit hit_of(const BlockAnswers& answers, std::size_t slot, std::uint64_t id) const;
    void add_splat(const Hit& hit, SamplerWorker& worker) const;

    const ClosestPointIndex& index_;
    const Buffer<SurfaceTriangle>& surface_;
    const Lattice& lattice_;
    const CullSettings& settings_;
};

}  // namespace astrosplat
