// Paged storage of kept splats and their concatenation.
#include "splats/kept_store.h"

#include <algorithm>

#include "core/parallel.h"

namespace astrosplat {
namespace {

constexpr std::size_t page_splats = std::size_t{1} << 20;  // each array of a page then is 4 MiB or more

void resize(SplatSet& page, std::size_t count) {
    page.position.resize(count);
    page.color.resize(count);
    page.alpha.resize(count);
    page.distance.resize(count);
    page.id.resize(count);
    page.uv.resize(count);
    page.normal.resize(count);
    page.mesh.resize(count);
}

struct Move {
    KeptRun run;
    std::size_t to;
};

template <class T>
void gather_array(const std::vector<Move>& moves, std::size_t total, Buffer<T> SplatSet::*array,
                  SplatSet& set) {
    Buffer<T>& all = set.*array;
    all.resize(total);
    parallel_chunks(
        static_cast<std::int64_t>(moves.size()), 1024, [&](std::int64_t begin, std::int64_t end, int) {
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
                const Move& m = moves[i];
                std::copy_n((m.run.page->*array).data() + m.run.begin, m.run.count, all.data() + m.to);
            }
        });
    for (const Move& m : moves) Buffer<T>().swap(m.run.page->*array);  // gives the page's memory back
}

}  // namespace

void KeptStore::open_run(std::uint64_t first_id) {
    if (pages_.empty() || used_ == page_splats) {
        resize(pages_.emplace_back(), page_splats);
        used_ = 0;
    }
    runs_.push_back({first_id, &pages_.back(), used_, 0});
    open_ = true;
}

void KeptStore::add(const KeptSplat& splat) {
    if (!open_ || used_ == page_splats) open_run(splat.id);
    SplatSet& page = pages_.back();
    const std::size_t to = used_++;
    ++runs_.back().count;
    page.position[to] = splat.position;
    page.color[to] = splat.color;
    page.alpha[to] = splat.alpha;
    page.distance[to] = splat.distance;
    page.id[to] = splat.id;
    page.uv[to] = splat.uv;
    page.normal[to] = splat.normal;
    page.mesh[to] = splat.mesh;
}

void gather(std::vector<KeptStore>& stores, SplatSet& set) {
    std::vector<Move> moves;
    for (const KeptStore& store : stores) {
        for (const KeptRun& run : store.runs()) moves.push_back({run, 0});
    }
    std::sort(moves.begin(), moves.end(),
              [](const Move& a, const Move& b) { return a.run.first_id < b.run.first_id; });
    std::size_t total = 0;
    for (Move& m : moves) {
        m.to = total;
        total += m.run.count;
    }
    gather_array(moves, total, &SplatSet::position, set);
    gather_array(moves, total, &SplatSet::color, set);
    gather_array(moves, total, &SplatSet::alpha, set);
    gather_array(moves, total, &SplatSet::distance, set);
    gather_array(moves, total, &SplatSet::id, set);
    gather_array(moves, total, &SplatSet::uv, set);
    gather_array(moves, total, &SplatSet::normal, set);
    gather_array(moves, total, &SplatSet::mesh, set);
    stores.clear();
}

}  // namespace astrosplat
