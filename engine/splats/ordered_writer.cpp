// Chunks are numbered as they are taken, so the chunk whose turn it is always belongs to a thread that is
// running.
#include "splats/ordered_writer.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "core/atomic_file.h"
#include "core/buffer.h"
#include "core/parallel.h"

namespace astrosplat {

namespace {

/// Lets the threads append one after the other.
class Turns {
  public:
    std::int64_t take() {
        const std::lock_guard lock(mutex_);
        return taken_++;
    }
    /// False when another thread failed and nothing more is to be written.
    bool await(std::int64_t number) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return failed_ || turn_ == number; });
        return !failed_;
    }
    void pass() {
        change([&] { ++turn_; });
    }
    void fail() {
        change([&] { failed_ = true; });
    }

  private:
    template <class Change>
    void change(Change&& apply) {
        {
            const std::lock_guard lock(mutex_);
            apply();
        }
        changed_.notify_all();
    }
    std::mutex mutex_;
    std::condition_variable changed_;
    std::int64_t taken_ = 0, turn_ = 0;
    bool failed_ = false;
};

}  // namespace

void write_ordered(const std::filesystem::path& file, std::string_view header, std::int64_t count,
                   std::int64_t chunk, std::size_t row_bytes, const Progress& progress,
                   const FormatRows& format, const Footer& footer) {
    AtomicFile output(file);
    output.write(header);
    const std::int64_t chunks = (count + chunk - 1) / chunk;
    const std::size_t bytes = static_cast<std::size_t>(std::min(chunk, count)) * row_bytes;
    std::vector<Buffer<char>> buffers(static_cast<std::size_t>(thread_count()));
    Turns turns;
    parallel_for(chunks, [&](std::int64_t, int worker) {
        const std::int64_t number = turns.take();
        try {
            progress.check();
            Buffer<char>& buffer = buffers[static_cast<std::size_t>(worker)];
            buffer.resize(bytes);
            const char* end = format(number * chunk, std::min((number + 1) * chunk, count), buffer.data());
            if (!turns.await(number)) return;
            output.write(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
        } catch (...) {
            turns.fail();
            throw;
        }
        turns.pass();
        progress.at(static_cast<double>(number + 1) / static_cast<double>(chunks));
    });
    progress.check();
    if (footer) output.write(footer());
    output.commit();
}

}  // namespace astrosplat
