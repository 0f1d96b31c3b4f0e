// Freed memory that the C library keeps.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include "core/memory.h"

namespace astrosplat {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool has_own_heap = true;
#else
constexpr bool has_own_heap = false;
#endif

/// A few blocks that stay, of another thread, hold the pages of many that went.
TEST(FreedMemory, GoesBackToTheSystem) {
    if (has_own_heap || !std::ifstream("/proc/self/smaps_rollup"))
        GTEST_SKIP() << "the C library's heap is not in use, or cannot be measured";
    constexpr std::size_t block = 16 << 10, count = 4000;
    std::vector<std::unique_ptr<char[]>> kept;
    std::thread([&] {
        std::vector<std::unique_ptr<char[]>> blocks;
        for (std::size_t i = 0; i < count; ++i) blocks.push_back(std::make_unique<char[]>(block));
        for (std::size_t i = 0; i < count; i += 100) kept.push_back(std::move(blocks[i]));
    }).join();
    const std::int64_t before = resident_memory_bytes();
    return_freed_memory();
    EXPECT_LT(resident_memory_bytes(), before - static_cast<std::int64_t>(block * count / 2));
}

/// Resident memory before and after many blocks of another thread, once a large one was freed.
std::int64_t growth_by_freed_blocks() {
    constexpr std::size_t large = 30 << 20, block = 16 << 10, count = 3000;
    const std::int64_t before = resident_memory_bytes();
    std::thread([&] {
        std::make_unique<char[]>(large);
        std::vector<std::unique_ptr<char[]>> blocks;
        for (std::size_t i = 0; i < count; ++i) blocks.push_back(std::make_unique<char[]>(block));
        blocks.clear();
        return_freed_memory();
    }).join();
    return resident_memory_bytes() - before;
}

// The ends of other threads' heaps cannot be asked for.
TEST(FreedMemory, IsNotKeptAtTheEndsOfHeaps) {
    if (has_own_heap || !std::ifstream("/proc/self/smaps_rollup"))
        GTEST_SKIP() << "the C library's heap is not in use, or cannot be measured";
    keep_little_freed_memory();
    EXPECT_LT(growth_by_freed_blocks(), 10'000'000);
}

}  // namespace
}  // namespace astrosplat
