// An entry per layer name holds what was wanted last and what there is; both are compared by all that makes a
// set (identity_of), so that a renamed or copied layer finds its set again.
#include "viewer/set_list.h"

#include <algorithm>
#include <utility>

#include "generate/lattice.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"

namespace astrosplat {
namespace {

constexpr SetTask tasks[] = {SetTask::sample, SetTask::load, SetTask::arrange, SetTask::describe};

/// Progress from which a set is wherever it will be: corners, which run through the whole box, come before
/// centres.
constexpr float everywhere = 0.5f;

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

/// Splats of a view that is made again and again while everything else should go on.
std::int64_t growing_limit(std::int64_t sample_limit) { return std::max<std::int64_t>(sample_limit / 4, 1); }

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

void SetList::stop_growing(Entry& entry) {
    if (entry.growing) ++revision_;
    entry.growing.reset();
}

void SetList::stop(const std::string& name) {
    for (auto& queue : queues_) queue.second.remove(name);
    if (Entry* const entry = find(name)) stop_growing(*entry);
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
        const auto layer = std::find_if(scene.layers.begin(), scene.layers.end(),
                                        [&](const LayerParams& l) { return l.name == it->first; });
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
    for (const std::string& name : changed)
        if (samples_ && !entries_[name].loaded) queues_[SetTask::sample].push_back(name);
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
    for (const SetTask task : tasks) {
        const auto queue = queues_.find(task);
        if (held_ && task > SetTask::load) break;
        if (queue != queues_.end() && !queue->second.empty()) return task;
    }
    return std::nullopt;
}

std::shared_ptr<SetJob> SetList::begin_next() {
    const SetTask task = next_task().value();
    std::list<std::string>& names = queues_[task];
    job_ = std::make_shared<SetJob>(growing_limit(sample_limit_), sample_limit_);
    job_->task = task;
    job_->name = names.front();
    names.pop_front();
    Entry& entry = entries_[job_->name];
    job_->source = entry.source;
    job_->identity = *entry.identity;
    job_->loaded = entry.loaded;
    job_->sampled = entry.growing;
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
    entries_[finished.name].growing = std::move(sampled);
    ++revision_;
}

SetList::Layer SetList::keep(const SetJob& finished, Layer loaded) {
    if (!is_wanted(finished)) return loaded;
    Entry& entry = entries_[finished.name];
    queue_rest(finished.name, *loaded);
    stop_growing(entry);
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
    stop_growing(entry);
    entry.stage = Stage::failed;
    entry.error = why;
    ++revision_;
}

std::shared_ptr<SetJob> SetList::growing_job() const {
    if (!job_ || job_->task != SetTask::load || !is_wanted(*job_)) return nullptr;
    const Entry& entry = entries_.at(job_->name);
    const std::int64_t kept = job_->growing.kept();
    if (kept == 0 || (entry.growing && entry.growing->splats == kept)) return nullptr;
    return entry.loaded && job_->progress < everywhere ? nullptr : job_;
}

bool SetList::grow(const SetJob& job, LoadedLayer grown) {
    if (job_.get() != &job || !is_wanted(job)) return false;
    Entry& entry = entries_[job.name];
    if (entry.loaded) grown.box = entry.loaded->box;  // so that the view does not move
    entry.growing = std::make_shared<const LoadedLayer>(std::move(grown));
    ++revision_;
    return true;
}

SetList::Layer SetList::shown(const std::string& name) const {
    const auto found = entries_.find(name);
    if (found == entries_.end()) return nullptr;
    return found->second.growing ? found->second.growing : found->second.loaded;
}

LayerStatus SetList::status(const LayerParams& layer) const {
    LayerStatus status;
    const auto found = entries_.find(layer.name);
    if (found == entries_.end()) return status;
    const Entry& entry = found->second;
    SourceParams source = layer.source;
    source.stars.path = entry.source.stars.path;  // which only the whole scene knows
    const SourceParams identity = identity_of(source, layer.name);
    const bool current = entry.identity == identity;
    status.loading = current && (entry.stage == Stage::waiting || entry.stage == Stage::loading);
    if (current) status.error = entry.error;
    if (current && entry.stage == Stage::loading && job_ && job_->name == layer.name) {
        status.progress = job_->progress;
        status.found = job_->growing.kept();
    }
    const Layer& seen = entry.growing ? entry.growing : entry.loaded;
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
    const auto queue = queues_.find(SetTask::load);
    return (job_ && job_->task == SetTask::load) || (queue != queues_.end() && !queue->second.empty());
}

bool SetList::resting() const {
    return !job_ && std::all_of(queues_.begin(), queues_.end(),
                                [](const auto& queue) { return queue.second.empty(); });
}

}  // namespace astrosplat
