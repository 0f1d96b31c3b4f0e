// Loads and generates layers' sets in the background, newest wish first. In: a layer's source. Out: the set,
// samples of it, its tree for the preview, and its histograms. Of sets that are kept or lie in a file samples
// of all layers come first, in a fraction of the time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/worker.h"
#include "edit/status.h"
#include "scene/scene.h"
#include "sets/kept.h"
#include "sets/set_sample.h"
#include "viewer/loaded_layer.h"
#include "viewer/set_list.h"

namespace astrosplat {

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
    /// changed, cancels what nobody wants any more. Cheap when nothing changed. Layers never visible are not
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

}  // namespace astrosplat
