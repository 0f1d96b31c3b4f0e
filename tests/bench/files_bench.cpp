// Splat files of 10 million splats. Reading finds the file in the system's page cache; writing makes a new
// file and ends when the disk has everything. (Over an old file it takes longer by what the system needs to
// free it.)
#include <benchmark/benchmark.h>

#include "inputs.h"
#include "measure.h"
#include "splat_files/formats.h"
#include "splat_files/native.h"
#include "support/temp_folder.h"

namespace astrosplat::bench {
namespace {

const SplatSet& set() {
    static const SplatSet the_set = random_set(10000000);
    return the_set;
}

fs::path file(const char* name) {
    static const TempFolder folder;
    return folder / name;
}

void report(benchmark::State& state, const fs::path& path) {
    const auto bytes = std::int64_t(fs::file_size(path));
    state.SetBytesProcessed(bytes * state.iterations());
    report_rate(state, set().size());
    report_traffic(state, bytes);
}

template <class Write>
void write(benchmark::State& state, const char* name, const Write& write_file) {
    write_file(file(name));  // blocks of the disk that were never written may take several times as long
    for (auto _ : state) {
        state.PauseTiming();
        fs::remove(file(name));
        state.ResumeTiming();
        write_file(file(name));
    }
    report(state, file(name));
}

template <class Read, class Write>
void read(benchmark::State& state, const char* name, const Read& read_file, const Write& write_file) {
    if (!fs::exists(file(name))) write_file(file(name));
    for (auto _ : state) benchmark::DoNotOptimize(read_file(file(name)).position.data());
    report(state, file(name));
}

using fs::path;
void put_pda(const path& p) { write_pda(p, set()); }
void put_ply(const path& p) { write_ply(p, set()); }
void put_native(const path& p) { write_native(p, set()); }
SplatSet get_pda(const path& p) { return read_pda(p); }
SplatSet get_ply(const path& p) { return read_ply(p); }
SplatSet get_native(const path& p) { return read_native(p); }

void pda_write(benchmark::State& state) { write(state, "set.pda", put_pda); }
void pda_read(benchmark::State& state) { read(state, "set.pda", get_pda, put_pda); }
void ply_write(benchmark::State& state) { write(state, "set.ply", put_ply); }
void ply_read(benchmark::State& state) { read(state, "set.ply", get_ply, put_ply); }
void splats_write(benchmark::State& state) { write(state, "set.splats", put_native); }
void splats_read(benchmark::State& state) { read(state, "set.splats", get_native, put_native); }

BENCHMARK(pda_write)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(pda_read)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(ply_write)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(ply_read)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(splats_write)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(splats_read)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace astrosplat::bench

BENCHMARK_MAIN();
