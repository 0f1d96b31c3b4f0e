// An entry per layer name holds what was wanted last and what there is; both are compared by all that makes a
// set (identity_of), so that a renamed or copied layer finds its set again. One thread does what the list
// says next: the list is used under the lock, the work is done without it.
#include "viewer/set_loader.h"

#include <exception>
#include <new>

#include "core/error.h"
#include "core/parallel.h"
#include "generate/lattice.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"

namespace astrosplat {
namespace {

/// All that a set depends on: the source with its seed resolved where one is used.
SourceParams identity_of(const SourceParams& source, const std::string& name) {
    SourceParams identity = source;
    const bool random =
        source.kind == SourceKind::mesh || follows_camera(source) || !source.stars.like.empty();
    identity.seed = random ? resolved_seed(source.seed, name) : 0;
    const StarsParams unused;
    identity.stars.psf = unused.psf;  // how stars look is the renderer's
    identity.stars.wings = unused.wings;
    identity.stars.spikes = unused.spikes;
    return identity;
}

bool satisfies(const LoadedLayer& loaded, const SourceParams& identity) {
    return !loaded.outdated && identity_of(loaded.source, loaded.name) == identity;
}

/// A first sample is so many times smaller than those that come with the sets: all layers are to be seen at
/// once.
constexpr std::int64_t rows_at_first = 4;

/// One line that a person can read.
std::string reason(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return "not enough memory for this layer";
    return error.what();
}

}  // namespace

SetList::Entry* SetList::find(const std::string& name) {
    const auto found = entries_.find(name);
    return found == entries_.end() ? nullptr : &found->second;
}

SetList::Layer SetList::find_loaded(const SourceParams& identity) const {
    for (const auto& item : entries_)
        if (item.second.loaded && satisfies(*item.second.loaded, identity)) return item.second.loaded;
    return nullptr;
}

void SetList::drop_sample(Entry& entry) {
    if (entry.sampled) ++revision_;
    entry.sampled.reset();
}

void SetList::stop(const std::string& name) {
    for (auto& queue : queues_) queue.second.remove(name);
    if (Entry* const entry = find(name)) drop_sample(*entry);
    if (job_ && job_->name == name) job_->cancelled = true;
}

/// Whether the layer's set is to be loaded again.
bool SetList::want_layer(const Scene& scene, const LayerParams& layer) {
    SourceParams source = source_of(scene, layer);
    const SourceParams identity = identity_of(source, layer.name);
    Entry& entry = entries_[layer.name];
    entry.source = std::move(source);
    if (entry.identity == identity) return false;
    stop(layer.name);
    entry.identity = identity;
    entry.error.clear();
    if (Layer known = find_loaded(identity)) {
        queue_rest(layer.name, *known);
        entry.loaded = std::move(known);
        entry.stage = Stage::ready;
        ++revision_;
        return false;
    }
    entry.stage = Stage::waiting;
    return true;
}

void SetList::forget_layers_not_in(const Scene& scene) {
    for (auto it = entries_.begin(); it != entries_.end();) {
        const auto layer = std::ranges::find(scene.layers, it->first, &LayerParams::name);
        const bool absent = layer == scene.layers.end();
        Entry& entry = it->second;
        if (absent || !ever_visible(scene, *layer)) {
            stop(it->first);
            if (entry.stage != Stage::ready) entry.identity.reset();  // shown again: begins again
        }
        it = absent ? entries_.erase(it) : std::next(it);
    }
}

void SetList::want(const Scene& scene) {
    std::list<std::string> changed;
    for (const LayerParams& layer : scene.layers)
        if (ever_visible(scene, layer) && want_layer(scene, layer)) changed.push_back(layer.name);
    forget_layers_not_in(scene);  // after that, for a layer may have been renamed
    for (const std::string& name : changed) {
        const Entry& entry = entries_[name];
        const bool followed = entry.loaded && can_follow(entry.loaded->source, entry.source);
        if (samples_ && !followed) queues_[SetTask::sample].push_back(name);
    }
    std::list<std::string>& queue = queues_[SetTask::load];
    queue.splice(queue.begin(), changed);
}

void SetList::outdate(const std::string& name) {
    abandon(name);
    Entry* const entry = find(name);
    if (!entry || !entry->loaded) return;
    auto old = std::make_shared<LoadedLayer>(*entry->loaded);
    old->outdated = true;
    entry->loaded = std::move(old);
}

void SetList::retry(const std::string& name) {
    Entry* const entry = find(name);
    if (!entry || !entry->identity) return;
    if (entry->stage != Stage::failed && entry->stage != Stage::cancelled) return;
    entry->stage = Stage::waiting;
    entry->error.clear();
    queues_[SetTask::load].push_front(name);
}

void SetList::cancel(const std::string& name) {
    Entry* const entry = find(name);
    if (!entry || (entry->stage != Stage::waiting && entry->stage != Stage::loading)) return;
    stop(name);
    entry->stage = Stage::cancelled;
}

void SetList::abandon(const std::string& name) {
    Entry* const entry = find(name);
    if (!entry) return;
    stop(name);
    entry->identity.reset();
}

std::optional<SetTask> SetList::next_task() const {
    for (const auto& [task, names] : queues_)
        if (!names.empty() && task <= last_) return task;
    return std::nullopt;
}

std::shared_ptr<SetJob> SetList::begin_next() {
    const SetTask task = next_task().value();
    std::list<std::string>& names = queues_[task];
    job_ = std::make_shared<SetJob>(sample_limit_);
    job_->task = task;
    job_->name = names.front();
    names.pop_front();
    Entry& entry = entries_[job_->name];
    job_->source = entry.source;
    job_->identity = *entry.identity;
    job_->loaded = entry.loaded;
    job_->sampled = entry.sampled;
    if (task == SetTask::load) entry.stage = Stage::loading;
    return job_;
}

/// Whether a job's result is still what its layer asks for.
bool SetList::is_wanted(const SetJob& finished) const {
    const auto found = entries_.find(finished.name);
    return !finished.cancelled && found != entries_.end() && found->second.identity == finished.identity;
}

/// Queues the tasks that a layer with its set still lacks.
void SetList::queue_rest(const std::string& name, const LoadedLayer& loaded) {
    if (!loaded.arranged) queues_[SetTask::arrange].push_back(name);
    if (!loaded.histograms) queues_[SetTask::describe].push_back(name);
}

void SetList::show_sample(const SetJob& finished, Layer sampled) {
    if (!is_wanted(finished)) return;
    entries_[finished.name].sampled = std::move(sampled);
    ++revision_;
}

SetList::Layer SetList::keep(const SetJob& finished, Layer loaded) {
    if (!is_wanted(finished)) return loaded;
    Entry& entry = entries_[finished.name];
    queue_rest(finished.name, *loaded);
    drop_sample(entry);
    entry.stage = Stage::ready;
    ++revision_;
    return std::exchange(entry.loaded, std::move(loaded));
}

SetList::Layer SetList::replace(const SetJob& finished, Layer loaded) {
    if (!is_wanted(finished)) return loaded;
    ++revision_;
    Entry& entry = entries_[finished.name];
    if (loaded->histograms) entry.histograms = loaded->histograms;
    return std::exchange(entry.loaded, std::move(loaded));
}

void SetList::fail(const SetJob& finished, const std::string& why) {
    if (!is_wanted(finished)) return;
    Entry& entry = entries_[finished.name];
    drop_sample(entry);
    entry.stage = Stage::failed;
    entry.error = why;
    ++revision_;
}

SetList::Layer SetList::shown(const std::string& name) const {
    const auto found = entries_.find(name);
    if (found == entries_.end()) return nullptr;
    return found->second.sampled ? found->second.sampled : found->second.loaded;
}

LayerStatus SetList::status(const LayerParams& layer) const {
    LayerStatus status;
    const auto found = entries_.find(layer.name);
    if (found == entries_.end()) return status;
    const Entry& entry = found->second;
    SourceParams source = layer.source;
    source.stars.path = entry.source.stars.path;  // which only the whole scene knows, as what a parsec is
    if (!source.stars.unit) source.stars.unit = entry.source.stars.unit;
    const SourceParams identity = identity_of(source, layer.name);
    const bool current = entry.identity == identity;
    status.loading = current && (entry.stage == Stage::waiting || entry.stage == Stage::loading);
    if (current) status.error = entry.error;
    if (current && entry.stage == Stage::loading && job_ && job_->name == layer.name) {
        status.progress = job_->progress;
        status.found = job_->made.kept();
    }
    if (status.loading && entry.sampled) status.making = entry.sampled->making;
    const Layer& seen = entry.sampled ? entry.sampled : entry.loaded;
    if (!seen) return status;
    status.stale = !status.loading && !satisfies(*seen, identity);
    status.splats = seen->splats;
    status.radius_min = seen->radius.x;
    status.radius_max = seen->radius.y;
    status.body_height = seen->automatic.body_height;
    status.uv_width = seen->automatic.uv_width;
    status.color = seen->color;
    status.histograms = seen->histograms ? seen->histograms : entry.histograms;
    return status;
}

bool SetList::loading() const {
    return (job_ && job_->task == SetTask::load) || !queues_.at(SetTask::load).empty();
}

bool SetList::resting() const {
    return !job_ && std::ranges::all_of(queues_, [](const auto& queue) { return queue.second.empty(); });
}

Worker::Task SetLoader::next_task() {
    list_.end();
    if (!list_.next_task()) return {};
    return [this, job = list_.begin_next()] { work(*job); };
}

void SetLoader::work(SetJob& job) {
    const StoppableLoops stops({{}, &job.cancelled});
    try {
        if (job.task == SetTask::sample) sample(job);
        if (job.task == SetTask::load) load(job);
        if (job.task == SetTask::arrange) arrange(job);
        if (job.task == SetTask::describe) describe(job);
    } catch (const Cancelled&) {  // the caller that cancelled has said in the list what comes next
    } catch (const std::exception& error) {
        list()->fail(job, reason(error));
    }
}

/// A source that cannot be sampled cannot be read either: load() says why.
void SetLoader::sample(const SetJob& job) try {
    const auto show = [&](SetSample there) {
        if (there.set.size() == 0 || there.set.stars) return;
        LoadedLayer layer = sampled_layer(std::move(there), job.source, job.name);
        if (job.loaded) layer.box = job.loaded->box;  // so that the view does not move
        list()->show_sample(job, std::make_shared<const LoadedLayer>(std::move(layer)));
    };
    sample_set_(job.source, job.name, {sample_limit_ / rows_at_first, !job.loaded, show},
                {{}, &job.cancelled});
} catch (const InputError&) {
} catch (const std::bad_alloc&) {
    // the set may still come without one
}

/// The set, and what the preview needs to begin.
void SetLoader::load(SetJob& job) {
    const Progress progress{[&](double fraction) { job.progress = static_cast<float>(fraction); },
                            &job.cancelled};
    auto set = std::make_shared<const SplatSet>(load_set_(job.source, job.name, progress, job.made));
    const MergeSource* const sample = job.sampled && !job.sampled->stands_in ? &job.sampled->sample : nullptr;
    auto layer = std::make_shared<LoadedLayer>(
        whole_layer(std::move(set), job.source, job.name, sample_limit_, sample));
    layer->columns = job.made.columns();
    const SetList::Layer old = list()->keep(job, std::move(layer));  // let go after the lock
}

void SetLoader::arrange(const SetJob& job) {
    const Progress progress{{}, &job.cancelled};
    const KeptTree kept = read_or_build_tree(trees_, *job.loaded->set, progress);
    replace(job, arranged_layer(*job.loaded, kept.tree));
    keep_tree(trees_, kept, progress);
}

/// After everything that is waited for.
void SetLoader::describe(const SetJob& job) { replace(job, described_layer(*job.loaded)); }

void SetLoader::replace(const SetJob& job, LoadedLayer layer) {
    auto better = std::make_shared<const LoadedLayer>(std::move(layer));
    const SetList::Layer old = list()->replace(job, std::move(better));  // let go after the lock
}

SetLoader::SetLoader(const SetCache& cache, std::int64_t sample_limit)
    : SetLoader(
          [cache](const SourceParams& source, const std::string& name, const Progress& progress,
                  KeptWatcher& watcher) { return load_source(cache, source, name, progress, &watcher).set; },
          [cache](const SourceParams& source, const std::string& name, const QuickSets& quick,
                  const Progress& progress) { show_quick_sets(cache, source, name, quick, progress); },
          sample_limit) {
    trees_ = cache;
}
SetLoader::SetLoader(Load load, Sample sample, std::int64_t sample_limit)
    : load_set_(std::move(load)),
      sample_set_(std::move(sample)),
      sample_limit_(sample_limit),
      list_(sample_limit, sample_set_ != nullptr) {}

SetLoader::~SetLoader() { list()->cancel_job(); }

}  // namespace astrosplat
