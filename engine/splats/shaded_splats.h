// A layer's splats after the look: what is drawn, still in layer space; of layers that are never in memory as
// a whole, in blocks of neighbours, each made anew whenever it is asked for.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/bounds.h"
#include "core/buffer.h"

namespace astrosplat {

/// In ascending order of id.
struct ShadedSplats {
    Buffer<glm::vec3> position;  // scene units, layer space
    Buffer<glm::vec3> color;     // linear light, straight, >= 0; all below 0: it absorbs, see RenderLayer
    Buffer<float> alpha;         // 0..1
    Buffer<float> radius;        // scene units, where the falloff reaches zero
    Buffer<std::uint64_t> id;
    /// Empty: all are balls. Else of each splat: what the ball becomes, around its centre, layer space.
    Buffer<glm::mat3> stretch;
    /// Another number whenever the arrays change, of all splats there are: who keeps a copy knows by it. 0:
    /// not counted.
    std::uint64_t stamp = 0;
    bool encoded = false;  // colours are display values (sRGB), composited as such: of isolated layers only

    std::int64_t size() const { return std::int64_t(position.size()); }
};

/// Calls visit(pointer to member) for all arrays but stretch, which look/apply.h adds.
template <class Visit>
void for_each_member(const Visit& visit) {
    visit(&ShadedSplats::position);
    visit(&ShadedSplats::color);
    visit(&ShadedSplats::alpha);
    visit(&ShadedSplats::radius);
    visit(&ShadedSplats::id);
}

/// Calls visit(array) for the same.
template <class Visit>
void for_each_array(ShadedSplats& splats, const Visit& visit) {
    for_each_member([&](auto member) { visit(splats.*member); });
}

/// A block after the look. Without splats the box is empty.
struct BlockFacts {
    Bounds box;           // of the splats' centres, layer space
    float radius = 0.0f;  // the largest, scene units
    std::int64_t splats = 0;
    std::int64_t first_sample = 0;  // its rows of the sample begin here, and end where the next block's begin
};

/// Facts about every block, and a sample of all splats, stay in memory.
class ShadedBlocks {
  public:
    /// Of one block; ties are broken with 16 bits.
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
