// Where threads put the splats they keep before anyone knows how many there will be, and how those are
// appended to a set in ascending order of id. In: splats in runs of ascending ids.
// Out: the arrays of a SplatSet.
#pragma once

#include "core/bounds.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Everything generation stores about a position that it keeps.
struct KeptSplat {
    glm::vec3 position, color;
    float alpha, distance;
    std::uint64_t id;
    glm::vec2 uv;
    glm::vec3 normal;
    std::uint32_t mesh, face;
};
/// The columns of a generated set: all but the files' own radius.
constexpr bool is_generated(SplatColumn column) {
    return column < SplatColumn::radius || column == SplatColumn::face;
}

/// The splats that one thread keeps, in blocks that stay where they are and serve again after clear(). A run
/// has ascending ids, and no other run has ids in between.
class KeptStore {
  public:
    struct Run {
        const KeptSplat* splats;
        std::size_t count;
        std::size_t lit;  // of these: their alpha is not 0
    };
    void begin_run() { open_ = false; }
    void add(const KeptSplat& splat) {
        if (next_ == end_) next_block();
        if (!open_) runs_.push_back({next_, 0, 0});
        open_ = true;
        ++runs_.back().count;
        if (splat.alpha > 0.0f) ++runs_.back().lit;
        *next_++ = splat;
    }
    const std::vector<Run>& runs() const { return runs_; }
    void clear() {
        runs_.clear();
        used_ = 0;
        next_ = end_ = nullptr;
        open_ = false;
    }

  private:
    // A run that reaches the end of its block goes on as another.
    void next_block() {
        constexpr std::size_t block_splats = (std::size_t{4} << 20) / sizeof(KeptSplat);  // whole huge pages
        if (used_ == blocks_.size()) blocks_.emplace_back(block_splats);
        next_ = blocks_[used_++].data();
        end_ = next_ + block_splats;
        open_ = false;
    }

    std::vector<Buffer<KeptSplat>> blocks_;  // filled one after the other
    std::vector<Run> runs_;
    std::size_t used_ = 0;  // blocks
    KeptSplat *next_ = nullptr, *end_ = nullptr;
    bool open_ = false;
};

struct Columns;

/// Who wants to see a set while it is generated. What is made of the splats never reaches the set.
class KeptWatcher {
  public:
    virtual ~KeptWatcher() = default;
    /// Each kept position once, those of alpha 0 among them, in runs of ascending ids that come in any order;
    /// from any thread, several at a time. The runs are gone after the call, which keeps the thread from its
    /// work: it is to be short.
    virtual void keeps(std::span<const KeptStore::Run> runs) = 0;
    /// So many of all positions it wants to see in the end, at most.
    virtual std::int64_t sample_limit() const = 0;
    /// Once, when all are there: `sample` of so many, spread evenly over them. Also for columns that were
    /// found in a cache.
    virtual void ends(Columns sample, std::int64_t of) = 0;
};

/// Those columns, for `size` splats; what is new in them has no values yet.
void resize(SplatSet& set, std::size_t size);
/// Fills in a row of them.
void put(const KeptSplat& splat, SplatSet& set, std::size_t row);
/// Address space for `count` splats; memory is taken only where it is written.
void reserve(SplatSet& set, std::size_t count);

/// Appends the splats of some runs to `set`, ordered by id.
void append_sorted(std::span<const KeptStore::Run> runs, SplatSet& set);

}  // namespace astrosplat
