// The sets that the layers of a scene want, those that they have, and the next job. In: wishes, and the
// result of each job. Out: the next job, the newest wish first, and each layer's set and status. Knows no
// threads: SetLoader holds the lock and does the work.
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "edit/status.h"
#include "scene/scene.h"
#include "viewer/growing_set.h"
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

class SetList {
  public:
    using Layer = std::shared_ptr<const LoadedLayer>;

    /// `sample_limit` as SetLoader's; `samples`: sets that are read are sampled first.
    explicit SetList(std::int64_t sample_limit, bool samples = false)
        : sample_limit_(sample_limit), samples_(samples) {}

    // Wishes, with SetLoader's meaning.
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

    /// The job to do now.
    std::optional<SetTask> next_task() const;
    /// Begins it; it lasts until end().
    std::shared_ptr<SetJob> begin_next();
    void end() { job_.reset(); }

    /// A sampling job's result: shown until the layer's set is there, or a part of it.
    void show_sample(const SetJob& finished, Layer sampled);
    /// A loading job's result. Gives back what it replaces, or itself where nobody wants it any more: large,
    /// to be let go without the lock.
    Layer keep(const SetJob& finished, Layer loaded);
    /// The same set with more known of it; gives back likewise.
    Layer replace(const SetJob& finished, Layer loaded);
    void fail(const SetJob& finished, const std::string& why);

    /// The job whose set may be shown as far as it is; null: there is none, or nothing new of it.
    std::shared_ptr<SetJob> growing_job() const;
    /// Shows it; false: the job is over, or nobody wants its set any more.
    bool grow(const SetJob& job, LoadedLayer grown);

    std::uint64_t revision() const { return revision_; }
    /// The latest set of a layer, or what there is of the one being generated; null: none.
    Layer shown(const std::string& name) const;
    LayerStatus status(const LayerParams& layer) const;
    /// Some layer is being loaded, or waits for it.
    bool loading() const;
    /// There is nothing to be done.
    bool resting() const;

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
    std::map<std::string, Entry> entries_;              // by layer name
    std::map<SetTask, std::list<std::string>> queues_;  // names of layers; the next one first
    std::shared_ptr<SetJob> job_;                       // being done
    std::uint64_t revision_ = 0;
    bool held_ = false;
};

}  // namespace astrosplat
