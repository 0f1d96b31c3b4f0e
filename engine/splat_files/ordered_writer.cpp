// A ring of buffers between the threads that format and the file. Whoever finishes a chunk while nobody
// writes becomes the writer and empties the ring as far as it is filled without a gap, so that the file never
// waits for a thread to wake up.
#include "splat_files/ordered_writer.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "core/atomic_file.h"
#include "core/buffer.h"
#include "core/parallel.h"

namespace astrosplat {

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

    Slot& slot(std::int64_t chunk) { return slots_[static_cast<std::size_t>(chunk) % slots_.size()]; }

    /// The next chunk to format, once its slot is free; -1 when another thread failed.
    std::int64_t take() {
        std::unique_lock lock(mutex_);
        const std::int64_t chunk = taken_++;
        changed_.wait(lock,
                      [&] { return failed_ || chunk < written_ + static_cast<std::int64_t>(slots_.size()); });
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
    const std::size_t bytes = static_cast<std::size_t>(std::min(chunk, count)) * row_bytes;
    Ring ring(output, static_cast<std::size_t>(thread_count()) + 1);
    parallel_for(chunks, [&](std::int64_t, int) {
        try {
            progress.check();
            const std::int64_t number = ring.take();
            if (number < 0) return;
            Ring::Slot& slot = ring.slot(number);
            slot.bytes.resize(bytes);
            const char* end =
                format(number * chunk, std::min((number + 1) * chunk, count), slot.bytes.data());
            slot.size = static_cast<std::size_t>(end - slot.bytes.data());
            ring.put(number);
            progress.at(static_cast<double>(number + 1) / static_cast<double>(chunks));
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
