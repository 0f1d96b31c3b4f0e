// The machine at its best, for comparison: copying memory, writing fresh memory, writing a file.
#include <benchmark/benchmark.h>

#include <cstring>

#include "core/atomic_file.h"
#include "core/buffer.h"
#include "core/parallel.h"
#include "measure.h"
#include "support/temp_folder.h"

namespace astrosplat::bench {
namespace {

constexpr std::int64_t bytes = std::int64_t{1} << 30;
constexpr std::int64_t chunk = 1 << 20;

void copy(benchmark::State& state) {
    const auto size = std::size_t(bytes);
    Buffer<char> from(size), to(size);
    std::memset(from.data(), 1, from.size());
    std::memset(to.data(), 1, to.size());
    for (auto _ : state)
        parallel_chunks(bytes, chunk, [&](std::int64_t begin, std::int64_t end, int) {
            std::memcpy(to.data() + begin, from.data() + begin, std::size_t(end - begin));
        });
    report_traffic(state, 2 * bytes);
}
BENCHMARK(copy)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(4);

// Memory the process did not have before: the system clears it first.
void fresh_memory(benchmark::State& state) {
    for (auto _ : state) {
        state.PauseTiming();
        release_spare_pages();
        state.ResumeTiming();
        Buffer<char> to;
        to.resize(std::size_t(bytes));
        parallel_chunks(bytes, 2 * chunk, [&](std::int64_t begin, std::int64_t end, int) {
            std::memset(to.data() + begin, 1, std::size_t(end - begin));
        });
    }
    report_traffic(state, bytes);
}
BENCHMARK(fresh_memory)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(2);

// A new file each time, as files_bench does it, and once before.
void disk(benchmark::State& state) {
    const TempFolder folder;
    const Buffer<char> block(std::size_t(chunk), 'x');
    const auto write = [&] {
        AtomicFile file(folder / "raw");
        for (std::int64_t i = 0; i < bytes; i += chunk) file.write(block.data(), block.size());
        file.commit();
    };
    write();
    for (auto _ : state) {
        state.PauseTiming();
        fs::remove(folder / "raw");
        state.ResumeTiming();
        write();
    }
    report_traffic(state, bytes);
}
BENCHMARK(disk)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace astrosplat::bench

BENCHMARK_MAIN();
