// A picture -> bodies fitted to it: stars, bands, depths, dust and the front fit,
// the reading of a file apart.
#include <benchmark/benchmark.h>

#include "bodies/bodies.h"
#include "core/buffer.h"
#include "measure.h"
#include "support/painted_picture.h"

namespace astrosplat::bench {
namespace {

TexturedMesh painted_galaxy(std::int64_t width, std::int64_t height) {
    const Image light = painted::galaxy(width, height);
    TexturedMesh result;
    result.mesh = builtin_mesh("plane", double(width) / double(height));
    result.textures.emplace_back().image = make_image(width, height, 4, 1.0f);
    float* const pixels = result.textures[0].image.pixels.data();
    for (std::int64_t i = 0; i < width * height; ++i) std::copy_n(&light.pixels[3 * i], 3, pixels + 4 * i);
    return result;
}

void bodies(benchmark::State& state) {
    const std::int64_t width = state.range(0), height = width * 5 / 8;
    const std::vector<TexturedMesh> meshes{painted_galaxy(width, height)};
    StructureParams params;
    params.kind = StructureKind::disk;
    release_spare_pages();
    const std::int64_t before = resident_bytes();
    forget_peak();
    std::int64_t splats = 0;
    for (auto _ : state) splats = make_bodies(meshes, params, 1, "galaxy").size();
    const auto texels = double(width * height);
    state.counters["texel_B"] = double(peak_bytes() - before) / texels;
    state.counters["told_B"] =
        double(bodies_memory_bytes(meshes, params, expected_splats(meshes, params))) / texels;
    state.counters["Mpx"] = 1e-6 * texels;
    state.counters["Msplats"] = 1e-6 * double(splats);
}

BENCHMARK(bodies)->Arg(1920)->Arg(3840)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);

}  // namespace
}  // namespace astrosplat::bench

BENCHMARK_MAIN();
