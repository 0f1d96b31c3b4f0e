// Every splat has a rank of chance. Those below a highest rank are in the sample; whenever it is full the
// highest rank is halved. Of many splats only some are looked at: one in n, with a rank of n times the
// chance, is as fair, and costs a generation next to nothing.
#include "viewer/growing_set.h"

#include <algorithm>
#include <bit>

#include "core/shared_maths.h"
#include "generate/generate.h"

namespace astrosplat {
namespace {

/// Random numbers of nobody else: a rank that went with, say, the density's choice would make the sample
/// unfair.
std::uint32_t rank_of(std::uint64_t id) {
    constexpr std::uint32_t seed = 2, purpose = 0;
    return shared::as_hash(seed, static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32),
                           purpose);
}

/// One splat in 2^this is looked at: four times as many as the sample takes.
int log_step(std::uint32_t highest_rank) { return std::max(0, std::countl_zero(highest_rank) - 2); }

}  // namespace

void GrowingSet::begins(const SplatSet& empty, const Bounds& box) {
    const std::lock_guard lock(mutex_);
    empty_ = empty;
    box_ = box;
    splats_.reserve(limit_ + 1);
}

void GrowingSet::keeps(std::span<const KeptStore::Run> runs) {
    if (runs.empty()) return;
    const std::uint32_t highest = highest_rank_;
    const int shift = log_step(highest);
    const std::size_t step = std::size_t{1} << shift;
    std::vector<Ranked> found;
    std::size_t first = 0;  // of a run, among the positions of this call
    std::size_t lit = 0;
    std::size_t next = rank_of(~runs.front().splats->id) % step;
    for (const KeptStore::Run& run : runs) {
        for (; next < first + run.count; next += step) {
            const KeptSplat& splat = run.splats[next - first];
            const std::uint32_t rank = rank_of(splat.id) >> shift;
            if (rank <= highest && splat.alpha > 0.0f) found.emplace_back(rank, splat);
        }
        first += run.count;
        lit += run.lit;
    }
    kept_ += static_cast<std::int64_t>(lit);
    take(found);
}

void GrowingSet::take(const std::vector<Ranked>& found) {
    const std::lock_guard lock(mutex_);
    for (const Ranked& splat : found) {
        if (splat.first > highest_rank_) continue;  // which another thread has halved since
        splats_.push_back(splat);
        if (splats_.size() <= limit_) continue;
        highest_rank_ = highest_rank_ / 2;
        std::erase_if(splats_, [&](const Ranked& s) { return s.first > highest_rank_; });
    }
}

void GrowingSet::ends(Columns sample, std::int64_t of) {
    if (column_limit_ <= 0) return;
    const std::lock_guard lock(mutex_);
    columns_ = {std::make_shared<const SplatSet>(std::move(sample.splats)), of};
}

ColumnSample GrowingSet::columns() const {
    const std::lock_guard lock(mutex_);
    return columns_;
}

GrowingSet::Sample GrowingSet::sample() const {
    Sample sample;
    SplatSet set;
    std::vector<Ranked> splats;
    {
        const std::lock_guard lock(mutex_);
        splats = splats_;
        set = empty_;
        sample.box = box_;
        sample.kept = kept_;
    }
    std::vector<std::pair<std::uint64_t, const KeptSplat*>> order;  // by rank, equal ones by id
    order.reserve(splats.size());
    for (const auto& [rank, splat] : splats)
        order.emplace_back(std::uint64_t{rank} << 32 | (splat.id & 0xffffffffu), &splat);
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    resize(set, order.size());
    for (std::size_t row = 0; row < order.size(); ++row) put(*order[row].second, set, row);
    sample.set = std::make_shared<const SplatSet>(std::move(set));
    return sample;
}

}  // namespace astrosplat
