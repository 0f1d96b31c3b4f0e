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

/// Some of the positions of columns, those of alpha 0 among them.
struct ColumnSample {
    std::shared_ptr<const SplatSet> set;  // with faces
    std::int64_t of = 0;                  // positions that there are
};

class GrowingSet : public KeptWatcher {
  public:
    /// A sample has at most `limit` splats, and about a half of that or more once as many are kept; that of
    /// finished columns at most `column_limit` positions.
    explicit GrowingSet(std::int64_t limit, std::int64_t column_limit = 0)
        : limit_(static_cast<std::size_t>(limit)), column_limit_(column_limit) {}

    void begins(const SplatSet& empty, const Bounds& box) override;
    void keeps(std::span<const KeptStore::Run> runs) override;
    std::int64_t sample_limit() const override { return column_limit_; }
    void ends(Columns sample, std::int64_t of) override;

    /// Splats kept so far.
    std::int64_t kept() const { return kept_; }

    struct Sample {
        std::shared_ptr<const SplatSet> set;  // any prefix is a fair sample too, as a preview needs it
        std::int64_t kept = 0;                // what it is a sample of
        Bounds box;                           // that the whole set will have, about; layer space
    };
    /// Positions of finished columns, spread evenly over them; without a set where there are none.
    ColumnSample columns() const;

    /// The sample so far; a set of none before the first splat. A splat drawn by chance: the same splats come
    /// first in every sample, so that frames of one after the other do not flicker.
    Sample sample() const;

  private:
    using Ranked = std::pair<std::uint32_t, KeptSplat>;  // by chance; the lowest ranks stay

    void take(const std::vector<Ranked>& found);

    std::size_t limit_;
    std::int64_t column_limit_;
    std::atomic<std::int64_t> kept_{0};
    std::atomic<std::uint32_t> highest_rank_{~std::uint32_t{0}};
    mutable std::mutex mutex_;  // for all below
    std::vector<Ranked> splats_;
    SplatSet empty_;
    Bounds box_;
    ColumnSample columns_;
};

}  // namespace astrosplat
