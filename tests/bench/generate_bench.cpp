// Mesh + picture -> SplatSet: the index over the triangles, the cull, the colours, the set in order of id.
// Measured is a generation after one that took its memory ("first_ms"), as in a viewer whose source is tuned.
#include <benchmark/benchmark.h>

#include <chrono>

#include "core/buffer.h"
#include "generate/generate.h"
#include "inputs.h"
#include "measure.h"

namespace astrosplat::bench {
namespace {

constexpr std::int64_t kept_bytes = 60;  // of one splat in a generated set

void generate(benchmark::State& state, const GenerateInput& input) {
    std::int64_t kept = 0;
    const auto run = [&] {
        const SplatSet set = astrosplat::generate(input.meshes, input.lattice, input.max_distance, 1.0, 1);
        benchmark::DoNotOptimize(set.position.data());
        kept = set.size();
    };
    release_spare_pages();
    const std::int64_t before = resident_bytes();
    forget_peak();
    const auto start = std::chrono::steady_clock::now();
    run();
    state.counters["first_ms"] =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    for (auto _ : state) run();
    const auto positions = double(input.lattice.positions());
    report_rate(state, input.lattice.positions());
    report_traffic(state, kept * kept_bytes);
    state.counters["kept_percent"] = 100.0 * double(kept) / positions;
    state.counters["extra_MiB"] = double(peak_bytes() - before - kept * kept_bytes) / (1024.0 * 1024.0);
}

/// Colours and alphas of columns that are there, as for every level that is tried: rows a second.
void read_texels(benchmark::State& state) {
    const GenerateInput input = ball_input(58, 114);
    Columns columns = make_columns(input.meshes, input.lattice, input.max_distance, 1.0, 1);
    for (auto _ : state) astrosplat::read_texels(input.meshes, columns);
    report_rate(state, columns.splats.size());
}

void ball_13k(benchmark::State& state) {
    static const GenerateInput input = ball_input(58, 114);
    generate(state, input);
}
void ball_1M(benchmark::State& state) {
    static const GenerateInput input = ball_input(501, 1000);
    generate(state, input);
}
void plane_40_percent(benchmark::State& state) {
    static const GenerateInput input = plane_input();
    generate(state, input);
}

BENCHMARK(read_texels)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(ball_13k)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(ball_1M)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK(plane_40_percent)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace astrosplat::bench

BENCHMARK_MAIN();
