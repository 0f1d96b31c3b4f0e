// SplatSet + look -> ShadedSplats, 20 million splats into arrays that are there already, as in a sequence.
#include <benchmark/benchmark.h>

#include "inputs.h"
#include "look/apply.h"
#include "measure.h"

namespace astrosplat::bench {
namespace {

const SplatSet& set() {
    static const SplatSet the_set = random_set(20000000);
    return the_set;
}

Look plain_look() {
    Look look;
    look.pdf.shape = DensityCurve::Shape::quadratic;
    look.alpha.power = 1.2f;
    look.vertical.shape = VerticalAlpha::Shape::linear;
    look.radius.min = 0.01f;
    look.radius.max = 0.02f;
    look.density = 3.0f;
    return look;
}

Look noisy_look() {
    Look look = plain_look();
    Noise noise;
    noise.frequency = 0.8f;
    noise.octaves = 4;
    noise.cull = 0.3f;
    noise.brightness = 0.5f;
    look.noise.push_back(noise);
    return look;
}

void look(benchmark::State& state, const Look& look) {
    ShadedSplats shaded;
    apply_look(set(), look, {}, shaded);
    for (auto _ : state) apply_look(set(), look, {}, shaded);
    constexpr std::int64_t bytes_in = 40, bytes_out = 40;  // without uv, normal, mesh
    report_rate(state, set().size());
    report_traffic(state, set().size() * bytes_in + shaded.size() * bytes_out);
    state.counters["kept"] = double(shaded.size());
}

BENCHMARK_CAPTURE(look, plain, plain_look())->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(2);
BENCHMARK_CAPTURE(look, noise, noisy_look())->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(2);

}  // namespace
}  // namespace astrosplat::bench

BENCHMARK_MAIN();
