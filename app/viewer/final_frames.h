// Final frames that were shown, kept in memory: where the same is to be seen again, by scrubbing, by playing
// or by undo, they are there at once. In: requests and their frames. Out: the frame of an equal request.
#pragma once

#include "render/frame.h"
#include "scene/scene.h"
#include "viewer/loaded_layer.h"

namespace astrosplat {

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

/// A frame to be shown: the scene as it stands, with the view's camera; layers that are not to be seen are
/// invisible. Requests that ask for the same and have the same sets show equal frames.
struct ViewRequest : FrameRequest {
    std::vector<std::shared_ptr<const LoadedLayer>> layers;  // as in the scene; null: not loaded
    Bounds box;                                              // of the visible layers, world space
};

/// The camera of a request, for its whole frame. Throws InputError.
Camera camera_of(const ViewRequest& request);

/// They ask for the same, whatever sets there are.
bool ask_the_same(const FrameRequest& a, const FrameRequest& b);
/// Of the sets, or of what there is of them so far: every sample of a set that is being made is another.
bool have_same_sets(const ViewRequest& a, const ViewRequest& b);

class FinalFrames {
  public:
    /// Of one frame: what it was asked for, and what came of it.
    struct Kept {
        FrameRequest request;
        std::vector<std::weak_ptr<const SplatSet>> sets;  // one a layer, not held in memory for this
        std::shared_ptr<const RenderedFrame> frame;
        double seconds = 0.0;  // it took so long to make
        std::uint64_t used = 0;
    };

    /// Most bytes of all frames together; 0: none is kept. Nor do they take more than a quarter of what would
    /// be free without them.
    void limit(std::int64_t most_bytes) { most_bytes_ = most_bytes; }

    /// Of an equal request with the same sets; null: there is none. It is the last one to go from now on.
    const Kept* find(const ViewRequest& request);
    /// False: there is no room. Frames make room, those first that were not used for longest, but for those
    /// used since begin_round(): of a loop that is too long the same frames stay, or none would be found.
    bool keep(const ViewRequest& request, std::shared_ptr<const RenderedFrame> frame, double seconds);
    void begin_round() { round_ = clock_; }

    std::int64_t bytes() const { return bytes_; }
    std::size_t count() const { return kept_.size(); }
    /// The last one found no room.
    bool full() const { return full_; }
    /// Grows whenever some go.
    std::uint64_t drops() const { return drops_; }

  private:
    bool make_room(std::int64_t bytes);
    void drop(const std::function<bool(const Kept&)>& which);

    std::vector<Kept> kept_;
    std::int64_t most_bytes_ = 0, bytes_ = 0;
    std::uint64_t clock_ = 0, round_ = 0, drops_ = 0;
    bool full_ = false;
};

}  // namespace astrosplat
