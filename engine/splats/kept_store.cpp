// Appending kept splats to a set, in order and in parallel.
#include "splats/kept_store.h"

#include <algorithm>

#include "core/parallel.h"

namespace astrosplat {
namespace {

template <class Visit>
void for_each_array(SplatSet& set, Visit visit) {
    visit(set.position);
    visit(set.color);
    visit(set.alpha);
    visit(set.distance);
    visit(set.id);
    visit(set.uv);
    visit(set.normal);
    visit(set.mesh);
}

struct Move {
    const KeptSplat* from;
    std::size_t count, to;
};

void unpack(const Move& move, SplatSet& set) {
    for (std::size_t i = 0; i < move.count; ++i) {
        const KeptSplat& splat = move.from[i];
        const std::size_t to = move.to + i;
        set.position[to] = splat.position;
        set.color[to] = splat.color;
        set.alpha[to] = splat.alpha;
        set.distance[to] = splat.distance;
        set.id[to] = splat.id;
        set.uv[to] = splat.uv;
        set.normal[to] = splat.normal;
        set.mesh[to] = splat.mesh;
    }
}

}  // namespace

// A run that reaches the end of its block goes on as another.
void KeptStore::next_block() {
    constexpr std::size_t block_splats = (std::size_t{4} << 20) / sizeof(KeptSplat);  // whole huge pages
    if (used_ == blocks_.size()) blocks_.emplace_back(block_splats);
    next_ = blocks_[used_++].data();
    end_ = next_ + block_splats;
    open_ = false;
}

void KeptStore::clear() {
    runs_.clear();
    used_ = 0;
    next_ = end_ = nullptr;
    open_ = false;
}

// Runs fill the blocks one after the other.
void KeptStore::free_before(std::size_t run) {
    const auto holds_run = [&](const Buffer<KeptSplat>& block) {
        return run < runs_.size() && block.data() <= runs_[run].splats &&
               runs_[run].splats < block.data() + block.size();
    };
    blocks_.erase(blocks_.begin(), std::find_if(blocks_.begin(), blocks_.end(), holds_run));
}

void reserve(SplatSet& set, std::size_t count) {
    for_each_array(set, [&](auto& values) { values.reserve(count); });
}

void append_sorted(std::span<const KeptStore::Run> runs, SplatSet& set) {
    std::vector<Move> moves;
    moves.reserve(runs.size());
    for (const KeptStore::Run& run : runs) moves.push_back({run.splats, run.count, 0});
    std::sort(moves.begin(), moves.end(),
              [](const Move& a, const Move& b) { return a.from->id < b.from->id; });
    std::size_t size = set.position.size();
    for (Move& move : moves) {
        move.to = size;
        size += move.count;
    }
    for_each_array(set, [&](auto& values) { values.resize(size); });
    parallel_chunks(static_cast<std::int64_t>(moves.size()), 256,
                    [&](std::int64_t begin, std::int64_t end, int) {
                        for (std::int64_t i = begin; i < end; ++i)
                            unpack(moves[static_cast<std::size_t>(i)], set);
                    });
}

}  // namespace astrosplat
