// A set while it is generated, thinned out so that it can be shown. In: the splats as threads keep them. Out:
// a fair sample of what there is so far. Never reaches the set itself.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "generate/kept_store.h"

namespace astrosplat {

class GrowingSet : public KeptWatcher {
  public:
    /// A sample has at most `limit` splats, and about a half of that or more once as many are kept.
    explicit GrowingSet(std::int64_t limit) : limit_(static_cast<std::size_t>(limit)) {}

    void begins(const SplatSet& empty, const Bounds& box) override;
    void keeps(std::span<const KeptStore::Run> runs) override;

    /// Splats kept so far.
    std::int64_t kept() const { return kept_; }

    struct Sample {
        std::shared_ptr<const SplatSet> set;  // any prefix is a fair sample too, as a preview needs it
        std::int64_t kept = 0;                // what it is a sample of
        Bounds box;                           // that the whole set will have, about; layer space
    };
    /// What there is now; a set of none before the first splat. A splat drawn by chance: the same splats come
    /// first in every sample, so that frames of one after the other do not flicker.
    Sample sample() const;

  private:
    using Ranked = std::pair<std::uint32_t, KeptSplat>;  // by chance; the lowest ranks stay

    void take(const std::vector<Ranked>& found);

    std::size_t limit_;
    std::atomic<std::int64_t> kept_{0};
    std::atomic<std::uint32_t> highest_rank_{~std::uint32_t{0}};
    mutable std::mutex mutex_;  // for all below
    std::vector<Ranked> splats_;
    SplatSet empty_;
    Bounds box_;
};

}  // namespace astrosplat
