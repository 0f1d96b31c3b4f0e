// Waiting times around the frames themselves: the start of --batch on a set that is in the cache,
// and whether the 500th frame of a sequence is as fast as the first ones and takes no more memory.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "inputs.h"
#include "measure.h"
#include "pipeline.h"
#include "scene/load.h"
#include "support/frames.h"
#include "support/pixmap.h"
#include "support/temp_folder.h"

namespace astrosplat::bench {
namespace {

std::string ppm(const Image& image) {
    return test::pixmap(int(image.width), int(image.height),
                        [&](int x, int y, int k) { return 255.0f * image.at(x, y)[k]; });
}

std::string scene_text(std::int64_t count, int width, int height) {
    return fmt::format(R"(astrosplat = 1
[output]
resolution = [{}, {}]
frames     = "1-500"
path       = "frame.####.png"
[camera]
target = [0.0, 0.0, 0.0]
[[layer]]
name = "gas"
[layer.source]
meshes = [ {{ mesh = "sphere", texture = "picture.ppm" }} ]
count  = {}
[animation]
"camera.position" = {{ keys = [[1, [0, 0, 16]], [125, [16, 0, 0]], [250, [0, 0, -16]], [375, [-16, 0, 0]], [500, [0, 0, 16]]] }}
)",
                       width, height, count);
}

bool run(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

// The whole program: start, scene, set from the cache, look, and a frame of 16 x 16 pixels, written.
void batch_start(benchmark::State& state) {
    static const TempFolder folder;
    const auto scene = folder.file("scene.toml", scene_text(10000000, 1920, 1080));
    folder.file("picture.ppm", ppm(picture(1024)));
    const fs::path stats = folder / "stats.json";
    const std::string command =
        fmt::format("'{}' --batch '{}' --cache '{}' -f 1 --region 952,532,16,16 --overwrite --stats '{}'",
                    ASTROSPLAT_PROGRAM, scene.string(), (folder / "cache").string(), stats.string());
    bool good = run(command);  // fills the cache
    for (auto _ : state) good = good && run(command);
    if (!good) return state.SkipWithError("astrosplat --batch failed");
    const auto figures = nlohmann::json::parse(read_file(stats));
    double frames = 0.0;
    for (const auto& frame : figures["frames"]) frames += frame["seconds"].get<double>();
    state.counters["before_frame_ms"] = 1000.0 * (figures["seconds"].get<double>() - frames);
    state.counters["Msplats"] = 1e-6 * figures["layers"][0]["kept"].get<double>();
    state.counters["cached"] = figures["layers"][0]["cached"].get<bool>() ? 1.0 : 0.0;
}
BENCHMARK(batch_start)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

double frame_ms(Pipeline& pipeline, double frame) {
    const auto start = std::chrono::steady_clock::now();
    const RenderedFrame picture = frame_of(pipeline, frame);
    benchmark::DoNotOptimize(picture.beauty.pixels.data());
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Once around the ball: the camera of frame 500 is that of frame 1. Both are rendered several times, because
// one frame of so small a picture is too short to measure.
void sequence(benchmark::State& state) {
    constexpr int times = 9;
    const TempFolder folder;
    folder.file("picture.ppm", ppm(picture(256)));
    Pipeline pipeline(parse_scene(scene_text(200000, 320, 180), folder / "scene.toml"));
    std::vector<double> early, late;
    double first = 0.0;
    std::int64_t before = 0;
    for (auto _ : state) {
        first = frame_ms(pipeline, 1);
        for (int i = 0; i < times; ++i) early.push_back(frame_ms(pipeline, 1));
        before = resident_bytes();
        for (int frame = 2; frame < 500; ++frame) frame_ms(pipeline, frame);
        for (int i = 0; i < times; ++i) late.push_back(frame_ms(pipeline, 500));
    }
    state.counters["very_first_ms"] = first;  // takes its memory and builds its tables
    state.counters["frame_1_ms"] = median(early);
    state.counters["frame_500_ms"] = median(late);
    state.counters["growth_MiB"] = double(resident_bytes() - before) / (1024.0 * 1024.0);
}
BENCHMARK(sequence)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace astrosplat::bench

BENCHMARK_MAIN();
