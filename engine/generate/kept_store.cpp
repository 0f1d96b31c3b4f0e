// Appending kept splats to a set, in order and in parallel.
#include "generate/kept_store.h"

#include "core/parallel.h"

namespace astrosplat {
namespace {

template <class Visit>
void for_each_generated(Visit visit) {
    for_each_column([&](auto column, SplatColumn which) {
        if (is_generated(which)) visit(column);
    });
}

struct Move {
    const KeptSplat* from;
    std::size_t count, to;
};

}  // namespace

void put(const KeptSplat& splat, SplatSet& set, std::size_t row) {
    set.position[row] = splat.position;
    set.color[row] = splat.color;
    set.alpha[row] = splat.alpha;
    set.distance[row] = splat.distance;
    set.id[row] = splat.id;
    set.uv[row] = splat.uv;
    set.normal[row] = splat.normal;
    set.mesh[row] = splat.mesh;
    set.face[row] = splat.face;
}

void resize(SplatSet& set, std::size_t size) {
    for_each_generated([&](auto column) { (set.*column).resize(size); });
}

void reserve(SplatSet& set, std::size_t count) {
    for_each_generated([&](auto column) { (set.*column).reserve(count); });
}

void append_sorted(std::span<const KeptStore::Run> runs, SplatSet& set) {
    std::vector<Move> moves;
    moves.reserve(runs.size());
    for (const KeptStore::Run& run : runs) moves.push_back({run.splats, run.count, 0});
    std::ranges::sort(moves, [](const Move& a, const Move& b) { return a.from->id < b.from->id; });
    std::size_t size = set.position.size();
    for (Move& move : moves) {
        move.to = size;
        size += move.count;
    }
    resize(set, size);
    parallel_each(moves.size(), 256, [&](std::size_t n) {
        const Move& move = moves[n];
        for (std::size_t i = 0; i < move.count; ++i) put(move.from[i], set, move.to + i);
    });
}

}  // namespace astrosplat
