// The final frame in the background: the offline renderer on a thread of its own, whose tiles the window
// takes as they come. The pixels are the very bits of `--batch` at that size.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/worker.h"
#include "render/render.h"
#include "scene/scene.h"
#include "splats/splat_set.h"

namespace astrosplat {

class Pipeline;

/// One frame to compute.
struct FinalRequest {
    Scene scene;                                        // evaluated by the pipeline at `frame`
    std::vector<std::shared_ptr<const SplatSet>> sets;  // one a layer; null: the layer is not drawn
    std::shared_ptr<const Environment> environment;     // of the scene, where it is loaded already
    std::uint64_t files = 0;  // another number: files were changed, and what is kept of them is read again
    double frame = 1.0;
    std::int64_t width = 0, height = 0;  // px
    Region region;                       // empty: all
    bool depth = false;                  // also RenderedFrame::depth; changes no pixel of the beauty
};

class FinalFrame {
  public:
    FinalFrame();
    ~FinalFrame();  // cancels and waits

    /// Cancels what is under way and begins again. Returns at once.
    void start(FinalRequest request);
    /// Cancels and returns at once: state() is idle from then on, and the thread stops within 50 ms of work.
    void cancel() { replace(nullptr); }

    enum class State { idle, running, done, failed };
    struct Outcome {
        State state = State::idle;
        std::string error;  // failed
        // When done:
        double seconds = 0.0;  // from the thread's taking up the request to the last pixel
        std::shared_ptr<const RenderedFrame> frame;  // its beauty is region-sized
    };
    Outcome outcome() const;
    float progress() const;

    /// Tiles finished since the last call, copied into `image` (resized to the request's). Returns their
    /// regions, px of `image`. Never blocks on the renderer. `outcome`, where it is given, says how far the
    /// frame was when they were taken: once it is done, the image is whole. Asked for afterwards, it could
    /// know of tiles that were not taken.
    std::vector<Region> take_tiles(Image& image, Outcome* outcome = nullptr);

  private:
    struct Run;

    void replace(std::shared_ptr<Run> run);
    std::shared_ptr<Run> latest() const;
    Worker::Task next_run();
    void work(Run& run);
    static void render(Pipeline& pipeline, Run& run);

    // With the worker's lock:
    std::shared_ptr<Run> current_;  // the latest; null before the first and after cancel()
    std::shared_ptr<Run> next_;     // not begun yet
    // The thread's:
    std::unique_ptr<Pipeline> pipeline_;
    std::uint64_t files_ = 0;  // of the request that it was made for
    Worker worker_{[this] { return next_run(); }};
};

}  // namespace astrosplat
