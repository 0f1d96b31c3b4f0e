// One thread that takes the newest wish from a list. An entry per layer name holds what was wanted last and
// what there is; both are compared by all that makes a set (identity_of), so that a renamed or copied layer
// finds its set again.
#include "viewer/set_loader.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <list>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "core/error.h"
#include "pipeline.h"
#include "splats/lattice.h"

namespace astrosplat {
namespace {

/// All that a set depends on: the source with its seed resolved where one is used.
SourceParams identity_of(const SourceParams& source, const std::string& name) {
    SourceParams identity = source;
    identity.seed = source.kind == SourceKind::mesh ? resolved_seed(source.seed, name) : 0;
    return identity;
}

enum class Stage { waiting, loading, ready, failed, cancelled };

struct Entry {
    std::optional<SourceParams> identity;  // of what was wanted last; none: nothing
    Stage stage = Stage::waiting;
    std::string error;
    std::shared_ptr<const LoadedLayer> loaded;
    std::shared_ptr<const LoadedLayer> growing;  // shown instead, while the next one is generated
};

/// What is done for a layer, the first for all layers before the second for any.
enum class Task { load, arrange, describe };
constexpr Task tasks[] = {Task::load, Task::arrange, Task::describe};

/// What the thread is doing.
struct Job {
    Task task = Task::load;
    std::string name;
    SourceParams source, identity;
    std::atomic<bool> cancelled{false};
    std::atomic<float> progress{0.0f};
    GrowingSet growing;

    explicit Job(std::int64_t preview_limit) : growing(growing_limit(preview_limit)) {}

  private:
    /// Splats of a picture that is made again and again while everything else should go on.
    static std::int64_t growing_limit(std::int64_t preview_limit) {
        return std::clamp<std::int64_t>(preview_limit / 16, 1, 1 << 18);
    }
};

bool satisfies(const LoadedLayer& loaded, const SourceParams& identity) {
    return !loaded.outdated && identity_of(loaded.source, loaded.name) == identity;
}

/// Progress from which a set is wherever it will be: corners, which run through the whole box, come before
/// centres.
constexpr float everywhere = 0.5f;

/// One line that a person can read.
std::string reason(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return "not enough memory for this layer";
    return error.what();
}

}  // namespace

struct SetLoader::Impl {
    Load load_set;
    std::int64_t preview_limit;

    mutable std::mutex mutex;  // for all below
    std::condition_variable wake, rest;
    std::map<std::string, Entry> entries;  // by layer name
    std::map<std::string, SourceParams> sources;
    std::map<Task, std::list<std::string>> queues;  // names of layers; the next one first
    std::shared_ptr<Job> job;
    std::uint64_t revision = 0;
    bool held = false, ending = false;
    std::thread thread;  // last: it uses all the others

    Impl(Load load, std::int64_t limit)
        : load_set(std::move(load)), preview_limit(limit), thread([this] { work(); }) {}
    ~Impl() {
        {
            const std::lock_guard lock(mutex);
            ending = true;
            if (job) job->cancelled = true;
        }
        wake.notify_one();
        thread.join();
    }

    // With the mutex held.
    std::shared_ptr<const LoadedLayer> find_loaded(const SourceParams& identity) const;
    void stop_growing(Entry& entry);
    void stop(const std::string& name);
    bool want_layer(const LayerParams& layer);
    void forget_layers_not_in(const Scene& scene);
    bool is_wanted(const Job& finished) const;
    void queue_rest(const std::string& name, const LoadedLayer& loaded);
    std::optional<Task> next_task() const;
    bool loading() const;
    bool resting() const;
    std::shared_ptr<Job> next_job(Task task);
    std::shared_ptr<Job> growing_job() const;

    // Without it.
    std::shared_ptr<const LoadedLayer> loaded(const std::string& name) const;

    // The thread's.
    void work();
    void load(Job& current);
    void arrange(const Job& current);
    void describe(const Job& current);
    void replace(const Job& finished, LoadedLayer layer);
    void fail(const Job& current, const std::string& why);
};

std::shared_ptr<const LoadedLayer> SetLoader::Impl::find_loaded(const SourceParams& identity) const {
    for (const auto& item : entries)
        if (item.second.loaded && satisfies(*item.second.loaded, identity)) return item.second.loaded;
    return nullptr;
}

void SetLoader::Impl::stop_growing(Entry& entry) {
    if (entry.growing) ++revision;
    entry.growing.reset();
}

void SetLoader::Impl::stop(const std::string& name) {
    for (auto& queue : queues) queue.second.remove(name);
    if (!job || job->name != name) return;
    job->cancelled = true;
    stop_growing(entries[name]);
}

/// Whether the layer's set is to be loaded anew.
bool SetLoader::Impl::want_layer(const LayerParams& layer) {
    const SourceParams identity = identity_of(layer.source, layer.name);
    Entry& entry = entries[layer.name];
    sources[layer.name] = layer.source;
    if (entry.identity == identity) return false;
    stop(layer.name);
    entry.identity = identity;
    entry.error.clear();
    if (std::shared_ptr<const LoadedLayer> known = find_loaded(identity)) {
        queue_rest(layer.name, *known);
        entry.loaded = std::move(known);
        entry.stage = Stage::ready;
        ++revision;
        return false;
    }
    entry.stage = Stage::waiting;
    return true;
}

void SetLoader::Impl::forget_layers_not_in(const Scene& scene) {
    for (auto it = entries.begin(); it != entries.end();) {
        const auto layer = std::find_if(scene.layers.begin(), scene.layers.end(),
                                        [&](const LayerParams& l) { return l.name == it->first; });
        const bool absent = layer == scene.layers.end();
        Entry& entry = it->second;
        if (absent || !ever_visible(scene, *layer)) {
            stop(it->first);
            if (entry.stage != Stage::ready) entry.identity.reset();  // shown again: begins again
        }
        if (absent) sources.erase(it->first);
        it = absent ? entries.erase(it) : std::next(it);
    }
}

/// Whether a job's result is still what its layer asks for.
bool SetLoader::Impl::is_wanted(const Job& finished) const {
    const auto found = entries.find(finished.name);
    return !finished.cancelled && found != entries.end() && found->second.identity == finished.identity;
}

/// What a layer that has its set still lacks.
void SetLoader::Impl::queue_rest(const std::string& name, const LoadedLayer& loaded) {
    if (!loaded.arranged) queues[Task::arrange].push_back(name);
    if (!loaded.histograms) queues[Task::describe].push_back(name);
}

/// What the thread should do now.
std::optional<Task> SetLoader::Impl::next_task() const {
    for (const Task task : tasks) {
        const auto queue = queues.find(task);
        if (held && task != Task::load) break;
        if (queue != queues.end() && !queue->second.empty()) return task;
    }
    return std::nullopt;
}

bool SetLoader::Impl::loading() const {
    const auto queue = queues.find(Task::load);
    return (job && job->task == Task::load) || (queue != queues.end() && !queue->second.empty());
}

bool SetLoader::Impl::resting() const {
    return !job &&
           std::all_of(queues.begin(), queues.end(), [](const auto& queue) { return queue.second.empty(); });
}

std::shared_ptr<Job> SetLoader::Impl::next_job(Task task) {
    std::list<std::string>& names = queues[task];
    auto next = std::make_shared<Job>(preview_limit);
    next->task = task;
    next->name = names.front();
    names.pop_front();
    next->source = sources[next->name];
    next->identity = *entries[next->name].identity;
    return next;
}

void SetLoader::Impl::work() {
    for (;;) {
        std::shared_ptr<Job> current;
        {
            std::unique_lock lock(mutex);
            job.reset();
            if (resting()) rest.notify_all();
            wake.wait(lock, [&] { return ending || next_task(); });
            if (ending) return;
            current = job = next_job(*next_task());
            if (current->task == Task::load) entries[current->name].stage = Stage::loading;
        }
        try {
            if (current->task == Task::load) load(*current);
            if (current->task == Task::arrange) arrange(*current);
            if (current->task == Task::describe) describe(*current);
        } catch (const Cancelled&) {  // whoever cancelled has said in the entry what comes next
        } catch (const std::exception& error) {
            fail(*current, reason(error));
        }
    }
}

/// The set, and what the preview needs to begin.
void SetLoader::Impl::load(Job& current) {
    Progress progress;
    progress.cancelled = &current.cancelled;
    progress.report = [&](double fraction) { current.progress = static_cast<float>(fraction); };
    auto set =
        std::make_shared<const SplatSet>(load_set(current.source, current.name, progress, current.growing));
    auto loaded = std::make_shared<const LoadedLayer>(
        whole_layer(std::move(set), current.source, current.name, preview_limit));

    std::shared_ptr<const LoadedLayer> old;  // large: let go after the lock
    const std::lock_guard lock(mutex);
    if (!is_wanted(current)) return;
    Entry& entry = entries[current.name];
    queue_rest(current.name, *loaded);
    stop_growing(entry);
    old = std::exchange(entry.loaded, std::move(loaded));
    entry.stage = Stage::ready;
    ++revision;
}

void SetLoader::Impl::arrange(const Job& current) {
    Progress progress;
    progress.cancelled = &current.cancelled;
    replace(current, arranged_layer(*loaded(current.name), preview_limit, progress));
}

/// After everything that somebody waits for.
void SetLoader::Impl::describe(const Job& current) {
    replace(current, described_layer(*loaded(current.name)));
}

std::shared_ptr<const LoadedLayer> SetLoader::Impl::loaded(const std::string& name) const {
    const std::lock_guard lock(mutex);
    const auto found = entries.find(name);
    return found == entries.end() ? nullptr : found->second.loaded;
}

/// The same set with more known of it.
void SetLoader::Impl::replace(const Job& finished, LoadedLayer layer) {
    auto loaded = std::make_shared<const LoadedLayer>(std::move(layer));
    const std::lock_guard lock(mutex);
    if (!is_wanted(finished)) return;
    entries[finished.name].loaded.swap(loaded);
    ++revision;
}

void SetLoader::Impl::fail(const Job& current, const std::string& why) {
    const std::lock_guard lock(mutex);
    if (!is_wanted(current)) return;
    Entry& entry = entries[current.name];
    stop_growing(entry);
    entry.stage = Stage::failed;
    entry.error = why;
    ++revision;
}

SetLoader::SetLoader(const SetCache& cache, std::int64_t preview_limit)
    : SetLoader(
          [cache](const SourceParams& source, const std::string& name, const Progress& progress,
                  KeptWatcher& watcher) { return load_source(cache, source, name, progress, &watcher).set; },
          preview_limit) {}
SetLoader::SetLoader(Load load, std::int64_t preview_limit)
    : impl_(std::make_unique<Impl>(std::move(load), preview_limit)) {}
SetLoader::~SetLoader() = default;

void SetLoader::want(const Scene& scene) {
    {
        const std::lock_guard lock(impl_->mutex);
        std::list<std::string> changed;
        for (const LayerParams& layer : scene.layers)
            if (ever_visible(scene, layer) && impl_->want_layer(layer)) changed.push_back(layer.name);
        impl_->forget_layers_not_in(scene);  // after that, for a layer may have been renamed
        std::list<std::string>& queue = impl_->queues[Task::load];
        queue.splice(queue.begin(), changed);
    }
    impl_->wake.notify_one();
}

void SetLoader::outdate(const std::string& layer_name) {
    const std::lock_guard lock(impl_->mutex);
    const auto found = impl_->entries.find(layer_name);
    if (found == impl_->entries.end()) return;
    impl_->stop(layer_name);
    Entry& entry = found->second;
    entry.identity.reset();
    if (!entry.loaded) return;
    auto old = std::make_shared<LoadedLayer>(*entry.loaded);
    old->outdated = true;
    entry.loaded = std::move(old);
}

void SetLoader::retry(const std::string& layer_name) {
    {
        const std::lock_guard lock(impl_->mutex);
        const auto found = impl_->entries.find(layer_name);
        if (found == impl_->entries.end() || !found->second.identity) return;
        Entry& entry = found->second;
        if (entry.stage != Stage::failed && entry.stage != Stage::cancelled) return;
        entry.stage = Stage::waiting;
        entry.error.clear();
        impl_->queues[Task::load].push_front(layer_name);
    }
    impl_->wake.notify_one();
}

void SetLoader::cancel(const std::string& layer_name) {
    const std::lock_guard lock(impl_->mutex);
    const auto found = impl_->entries.find(layer_name);
    if (found == impl_->entries.end()) return;
    Entry& entry = found->second;
    if (entry.stage != Stage::waiting && entry.stage != Stage::loading) return;
    impl_->stop(layer_name);
    entry.stage = Stage::cancelled;
}

/// The job whose set may be shown as far as it is; null: there is none, or nothing new of it.
std::shared_ptr<Job> SetLoader::Impl::growing_job() const {
    if (!job || job->task != Task::load || !is_wanted(*job)) return nullptr;
    const Entry& entry = entries.at(job->name);
    const std::int64_t kept = job->growing.kept();
    if (kept == 0 || (entry.growing && entry.growing->splats == kept)) return nullptr;
    return entry.loaded && job->progress < everywhere ? nullptr : job;
}

bool SetLoader::grow() {
    std::shared_ptr<Job> job;
    {
        const std::lock_guard lock(impl_->mutex);
        job = impl_->growing_job();
    }
    if (!job) return false;
    auto grown = std::make_shared<LoadedLayer>(growing_layer(job->growing.sample(), job->source, job->name));

    const std::lock_guard lock(impl_->mutex);
    if (impl_->job != job || !impl_->is_wanted(*job)) return false;
    Entry& entry = impl_->entries[job->name];
    if (entry.loaded) grown->box = entry.loaded->box;  // so that the picture does not move
    entry.growing = std::move(grown);
    ++impl_->revision;
    return true;
}

std::uint64_t SetLoader::revision() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->revision;
}

std::shared_ptr<const LoadedLayer> SetLoader::layer(const std::string& layer_name) const {
    const std::lock_guard lock(impl_->mutex);
    const auto found = impl_->entries.find(layer_name);
    if (found == impl_->entries.end()) return nullptr;
    return found->second.growing ? found->second.growing : found->second.loaded;
}

LayerStatus SetLoader::status(const LayerParams& layer) const {
    LayerStatus status;
    const SourceParams identity = identity_of(layer.source, layer.name);
    const std::lock_guard lock(impl_->mutex);
    const auto found = impl_->entries.find(layer.name);
    if (found == impl_->entries.end()) return status;
    const Entry& entry = found->second;
    const bool current = entry.identity == identity;
    status.loading = current && (entry.stage == Stage::waiting || entry.stage == Stage::loading);
    if (current) status.error = entry.error;
    if (current && entry.stage == Stage::loading && impl_->job && impl_->job->name == layer.name) {
        status.progress = impl_->job->progress;
        status.found = impl_->job->growing.kept();
    }
    const std::shared_ptr<const LoadedLayer>& seen = entry.growing ? entry.growing : entry.loaded;
    if (!seen) return status;
    status.stale = !status.loading && !satisfies(*seen, identity);
    const glm::dvec3 s = seen->preview->spacing;
    status.splats = seen->splats;
    status.radius_min = seen->radius.x;
    status.radius_max = seen->radius.y;
    status.spacing = std::cbrt(s.x * s.y * s.z);
    status.color = seen->color;
    status.histograms = seen->histograms;
    return status;
}

bool SetLoader::sets_there() const {
    const std::lock_guard lock(impl_->mutex);
    return !impl_->loading();
}

void SetLoader::hold(bool held) {
    {
        const std::lock_guard lock(impl_->mutex);
        if (impl_->held == held) return;
        impl_->held = held;
    }
    impl_->wake.notify_one();
}

bool SetLoader::idle() const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->resting();
}

void SetLoader::wait() {
    std::unique_lock lock(impl_->mutex);
    impl_->rest.wait(lock, [&] { return impl_->resting(); });
}

}  // namespace astrosplat
