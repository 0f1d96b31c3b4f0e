// Reading: mmap and the handler of SIGBUS, which the kernel sends when a mapped page has no file behind it
// any more. Writing: a ring of buffers between the threads that format and the file. Whoever finishes a chunk
// while no thread writes becomes the writer and empties the ring as far as it is filled without a gap, so
// that the file never waits for a thread to wake up.
#include "splat_files/file_bytes.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <system_error>

#include "core/buffer.h"
#include "core/parallel.h"

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

std::size_t take_guard(const fs::path& file) {
    for (std::size_t i = 0; i < guards.size(); ++i)
        if (!guards[i].taken.exchange(true)) return i;
    throw InputError(fmt::format("{}: cannot be read: too many splat files at once", file.string()));
}

}  // namespace

MappedFile::MappedFile(const fs::path& file) : file_(file), input_(file), size_(std::size_t(input_.size())) {
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

namespace {

/// Chunks on their way to the file. Chunk n lies in slot n % slots; chunks are taken in order, so the one the
/// file waits for is always written already or in the hands of a running thread.
class Ring {
  public:
    struct Slot {
        Buffer<char> bytes;
        std::size_t size = 0;
        bool full = false;
    };

    Ring(AtomicFile& file, std::size_t slots) : file_(file), slots_(slots) {}

    Slot& slot(std::int64_t chunk) { return slots_[std::size_t(chunk) % slots_.size()]; }

    /// The next chunk to format, once its slot is free; -1 when another thread failed.
    std::int64_t take() {
        std::unique_lock lock(mutex_);
        const std::int64_t chunk = taken_++;
        changed_.wait(lock, [&] { return failed_ || chunk < written_ + std::int64_t(slots_.size()); });
        return failed_ ? -1 : chunk;
    }

    /// The chunk's slot is full. Writes what can be written, unless another thread is at it.
    void put(std::int64_t chunk) {
        std::unique_lock lock(mutex_);
        slot(chunk).full = true;
        if (writing_) return;
        writing_ = true;
        while (!failed_ && slot(written_).full) {
            Slot& next = slot(written_);
            lock.unlock();
            file_.write(next.bytes.data(), next.size);
            lock.lock();
            next.full = false;
            ++written_;
            changed_.notify_all();
        }
        writing_ = false;
    }

    /// Nothing more will be written.
    void fail() {
        {
            const std::lock_guard lock(mutex_);
            failed_ = true;
        }
        changed_.notify_all();
    }

  private:
    AtomicFile& file_;
    std::vector<Slot> slots_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::int64_t taken_ = 0, written_ = 0;  // chunks
    bool writing_ = false, failed_ = false;
};

}  // namespace

void write_ordered(const WriteTarget& target, std::string_view header, std::int64_t count, std::int64_t chunk,
                   std::size_t row_bytes, const Progress& progress, const FormatRows& format,
                   const Footer& footer) {
    AtomicFile output(target.file, target.existing);
    output.write(header);
    const std::int64_t chunks = (count + chunk - 1) / chunk;
    const std::size_t bytes = std::size_t(std::min(chunk, count)) * row_bytes;
    Ring ring(output, std::size_t(thread_count()) + 1);
    parallel_for(chunks, [&](std::int64_t, int) {
        try {
            progress.check();
            const std::int64_t number = ring.take();
            if (number < 0) return;
            Ring::Slot& slot = ring.slot(number);
            slot.bytes.resize(bytes);
            const char* end =
                format(number * chunk, std::min((number + 1) * chunk, count), slot.bytes.data());
            slot.size = std::size_t(end - slot.bytes.data());
            ring.put(number);
            progress.at(double(number + 1) / double(chunks));
        } catch (...) {
            ring.fail();
            throw;
        }
    });
    progress.check();
    if (footer) output.write(footer());
    output.commit();
}

}  // namespace astrosplat
