// Runs of splats from several stores join a set in order of id.
#include "generate/kept_store.h"

#include <gtest/gtest.h>

namespace astrosplat {
namespace {

KeptSplat splat_of(std::uint64_t id) {
    const auto v = static_cast<float>(id);
    return {glm::vec3(v), glm::vec3(0.5f), 1.0f, v, id, glm::vec2(v), glm::vec3(0, 1, 0), 7, 8};
}

// Store n of two has the odd or the even thousands; as many splats as two blocks and a half hold.
constexpr std::uint64_t run_splats = 1000, runs_each = 164;

void fill(KeptStore& store, std::uint64_t n) {
    for (std::uint64_t run = 0; run < runs_each; ++run) {
        store.begin_run();
        for (std::uint64_t i = 0; i < run_splats; ++i) store.add(splat_of((2 * run + n) * run_splats + i));
    }
}

void append(const KeptStore& store, std::size_t begin, std::size_t end, std::vector<KeptStore::Run>& runs) {
    runs.insert(runs.end(), store.runs().data() + begin, store.runs().data() + end);
}

TEST(KeptStore, PartAfterPartJoinsASetInOrder) {
    KeptStore stores[2];
    SplatSet set;
    for (int again = 0; again < 2; ++again) {  // clear() lets the blocks serve again
        for (std::uint64_t n : {1u, 0u}) {
            stores[n].clear();
            fill(stores[n], n);
            ASSERT_GT(stores[n].runs().size(),
                      runs_each);  // one that reaches a block's end goes on as another
        }
    }
    std::size_t begin[2] = {0, 0};
    for (const std::uint64_t end_id : {100 * run_splats, 240 * run_splats, 2 * runs_each * run_splats}) {
        std::vector<KeptStore::Run> runs;
        for (std::size_t n = 0; n < 2; ++n) {
            const std::vector<KeptStore::Run>& all = stores[n].runs();
            std::size_t end = begin[n];
            while (end < all.size() && all[end].splats->id < end_id) ++end;
            append(stores[n], begin[n], end, runs);
            begin[n] = end;
        }
        append_sorted(runs, set);
        ASSERT_EQ(set.size(), static_cast<std::int64_t>(end_id));
    }
    for (std::size_t i = 0; i < set.id.size(); ++i) {
        ASSERT_EQ(set.id[i], i);
        ASSERT_EQ(set.position[i], glm::vec3(static_cast<float>(i)));
        ASSERT_EQ(set.mesh[i], 7u);
        ASSERT_EQ(set.face[i], 8u);
    }
}

}  // namespace
}  // namespace astrosplat
