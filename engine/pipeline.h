// The whole flow: sources -> SplatSets -> look -> ShadedSplats -> render -> RenderedFrame.
#pragma once

#include "core/progress.h"
#include "frame/frame_scene.h"
#include "render/render.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "source/object_metadata.h"
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

/// Render settings as [output] has them.
RenderSettings render_settings(const OutputParams& output);

/// State that stays between frames: the sets, the maps, the environment pictures, the last shaded splats
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

    /// A frame of the scene, which all that follows can be asked of.
    FrameScene frame_scene(double number, std::optional<Eye> eye = {}) const;

    /// Renders one frame of the scene. `tile_done` as in render(), but once and for the whole frame where
    /// that is blurred.
    RenderedFrame frame(const FrameScene& frame, const RenderSettings& settings,
                        const Progress& progress = {}, const TileDone& tile_done = {});
    RenderedFrame frame(double number, const RenderSettings& settings, const Progress& progress = {},
                        const TileDone& tile_done = {}) {
        return frame(frame_scene(number), settings, progress, tile_done);
    }

    /// The layers of a frame after their looks, at its own time, as the renderer gets them, in file order;
    /// their splats stay until the next call of any method that is not const. None may be streamed.
    std::vector<RenderLayer> shaded_layers(const FrameScene& frame, const Progress& progress = {});

    /// The camera at the frame's own time, between lens and shutter.
    Camera camera(const FrameScene& frame, const RenderSettings& settings) const;
    const std::vector<LayerStatistics>& statistics() const;
    /// Names of the layers drawn at some moment of a frame, in file order: those of RenderedFrame::layers.
    std::vector<std::string> layer_names(const FrameScene& frame) const;
    /// What all pictures and splat files in use say of themselves. Throws InputError.
    ObjectMetadata input_metadata() const;
    /// Which parts of each layer in use are measured and which invented, "NAME: ..." joined with " | ".
    std::string input_origin() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
