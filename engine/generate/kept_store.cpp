// Appending kept splats to a set, in order and in parallel.
#include "generate/kept_store.h"

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
