// Memory figures from /proc.
#include "measure.h"

#include <fstream>
#include <string>

namespace astrosplat::bench {
namespace {

// "VmRSS:     1234 kB" of /proc/self/status.
std::int64_t status_bytes(const std::string& field) {
    std::ifstream in("/proc/self/status");
    std::string word;
    while (in >> word) {
        if (word != field) continue;
        std::int64_t kib = 0;
        in >> kib;
        return kib * 1024;
    }
    return 0;
}

}  // namespace

std::int64_t resident_bytes() { return status_bytes("VmRSS:"); }
std::int64_t peak_bytes() { return status_bytes("VmHWM:"); }
void forget_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

void report_rate(benchmark::State& state, std::int64_t count) {
    state.counters["M/s"] =
        benchmark::Counter(double(count) * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}

void report_traffic(benchmark::State& state, std::int64_t bytes) {
    state.counters["GB/s"] =
        benchmark::Counter(double(bytes) * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace astrosplat::bench
