// Whole frames, look already applied: project to finished float image in memory; and what memory a frame
// takes beyond the splats.
#include <benchmark/benchmark.h>

#include <cstring>

#include "core/buffer.h"
#include "core/parallel.h"
#include "core/shared_maths.h"
#include "inputs.h"
#include "measure.h"
#include "render/render.h"

namespace astrosplat {
namespace {

using bench::spread;

void frame(benchmark::State& state, std::int64_t count, float diameter_px, float alpha, Blend blend) {
    const ShadedSplats set = spread(count, diameter_px, alpha);
    RenderLayer layer;
    layer.name = "bench";
    layer.splats = &set;
    layer.render.blend = blend;
    Camera camera;
    camera.focal_px = 1000.0;
    camera.center_x_px = 960.0;
    camera.center_y_px = 540.0;
    RenderCache cache;
    const RenderSettings settings;
    release_spare_pages();
    const std::int64_t before = bench::resident_bytes();
    bench::forget_peak();
    render({&layer, 1}, camera, nullptr, settings, {}, &cache);  // buffers and tables, as in a sequence
    for (auto _ : state) {
        const RenderedFrame result = render({&layer, 1}, camera, nullptr, settings, {}, &cache);
        benchmark::DoNotOptimize(result.beauty.pixels.data());
    }
    state.counters["extra_B"] = double(bench::peak_bytes() - before) / double(count);
    bench::report_rate(state, count);
}

BENCHMARK_CAPTURE(frame, 10M_5px_over, 10000000, 5.0f, 0.3f, Blend::over)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(4);
BENCHMARK_CAPTURE(frame, 2600k_26px_over, 2600000, 26.0f, 0.3f, Blend::over)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(4);
BENCHMARK_CAPTURE(frame, 2600k_26px_add, 2600000, 26.0f, 0.3f, Blend::add)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(4);
BENCHMARK_CAPTURE(frame, 44M_3px_screen, 44000000, 3.0f, 0.05f, Blend::screen)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(4);

}  // namespace
}  // namespace astrosplat

BENCHMARK_MAIN();
