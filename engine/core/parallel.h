// Threads and vectors: one small thread pool with the loops that run on it, and the instruction set of the
// vector kernels. Work is handed out dynamically, so results must not depend on which thread does what: every
// loop body writes only what its own index names. Every instruction set gives the same bits; the switch
// exists to prove that.
#pragma once

#include "core/progress.h"

namespace astrosplat {

/// Cores this process may use: affinity mask and cgroup quota (v1 and v2), at least 1.
int available_threads();

/// Size of the pool, callers included; 0 restores available_threads(). Not to be called while a loop runs.
void set_thread_count(int threads);
int thread_count();

/// Calls body(begin, end, worker) for consecutive chunks of [0, count) of at most `chunk` items, in any
/// order, on worker = 0 .. thread_count()-1. The chunk boundaries depend on count and chunk alone, never on
/// the threads. The first exception thrown by a body stops the hand-out and is rethrown here. A nested call
/// runs in its caller.
void parallel_chunks(std::int64_t count, std::int64_t chunk,
                     const std::function<void(std::int64_t begin, std::int64_t end, int worker)>& body);

/// parallel_chunks with chunks of one.
void parallel_for(std::int64_t count, const std::function<void(std::int64_t index, int worker)>& body);

/// parallel_chunks that calls body(index) for every item.
template <class Index, class Body>
void parallel_each(Index count, std::int64_t chunk, const Body& body) {
    parallel_chunks(std::int64_t(count), chunk, [&](std::int64_t begin, std::int64_t end, int) {
        for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) body(i);
    });
}

/// parallel_for over the parts of a file. The InputError of the lowest part that throws one is thrown here,
/// whatever the threads do; Cancelled.
void parallel_parts(std::size_t count, const Progress& progress,
                    const std::function<void(std::size_t part)>& body);

/// While it lives, the loops that this thread calls throw Cancelled before their next chunk once `progress`
/// is asked to stop: long work of many short loops need not ask anywhere else.
class StoppableLoops {
  public:
    explicit StoppableLoops(const Progress& progress);
    ~StoppableLoops();
    StoppableLoops(const StoppableLoops&) = delete;
    StoppableLoops& operator=(const StoppableLoops&) = delete;

  private:
    const std::atomic<bool>* before_;
};

/// While it lives, numbers too small to be normal count as 0 in this thread and in the loops it calls, as
/// they do on graphics cards: what is drawn there has the same bits.
class DenormalsAreZero {
  public:
    DenormalsAreZero();
    ~DenormalsAreZero();
    DenormalsAreZero(const DenormalsAreZero&) = delete;
    DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

  private:
    std::uint64_t before_;
};

/// "best" (what the processor offers), or one of vector_targets(). Throws InputError for another name or one
/// this processor lacks. Not while a loop runs.
void set_vector_target(const std::string& name);

/// Chooses what the environment variable ASTROSPLAT_VECTOR_TARGET names, if set; main calls this first.
/// Throws as above.
void use_vector_target_of_environment();

/// The compiled targets this processor can run, best first, from "avx512" "avx2" "sse4" "sse2".
std::vector<std::string> vector_targets();

/// The target in use.
std::string vector_target();

}  // namespace astrosplat
