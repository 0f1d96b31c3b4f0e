// The final frame in the background: the offline renderer on a thread of its own, whose tiles the window
// takes as they come. The pixels are the very bits of `--batch` at that size.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "render/render.h"
#include "scene/scene.h"
#include "splats/splat_set.h"
#include "viewer/background_work.h"

namespace astrosplat {

class Pipeline;

/// A frame that is asked for, or a part of it.
struct FrameRequest {
    Scene scene;
    double frame = 1.0;         // at which the scene's animation, if it has kept any, is evaluated
    int width = 0, height = 0;  // px of the whole frame
    Region region;              // the part of it; empty: all
    std::uint64_t files = 0;    // another number: files were changed, and what is kept of them is read again
    /// The same part, never empty.
    Region part() const { return region.width > 0 ? region : Region{0, 0, width, height}; }
};

/// One frame to compute.
struct FinalRequest : FrameRequest {
    std::vector<std::shared_ptr<const SplatSet>> sets;  // one a layer; null: the layer is not drawn
    std::shared_ptr<const Environment> environment;     // of the scene, where it is loaded already
    bool depth = false;  // also RenderedFrame::depth; changes no pixel of the beauty
};

class FinalFrame {
  public:
    /// Cancels what is under way and begins again. Returns at once.
    void start(FinalRequest request);
    /// Cancels and returns at once: state() is idle from then on, and the thread stops within 50 ms of work.
    void cancel();

    enum class State { idle, running, done, failed };
    struct Outcome {
        State state = State::idle;
        std::string error;  // failed
        // When done:
        double seconds = 0.0;  // from the thread's taking up the request to the last pixel
        std::shared_ptr<const RenderedFrame> frame;  // its beauty is region-sized
    };
    /// Once it is done before take_tiles(), that call makes the image whole.
    Outcome outcome() const;
    float progress() const;

    /// Tiles finished since the last call, copied into `image` (resized to the request's). Returns their
    /// regions, px of `image`. Never blocks on the renderer.
    std::vector<Region> take_tiles(Image& image);

  private:
    struct Run;
    struct Found {
        double seconds = 0.0;
        std::shared_ptr<const RenderedFrame> frame;
        std::string error;
    };
    using Work = LatestWork<std::shared_ptr<Run>, Found>;
    static Found render(Pipeline& pipeline, Run& run, Progress progress);
    static Work::Work renderer();

    std::shared_ptr<Run> run_;  // the latest; null before the first and after cancel()
    Work work_{renderer()};
};

}  // namespace astrosplat
