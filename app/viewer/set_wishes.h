// Which sets the scene wants of the loader, and when: a source that is being edited waits until the hand has
// rested; and a set that grows is shown as often as takes it a few percent of its time. Meanwhile a preview
// follows levels, colours and alpha that are dragged: a sample of the layer's splats with new colours, which
// columns read from the pictures, while structures are multiplied by what became of the picture. In: the
// document, once a frame. Out: the loader's sets, or a LoadedLayer without a set until that is made again.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "edit/document.h"
#include "viewer/background_work.h"
#include "viewer/loaded_layer.h"
#include "viewer/set_loader.h"

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

/// Keeps meshes, thinned pictures and the sample's tree from one drag step to the next. Throws InputError,
/// Cancelled.
LatestWork<LiveRequest, LiveFound>::Work live_maker();

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
    LatestWork<LiveRequest, LiveFound> work_{live_maker()};
    LiveRequest asked_;
    std::shared_ptr<const LoadedLayer> found_;
    std::shared_ptr<const SplatSet> base_;  // whose preview found_ is
};

class SetWishes {
  public:
    SetWishes(const SetCache& cache, std::int64_t sample_limit) : loader_(cache, sample_limit) {}

    /// The document's sources should be wanted now; `now` in seconds.
    bool due(const Document& document, double now);
    void want(const Document& document);
    /// The sets are those of the document as it is, or have failed.
    bool loaded(const Document& document) const;

    /// The sets are wanted as the scene is.
    bool wanted(const Scene& scene) const;

    /// Works towards a preview of what a source is edited to, where that needs no set.
    void follow(const Scene& scene);
    bool following() const { return live_.working(); }
    /// The visible state of a layer: the loader's, or a preview under the levels that it has now.
    std::shared_ptr<const LoadedLayer> layer(const LayerParams& layer) const;

    /// Shows the part that there is of a set that is being generated.
    void show_growth(double now);
    /// There are other sets than at the last call.
    bool new_sets();
    /// Whether they are those that new_sets() saw last.
    bool same_sets() const { return seen_sets_ == loader_.revision(); }
    /// Drawing new sets took so much of this thread.
    void drew_new_sets(double seconds) { new_set_draw_s_ = seconds; }

    SetLoader& loader() { return loader_; }
    const SetLoader& loader() const { return loader_; }

  private:
    bool abandon_followed(const Scene& scene);

    SetLoader loader_;
    LiveTexels live_;
    std::uint64_t wanted_revision_ = 0;  // of the document
    std::vector<SourceParams> wanted_sources_, edited_sources_;
    double source_edited_at_ = -1.0;  // below 0: no source waits to be generated again
    double grows_at_ = 0.0;           // when a set that is generated may be shown again
    double new_set_draw_s_ = 0.0;
    std::uint64_t seen_sets_ = 0;  // revision of the loader
};

/// Processor time of this thread: what work costs the others, however busy the machine is.
double thread_seconds();

}  // namespace astrosplat
