// Seeds and checks of the fuzzed readers of a scene's texts: the scene itself, and tables of its keyframes.

#include "fuzz/targets.h"
#include "scene/camera_file.h"
#include "scene/load.h"

namespace astrosplat::fuzz {

namespace {

std::size_t read_toml_bytes(std::string_view bytes) {
    const Scene scene = parse_scene(std::string(bytes), fs::temp_directory_path() / "fuzz.toml");
    demand(scene.output.width > 0 && scene.output.height > 0, "a resolution");
    demand(std::isfinite(scene.camera.fov) && std::isfinite(scene.output.exposure), "finite numbers");
    return scene.layers.size();
}

std::size_t read_table_bytes(std::string_view bytes) {
    const TemporaryFile file(bytes, ".csv");
    Scene scene;
    std::size_t keyframes = 0;
    for (const Track& read : read_csv_tracks(file.path, FrameRate{24.0, 0.0}, scene))
        for (const auto& keyframe : read.keyframes) {
            ++keyframes;
            demand(std::isfinite(keyframe.frame), "finite frames");
            for (const double number : keyframe.value) demand(std::isfinite(number), "finite values");
        }
    return keyframes;
}

const char* const toml =
    "astrosplat = 1\n[output]\nresolution = [320, 180]\nframes = \"1-20x2\"\npath = \"a.####.exr\"\n"
    "aovs = [\"depth\"]\n[camera]\nposition = [0.0, 1.0, 10.0]\nfov = 35.0\n[[layer]]\nname = \"stars\"\n"
    "[layer.source]\nmeshes = [ { mesh = \"plane\", texture = \"a.png\" } ]\ncount = 1000\n[layer.look]\n"
    "pdf = { shape = \"curve\", points = [[0.0, 1.0], [1.0, 0.0]] }\nnoise = [ { cull = 0.5 }, { jitter = "
    "0.1 } ]\n"
    "[layer.render]\nblend = \"screen\"\n[animation]\n"
    "\"camera.fov\" = { keys = [[1, 35.0], [20, 40.0, \"step\"]], interpolation = \"smooth\" }\n";

const char* const table =
    "frame,camera.position.x,camera.position.y,camera.position.z,camera.fov\n1,0,0,9,40\n2,1,0,8,41\n";

}  // namespace

const std::vector<Target>& targets() {
    using Seeds = std::vector<std::string>;
    static const std::vector<Target> all = {{"toml", [] { return Seeds{toml}; }, read_toml_bytes},
                                            {"table", [] { return Seeds{table}; }, read_table_bytes}};
    return all;
}

}  // namespace astrosplat::fuzz
