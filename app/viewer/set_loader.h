// Layers' sets, loaded and generated in the background, newest wish first: samples of kept ones first, then
// the set, its tree for the preview, its histograms. And which sets the scene wants, and when: a source that
// is being edited waits until the hand has rested; a set that grows is shown as often as takes it a few
// percent of its time. Meanwhile a preview follows levels, colours and alpha that are dragged: a sample of
// the layer's splats with new colours, which columns read from the pictures, while structures are multiplied
// by what became of the picture. In: the document, once a frame. Out: the loader's sets, or a LoadedLayer
// without a set until that is made again.
#pragma once

#include <atomic>
#include <list>
#include <map>
#include <mutex>

#include "core/worker.h"
#include "edit/document.h"
#include "edit/status.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "sets/set_sample.h"
#include "viewer/background_work.h"
#include "viewer/loaded_layer.h"

namespace astrosplat {

/// The tasks for a layer, the first for all layers before the second for any.
enum class SetTask { sample, load, arrange, describe };

/// One task for one layer. Only the atomics and `growing` change once it has begun.
struct SetJob {
    SetTask task = SetTask::load;
    std::string name;
    SourceParams source, identity;
    std::shared_ptr<const LoadedLayer> loaded;   // what the layer had when it began
    std::shared_ptr<const LoadedLayer> sampled;  // and a sample of what is being loaded; null: none
    std::atomic<bool> cancelled{false};
    std::atomic<float> progress{0.0f};
    GrowingSet growing;

    SetJob(std::int64_t growing_limit, std::int64_t column_limit) : growing(growing_limit, column_limit) {}
};

/// The sets that the layers of a scene want, those that they have, and the next job. Knows no threads:
/// SetLoader holds the lock and does the work.
class SetList {
  public:
    using Layer = std::shared_ptr<const LoadedLayer>;

    /// `sample_limit` as SetLoader's; `samples`: sets that are read are sampled first.
    explicit SetList(std::int64_t sample_limit, bool samples = false)
        : sample_limit_(sample_limit), samples_(samples) {}

    // Wishes and questions, with SetLoader's meaning.
    void want(const Scene& scene);
    void outdate(const std::string& name);
    void retry(const std::string& name);
    void cancel(const std::string& name);
    void abandon(const std::string& name);
    void cancel_job() {
        if (job_) job_->cancelled = true;
    }
    /// False: it was so already.
    bool hold(bool held) { return std::exchange(held_, held) != held; }
    std::uint64_t revision() const { return revision_; }
    Layer shown(const std::string& name) const;
    LayerStatus status(const LayerParams& layer) const;
    /// Some layer is being loaded, or waits for it.
    bool loading() const;
    /// There is nothing to be done.
    bool resting() const;

    /// The job to do now.
    std::optional<SetTask> next_task() const;
    /// Begins it; it lasts until end().
    std::shared_ptr<SetJob> begin_next();
    void end() { job_.reset(); }

    /// A sampling job's result: shown until the layer's set is there, or a part of it.
    void show_sample(const SetJob& finished, Layer sampled);
    /// A loading job's result. Gives back what it replaces, or itself where it is not wanted any more: large,
    /// to be let go without the lock.
    Layer keep(const SetJob& finished, Layer loaded);
    /// The same set with more known of it; gives back likewise.
    Layer replace(const SetJob& finished, Layer loaded);
    void fail(const SetJob& finished, const std::string& why);

    /// The job whose set may be shown as far as it is; null: there is none, or nothing new of it.
    std::shared_ptr<SetJob> growing_job() const;
    /// Shows it; false: the job is over, or its set is not wanted any more.
    bool grow(const SetJob& job, LoadedLayer grown);

  private:
    enum class Stage { waiting, loading, ready, failed, cancelled };

    struct Entry {
        SourceParams source;                   // wanted last
        std::optional<SourceParams> identity;  // of `source`; none: to be begun again
        Stage stage = Stage::waiting;
        std::string error;
        Layer loaded;
        Layer growing;  // shown instead, while the next one is generated or read
        std::shared_ptr<const LayerHistograms> histograms;  // the latest: the next ones come late
    };

    Entry* find(const std::string& name);  // null: there is none
    Layer find_loaded(const SourceParams& identity) const;
    void stop_growing(Entry& entry);
    void stop(const std::string& name);
    bool want_layer(const Scene& scene, const LayerParams& layer);
    void forget_layers_not_in(const Scene& scene);
    bool is_wanted(const SetJob& finished) const;
    void queue_rest(const std::string& name, const LoadedLayer& loaded);

    std::int64_t sample_limit_;
    bool samples_;
    std::map<std::string, Entry> entries_;                                   // by layer name
    std::map<SetTask, std::list<std::string>> queues_{{SetTask::load, {}}};  // names of layers, in order
    std::shared_ptr<SetJob> job_;                                            // being done
    std::uint64_t revision_ = 0;
    bool held_ = false;
};

class SetLoader {
  public:
    /// Loads or generates a set, as load_source does, and tells the watcher of it.
    using Load = std::function<SplatSet(const SourceParams& source, const std::string& layer_name,
                                        const Progress& progress, KeptWatcher& watcher)>;
    /// Some rows of a set that is there to be read; nothing where it is not.
    using Sample = std::function<std::optional<SetSample>(
        const SourceParams& source, const std::string& layer_name, const Progress& progress)>;

    /// `sample_limit`: splats of a layer that is shown before its tree is there.
    SetLoader(const SetCache& cache, std::int64_t sample_limit);
    /// Sets come from `load`, and samples before them from `sample`, which may be empty; both are called in
    /// another thread. No trees are kept.
    SetLoader(Load load, Sample sample, std::int64_t sample_limit);
    SetLoader(Load load, std::int64_t sample_limit) : SetLoader(std::move(load), {}, sample_limit) {}
    ~SetLoader();  // cancels and waits

    /// Makes sure that every layer of the scene has its set or is on its way: starts what is missing or
    /// changed, cancels what is not wanted any more. Cheap when nothing changed. Layers never visible are not
    /// loaded.
    void want(const Scene& scene) {
        list()->want(scene);
        worker_.wake();
    }
    /// Files of a layer have changed: the next want() begins it again. Its old set stays until the new one is
    /// there.
    void outdate(const std::string& layer_name) { list()->outdate(layer_name); }
    /// Begins again a layer that was cancelled or failed.
    void retry(const std::string& layer_name) {
        list()->retry(layer_name);
        worker_.wake();
    }
    /// Stops one layer's loading; its old set, if any, stays.
    void cancel(const std::string& layer_name) { list()->cancel(layer_name); }
    /// The same where the next want() is to begin again, whatever it wants.
    void abandon(const std::string& layer_name) { list()->abandon(layer_name); }
    /// Lets layer() give a fresh sample of the set that is being generated, until it is there. An old set
    /// stays until the new one is about everywhere it will be. False: there is nothing new to be seen.
    bool grow();

    /// Grows whenever a layer of the wanted scene got its set or its histograms, or failed.
    std::uint64_t revision() const { return list()->revision(); }
    /// The latest set of a layer, which may be older than its source, or a sample of the one being generated;
    /// null: none yet.
    std::shared_ptr<const LoadedLayer> layer(const std::string& layer_name) const {
        return list()->shown(layer_name);
    }
    /// loading, progress, found, stale, error, splats and histograms filled in.
    LayerStatus status(const LayerParams& layer) const { return list()->status(layer); }
    /// Every wanted layer has its set, or has failed or been cancelled.
    bool sets_there() const { return !list()->loading(); }
    /// The same with all that comes later: previews in order, histograms.
    bool idle() const { return list()->resting(); }
    void wait() {
        worker_.wait([&] { return list_.resting(); });
    }
    /// Does not begin what comes later, while something more urgent needs the processor.
    void hold(bool rest) {
        if (list()->hold(rest)) worker_.wake();
    }

  private:
    /// The list, under the worker's lock for as long as this lives.
    template <class List>
    struct Held {
        std::unique_lock<std::mutex> lock;
        List* list;
        List* operator->() const { return list; }
    };
    Held<SetList> list() { return {worker_.lock(), &list_}; }
    Held<const SetList> list() const { return {worker_.lock(), &list_}; }

    Worker::Task next_task();
    // In the worker's thread:
    void work(SetJob& job);
    void sample(const SetJob& job);
    void load(SetJob& job);
    void arrange(const SetJob& job);
    void describe(const SetJob& job);
    void replace(const SetJob& job, LoadedLayer layer);

    Load load_set_;
    Sample sample_set_;
    SetCache trees_;  // where those of large sets are kept
    std::int64_t sample_limit_;
    SetList list_;  // used by way of list(), or where the worker holds its lock
    Worker worker_{[this] { return next_task(); }};
};

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
