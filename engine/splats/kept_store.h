// Where threads put the splats they keep before anyone knows how many there will be, and how those become one
// set in ascending order of id. In: splats in runs of ascending ids. Out: the arrays of a SplatSet.
#pragma once

#include <cstdint>
#include <list>
#include <vector>

#include "splats/splat_set.h"

namespace astrosplat {

/// Everything generation stores about a splat.
struct KeptSplat {
    glm::vec3 position, color;
    float alpha, distance;
    std::uint64_t id;
    glm::vec2 uv;
    glm::vec3 normal;
    std::uint32_t mesh;
};
constexpr std::int64_t kept_splat_bytes = 3 * 12 + 8 + 8 + 2 * 4 + 4;  // in a SplatSet's arrays

/// Splats with ascending ids that lie next to each other in a page; no other run has ids in between.
struct KeptRun {
    std::uint64_t first_id;
    SplatSet* page;
    std::size_t begin, count;
};

/// One thread's splats, in pages of fixed size.
class KeptStore {
  public:
    void begin_run() { open_ = false; }
    void add(const KeptSplat& splat);
    const std::vector<KeptRun>& runs() const { return runs_; }

  private:
    void open_run(std::uint64_t first_id);

    std::list<SplatSet> pages_;  // addresses stay
    std::size_t used_ = 0;       // of the last page
    std::vector<KeptRun> runs_;
    bool open_ = false;
};

/// Moves all stores' splats into `set`, ordered by id. The stores are empty afterwards; at most one attribute
/// exists twice at a time.
void gather(std::vector<KeptStore>& stores, SplatSet& set);

}  // namespace astrosplat
