// A layer under other levels, colours or alpha than its set was made with, for a preview while they are
// dragged: a sample of its splats with new colours. Columns read them from the pictures, structures are
// multiplied by what became of the picture. In: what is loaded, and the source as it stands. Out: another
// LoadedLayer without a set, until that is made again.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "viewer/background_work.h"
#include "viewer/loaded_layer.h"

namespace astrosplat {

/// Whether a set of `now` has the geometry of one of `before`: of how pictures are read only that differs
/// which a preview can follow, and no picture is prepared.
bool only_texels_differ(const SourceParams& before, const SourceParams& now);

struct LiveRequest {
    std::shared_ptr<const LoadedLayer> loaded;
    SourceParams source;
    bool operator==(const LiveRequest& other) const;
};

struct LiveFound {
    std::shared_ptr<const LoadedLayer> layer;
    std::string error;
};

/// State that stays from one drag step to the next: meshes, thinned pictures and the sample's tree.
class LiveMaker {
  public:
    LiveMaker();
    ~LiveMaker();
    /// Throws InputError, Cancelled.
    LiveFound operator()(const LiveRequest& request, const Progress& progress);

  private:
    struct State;
    std::shared_ptr<State> state_;
};

class LiveTexels {
  public:
    /// Works towards a layer under this source; what is under way is finished first, so that a hand that
    /// never rests sees something. Returns at once.
    void want(const LiveRequest& request);
    /// The latest of that loaded layer, which may lag behind; null: there is none yet.
    std::shared_ptr<const LoadedLayer> layer(const std::shared_ptr<const LoadedLayer>& loaded) const;
    /// There may be a newer one soon.
    bool working() const { return work_.working(); }
    void forget();

  private:
    LatestWork<LiveRequest, LiveFound> work_{LiveMaker()};
    LiveRequest asked_;
    std::shared_ptr<const LoadedLayer> found_;
    std::shared_ptr<const SplatSet> base_;  // whose preview found_ is
};

}  // namespace astrosplat
