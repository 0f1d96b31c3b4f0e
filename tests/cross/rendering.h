// All that crossings ask of the program, in one place: how a scene is rendered, hashed and named by batch and
// by the window, and what a blurred frame is the mean of.
#pragma once

#include "cross/crossing.h"
#include "render/frame.h"
#include "scene/load.h"
#include "scene/scene.h"

namespace astrosplat {
struct SplatSet;
class Pipeline;
}  // namespace astrosplat

namespace astrosplat::test {

/// The settings of a machine that a frame's pixels do not depend on. The pool and the instruction set are as
/// before when it ends.
struct Machine {
    int threads = 2, tile_px = 0;
    std::string target = "best";
    bool streamed = false;  // layers of .splats files
    Device device = Device::cpu;
};
Machine machine_of(const Crossing& crossing);

/// What --device is told on that machine: where there is no OpenGL, or a card does not draw such scenes, not
/// to insist on one.
std::string device_word(const Crossing& crossing);

struct Shot {
    RenderedFrame frame;
    std::vector<std::string> layers;           // names of frame.layers
    std::vector<RenderedFrame> without_sky{};  // of samples: one, the same without the environment
};

/// As --batch renders it, with all extra channels or those of the scene.
enum class Extra { all, of_scene };
Shot shot_of(const Scene& scene, double frame, Eye eye, Extra extra = Extra::all, const Machine& on = {});

/// The window's way: one pipeline that goes from scene to scene with the sets it has. The scenes differ from
/// the first in nothing that its layers' sets are made of.
class Window {
  public:
    explicit Window(const Scene& scene);
    ~Window();
    Shot shot_of(const Scene& scene, double frame, Eye eye, Extra extra = Extra::all);

  private:
    std::vector<std::shared_ptr<const SplatSet>> sets_;
    std::unique_ptr<Pipeline> pipeline_;
};

/// The sharp renderings that a blurred frame is the mean of: each a scene of its own, without a shutter and
/// through its place of the lens. One of a frame that is sharp.
std::vector<Shot> samples_of(const Scene& scene, double frame, Eye eye);

std::string hash_of(const Scene& scene, std::int64_t frame, Eye eye);

/// Where --batch puts a frame; throws InputError where it refuses to.
fs::path batch_file(const Scene& scene, std::int64_t frame, Eye eye);
/// The same of what it is told by --output in a working directory.
fs::path file_of_output(const fs::path& working_directory, const std::string& output, std::int64_t frame,
                        Eye eye);

/// Writes the frame as --batch does.
void write_shot(const Scene& scene, const Shot& shot, std::int64_t frame, Eye eye, const fs::path& file);

}  // namespace astrosplat::test
