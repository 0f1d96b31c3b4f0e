// Memory for big arrays: mapped straight from the system, aligned to 2 MiB and advised for huge pages.
#include "core/buffer.h"

#include <sys/mman.h>

#include <cstdint>
#include <limits>
#include <new>

namespace astrosplat {
namespace {

constexpr std::size_t cache_line = 64;
constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t map_from = std::size_t{4} << 20;

std::size_t whole_pages(std::size_t bytes) { return (bytes + huge_page - 1) / huge_page * huge_page; }

// The system maps at 4 KiB steps: take one huge page too many and hand the ends back.
void* map_aligned(std::size_t size) {
    const std::size_t taken = size + huge_page;
    void* start = mmap(nullptr, taken, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) throw std::bad_alloc();
    char* first = static_cast<char*>(start);
    const std::size_t head = (huge_page - reinterpret_cast<std::uintptr_t>(first) % huge_page) % huge_page;
    if (head > 0) munmap(first, head);
    if (taken - head - size > 0) munmap(first + head + size, taken - head - size);
    return first + head;
}

}  // namespace

void* allocate_pages(std::size_t bytes) {
    if (bytes > std::numeric_limits<std::size_t>::max() / 2) throw std::bad_alloc();
    if (bytes < map_from) return ::operator new (bytes, std::align_val_t{cache_line});
    void* memory = map_aligned(whole_pages(bytes));
    madvise(memory, whole_pages(bytes), MADV_HUGEPAGE);  // only advice: a kernel without huge pages is fine
    return memory;
}

void free_pages(void* memory, std::size_t bytes) noexcept {
    if (bytes < map_from)
        ::operator delete (memory, std::align_val_t{cache_line});
    else
        munmap(memory, whole_pages(bytes));
}

}  // namespace astrosplat
