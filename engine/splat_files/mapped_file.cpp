// mmap and the handler of SIGBUS, which the kernel sends when a mapped page has no file behind it any more.
#include "splat_files/mapped_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <mutex>
#include <system_error>

namespace astrosplat {

namespace {

/// A mapping as the signal handler sees it, which may only read and write atomics.
struct Guard {
    std::atomic<bool> taken{false};
    std::atomic<std::uintptr_t> begin{0}, end{0};
    std::atomic<bool> cut{false};  // a page was missing
};
std::array<Guard, 256> guards;

std::uintptr_t page_size() {
    static const auto size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    return size;
}

/// Puts a page of zeros where a guarded mapping lost one. Other faults end the process, as without a handler.
void on_bus_error(int, siginfo_t* info, void*) {
    const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
    for (Guard& guard : guards) {
        if (info->si_code != BUS_ADRERR || at < guard.begin || at >= guard.end) continue;
        guard.cut = true;
        void* const page = reinterpret_cast<void*>(at / page_size() * page_size());
        if (::mmap(page, page_size(), PROT_READ, MAP_PRIVATE | MAP_FIXED | MAP_ANONYMOUS, -1, 0) == page)
            return;
    }
    ::signal(SIGBUS, SIG_DFL);
    ::raise(SIGBUS);
}

void catch_bus_errors() {
    static std::once_flag once;
    std::call_once(once, [] {
        (void)page_size();
        struct sigaction action {};
        action.sa_sigaction = on_bus_error;
        action.sa_flags = SA_SIGINFO;
        ::sigaction(SIGBUS, &action, nullptr);
    });
}

std::size_t take_guard(const std::filesystem::path& file) {
    for (std::size_t i = 0; i < guards.size(); ++i)
        if (!guards[i].taken.exchange(true)) return i;
    throw InputError(fmt::format("{}: cannot be read: too many splat files at once", file.string()));
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file)
    : file_(file), input_(file), size_(static_cast<std::size_t>(input_.size())) {
    if (size_ == 0) return;
    catch_bus_errors();
    guard_ = take_guard(file);
    void* const memory = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, input_.descriptor(), 0);
    if (memory == MAP_FAILED) {
        const int error = errno;
        guards[guard_].taken = false;
        throw InputError(
            fmt::format("{}: cannot be read: {}", file.string(), std::generic_category().message(error)));
    }
    memory_ = static_cast<const char*>(memory);
    ::madvise(memory, size_, MADV_SEQUENTIAL);
    Guard& guard = guards[guard_];
    guard.cut = false;
    guard.begin = reinterpret_cast<std::uintptr_t>(memory);
    guard.end = guard.begin + size_;
}

MappedFile::~MappedFile() {
    if (size_ == 0) return;
    Guard& guard = guards[guard_];
    guard.end = 0;
    guard.begin = 0;
    ::munmap(const_cast<char*>(memory_), size_);
    guard.taken = false;
}

void forget_pages(std::string_view bytes) {
    const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data()), end = begin + bytes.size();
    for (const Guard& guard : guards) {
        if (begin < guard.begin || end > guard.end) continue;
        const std::uintptr_t page = page_size();
        const std::uintptr_t first = (begin + page - 1) / page * page, last = end / page * page;
        if (first < last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
    }
}

void MappedFile::require_whole() const {
    struct stat status {};
    const bool shorter = ::fstat(input_.descriptor(), &status) == 0 && status.st_size < input_.size();
    if (shorter || (size_ > 0 && guards[guard_].cut))
        throw InputError(
            fmt::format("{}: cannot be read: it became shorter while it was read", file_.string()));
}

}  // namespace astrosplat
