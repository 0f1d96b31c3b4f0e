// Figures of a benchmark besides its time: the process's memory, and how much of the memory bandwidth its
// arrays make up.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>

namespace astrosplat::bench {

/// Bytes of this process's memory that are in use now.
std::int64_t resident_bytes();

/// Largest resident_bytes() since the last forget_peak().
std::int64_t peak_bytes();
void forget_peak();

/// Counter "M/s": millions of `count` things a second, for each iteration.
void report_rate(benchmark::State& state, std::int64_t count);

/// Counter "GB/s": what `bytes` read and written once in each iteration make of the memory bandwidth. The
/// least the work can do; what it spills and reads again is not in it.
void report_traffic(benchmark::State& state, std::int64_t bytes);

}  // namespace astrosplat::bench
