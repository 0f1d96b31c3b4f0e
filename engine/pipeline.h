// The whole flow: sources -> SplatSets -> look -> ShadedSplats -> render -> RenderedFrame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "render/render.h"
#include "scene/scene.h"
#include "sets/set_cache.h"
#include "splats/splat_set.h"

namespace astrosplat {

struct LayerStatistics {
    std::string name;
    std::int64_t test_positions = 0, kept = 0, zero_alpha = 0;
    std::int64_t drawn = 0;  // shaded splats after the look, in the last frame
    double generate_seconds = 0.0, look_seconds = 0.0;
    bool cached = false;  // the set came from the cache; generate_seconds is how long reading it took
    bool geometry_cached = false;  // its positions did, also where pictures had to be read again
};

/// What stays between frames: the sets, the maps, the environment pictures, the last shaded splats
/// of each layer.
class Pipeline {
  public:
    /// Without layers, until set_scene.
    Pipeline();
    /// Loads all that the scene's files hold, once: the set of every layer that is visible at
    /// some frame, through the cache where one is given, thickness maps and the environment. Layers of
    /// .splats files whose names are in `streamed` stay on disk and are read block by block as frames need
    /// them: the same bits in less memory. Throws InputError, Cancelled.
    explicit Pipeline(const Scene& scene, const Progress& progress = {}, const SetCache& cache = {},
                      const std::vector<std::string>& streamed = {});
    ~Pipeline();

    /// Takes another scene with sets that are there already, one a layer; a layer whose set is null is left
    /// out. What did not change is kept: environment pictures of the same files, and the thickness map and
    /// shaded splats of a set that was in use, so that the next frame pays only for what changed. `loaded`:
    /// the environment of the scene where the caller has it, which is copied instead of loaded. Throws
    /// InputError or Cancelled and then keeps the scene it had; reports no fractions.
    void set_scene(const Scene& scene, std::vector<std::shared_ptr<const SplatSet>> sets,
                   const Environment* loaded = nullptr, const Progress& progress = {});

    /// The eye that frames are seen with from now on, whatever the scene says.
    void show_eye(Eye eye);

    /// Renders one frame of the scene. `tile_done` as in render().
    RenderedFrame frame(double frame, const RenderSettings& settings, const Progress& progress = {},
                        const TileDone& tile_done = {});

    /// The layers of a frame after their looks, as the renderer gets them, in file order; their splats stay
    /// until the next call of any method that is not const. None may be streamed.
    std::vector<RenderLayer> shaded_layers(double frame, const Progress& progress = {});

    /// Render settings as the scene's [output] has them.
    RenderSettings settings(double frame) const;
    Camera camera(double frame, const RenderSettings& settings) const;
    const std::vector<LayerStatistics>& statistics() const;
    /// Names of the layers drawn at a frame, in file order: those of RenderedFrame::layers.
    std::vector<std::string> layer_names(double frame) const;
    /// Credits of all pictures and splat files in use, each once, joined with "; ".
    std::string input_credit() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
