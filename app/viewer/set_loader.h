// Layers' sets, loaded and generated in the background, newest wish first: what stands for them first (rows
// of kept ones, a flat picture and then a quick body), then the set, its tree for the preview, its
// histograms. And which sets the scene wants, and when: a source that is being edited waits until the hand
// has rested. Meanwhile a preview follows what is dragged: a sample of the layer's splats, which columns read
// from the pictures under new levels, while bodies are moved by their new model and multiplied by what became
// of the picture. In: the document, once a frame. Out: the loader's sets, or a LoadedLayer without a set
// until that is made again.
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

/// One task for one layer. Only the atomics and `made` change once it has begun.
struct SetJob {
    SetTask task = SetTask::load;
    std::string name;
    SourceParams source, identity;
    std::shared_ptr<const LoadedLayer> loaded;   // what the layer had when it began
    std::shared_ptr<const LoadedLayer> sampled;  // and a sample of what is being loaded; null: none
    std::atomic<bool> cancelled{false};
    std::atomic<float> progress{0.0f};
    MadeColumns made;

    explicit SetJob(std::int64_t column_limit) : made(column_limit) {}
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
    /// Tasks after `last` do not begin. False: it was so already.
    bool hold_after(SetTask last) { return std::exchange(last_, last) != last; }
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

    /// A sampling job's result: shown until the next one or the layer's set is there.
    void show_sample(const SetJob& finished, Layer sampled);
    /// A loading job's result. Gives back what it replaces, or itself where it is not wanted any more: large,
    /// to be let go without the lock.
    Layer keep(const SetJob& finished, Layer loaded);
    /// The same set with more known of it; gives back likewise.
    Layer replace(const SetJob& finished, Layer loaded);
    void fail(const SetJob& finished, const std::string& why);

  private:
    enum class Stage { waiting, loading, ready, failed, cancelled };

    struct Entry {
        SourceParams source;                   // wanted last
        std::optional<SourceParams> identity;  // of `source`; none: to be begun again
        Stage stage = Stage::waiting;
        std::string error;
        Layer loaded;
        Layer sampled;  // shown instead, while the next one is generated or read
        std::shared_ptr<const LayerHistograms> histograms;  // the latest: the next ones come late
    };

    Entry* find(const std::string& name);  // null: there is none
    Layer find_loaded(const SourceParams& identity) const;
    void drop_sample(Entry& entry);
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
    SetTask last_ = SetTask::describe;  // that may begin
};

class SetLoader {
  public:
    /// Loads or generates a set, as load_source does, and tells the watcher of it.
    using Load = std::function<SplatSet(const SourceParams& source, const std::string& layer_name,
                                        const Progress& progress, KeptWatcher& watcher)>;
    /// What is seen of a set before it is there, as show_quick_sets.
    using Sample = std::function<void(const SourceParams& source, const std::string& layer_name,
                                      const QuickSets& quick, const Progress& progress)>;

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
    /// Grows whenever a layer of the wanted scene got its set or its histograms, or failed.
    std::uint64_t revision() const { return list()->revision(); }
    /// The latest set of a layer, which may be older than its source, or what stands for the one being
    /// generated; null: none yet.
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
    /// Does not begin what comes after `last`, while something more urgent needs the processor.
    void hold_after(SetTask last) {
        if (list()->hold_after(last)) worker_.wake();
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

/// Whether a preview of `now` can be made of the set of `before`: only levels and the like of pictures that
/// are not prepared differ, and of bodies what moves them.
bool can_follow(const SourceParams& before, const SourceParams& now);

struct LiveRequest {
    std::shared_ptr<const LoadedLayer> loaded;
    SourceParams source;
    bool operator==(const LiveRequest& other) const;
};

struct LiveFound {
    std::shared_ptr<const LoadedLayer> layer;
    std::string error;
};

/// Keeps meshes, thinned pictures and models from one drag step to the next. Throws InputError, Cancelled.
LatestWork<LiveRequest, LiveFound>::Work live_maker(const PictureMaker& prepared = make_prepared);

class LiveSets {
  public:
    explicit LiveSets(const PictureMaker& prepared) : work_(live_maker(prepared)) {}

    /// Works towards a layer under this source; what is under way is finished first, so that a hand that
    /// never rests sees something. Returns at once.
    void want(const LiveRequest& request);
    /// The latest of that loaded layer, which may lag behind; null: there is none yet.
    std::shared_ptr<const LoadedLayer> layer(const std::shared_ptr<const LoadedLayer>& loaded) const;
    /// Whether the last request was of that set.
    bool knows(const LoadedLayer& loaded) const { return asked_.loaded && asked_.loaded->set == loaded.set; }
    bool working() const { return work_.working(); }
    /// The next want() may find a newer one.
    bool comes() const {
        if (work_.working()) return true;
        const auto found = work_.found(asked_);
        return found && found->layer != found_;
    }
    void forget();

  private:
    LatestWork<LiveRequest, LiveFound> work_;
    LiveRequest asked_;
    std::shared_ptr<const LoadedLayer> found_;
    std::shared_ptr<const SplatSet> base_;  // whose preview found_ is
};

class SetWishes {
  public:
    SetWishes(const SetCache& cache, std::int64_t sample_limit)
        : loader_(cache, sample_limit), live_(kept_pictures(cache)) {}

    /// The document's sources should be wanted now; `now` in seconds.
    bool due(const Document& document, double now);
    void want(const Document& document);
    /// The sets are those of the document as it is, or have failed.
    bool loaded(const Document& document) const;

    /// The sets are wanted as the scene is.
    bool wanted(const Scene& scene) const;

    /// Works towards a preview of what a source is edited to, where that needs no set; else, with time to
    /// `spare`, gets ready to do so at once for bodies of the layer of that number.
    void follow(const Scene& scene, std::size_t layer = 0, bool spare = false);
    bool following() const { return follows_ && live_.comes(); }
    bool prepares() const { return !follows_ && live_.working(); }
    /// The visible state of a layer: the loader's, or a preview under the levels that it has now.
    std::shared_ptr<const LoadedLayer> layer(const LayerParams& layer) const;

    /// The sets that there are are drawn now.
    void see_sets() { seen_sets_ = loader_.revision(); }
    /// Whether there are no others since.
    bool same_sets() const { return seen_sets_ == loader_.revision(); }

    SetLoader& loader() { return loader_; }
    const SetLoader& loader() const { return loader_; }

  private:
    bool abandon_followed(const Scene& scene);

    SetLoader loader_;
    LiveSets live_;
    bool follows_ = false;
    std::uint64_t wanted_revision_ = 0;  // of the document
    std::vector<SourceParams> wanted_sources_, edited_sources_;
    double source_edited_at_ = -1.0;  // below 0: no source waits to be generated again
    std::uint64_t seen_sets_ = 0;     // revision of the loader
};

}  // namespace astrosplat
