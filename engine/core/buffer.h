// Large arrays. Buffer<T> is std::vector without the zero-fill: resize() leaves new elements uninitialised,
// so that the thread that first writes a page is the one that faults it in. Big blocks are aligned to and
// advised for 2 MiB pages, because page faults cost as much as projecting a splat.
#pragma once

#include <new>
#include <type_traits>

#include "core/standard.h"

namespace astrosplat {

/// Raw memory, 64-byte aligned; 2 MiB aligned and advised for huge pages from 4 MiB on.
/// Throws std::bad_alloc.
void* allocate_pages(std::size_t bytes);
/// Blocks of 4 MiB and more stay mapped for the next of about their size. The system may take their pages in
/// the meantime, and they count as available memory.
void free_pages(void* memory, std::size_t bytes) noexcept;
/// Hands all of those back to the system.
void release_spare_pages();

template <class T>
struct PageAllocator {
    static_assert(std::is_trivially_destructible_v<T>);
    using value_type = T;
    PageAllocator() = default;
    template <class U>
    PageAllocator(const PageAllocator<U>&) noexcept {}
    T* allocate(std::size_t n) { return static_cast<T*>(allocate_pages(n * sizeof(T))); }
    void deallocate(T* p, std::size_t n) noexcept { free_pages(p, n * sizeof(T)); }
    template <class U>
    void construct(U* p) noexcept {
        ::new (static_cast<void*>(p)) U;  // default-initialised: trivial types stay as they are
    }
    template <class U, class... Args>
    void construct(U* p, Args&&... args) {
        ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
    }
    template <class U>
    bool operator==(const PageAllocator<U>&) const noexcept {
        return true;
    }
};

template <class T>
using Buffer = std::vector<T, PageAllocator<T>>;

}  // namespace astrosplat
