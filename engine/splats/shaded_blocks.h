// Shaded splats of a layer that is never in memory as a whole: blocks of neighbours, each made anew whenever
// it is asked for. What is known of every block, and a sample of it, stay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/bounds.h"
#include "splats/shaded_splats.h"

namespace astrosplat {

/// A block after the look. Without splats the box is empty.
struct BlockFacts {
    Bounds box;           // of the splats' centres, layer space
    float radius = 0.0f;  // the largest, scene units
    std::int64_t splats = 0;
    std::int64_t first_sample = 0;  // its rows of the sample begin here, and end where the next block's begin
};

class ShadedBlocks {
  public:
    /// Of one block; ties are told from each other with 16 bits.
    static constexpr std::int64_t most_splats = 65536;

    virtual ~ShadedBlocks() = default;

    /// The blocks in the file's order; one more at the end, which only says where the sample ends.
    const std::vector<BlockFacts>& blocks() const { return blocks_; }
    std::size_t size() const { return blocks_.empty() ? 0 : blocks_.size() - 1; }
    /// Rows of all blocks, evenly spread over each.
    const ShadedSplats& sample() const { return sample_; }
    std::int64_t splats() const { return splats_; }
    /// alpha * brightest channel, of all splats.
    float largest_light() const { return largest_light_; }

    /// Makes a block, in the file's order of rows; the arrays' memory is used again. From any thread, several
    /// at a time. Throws InputError where the file has changed.
    virtual void shade(std::size_t block, ShadedSplats& out) const = 0;

  protected:
    std::vector<BlockFacts> blocks_;
    ShadedSplats sample_;
    std::int64_t splats_ = 0;
    float largest_light_ = 0.0f;
};

}  // namespace astrosplat
