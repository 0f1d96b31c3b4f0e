// One thread that does what the list says next. The list is used under the lock, the work is done without it.
#include "viewer/set_loader.h"

#include <exception>
#include <new>
#include <utility>

#include "core/error.h"
#include "core/worker.h"
#include "pipeline.h"
#include "viewer/set_list.h"

namespace astrosplat {
namespace {

/// One line that a person can read.
std::string reason(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return "not enough memory for this layer";
    return error.what();
}

}  // namespace

struct SetLoader::Impl {
    Load load_set;
    std::int64_t preview_limit;
    SetList list;  // used with the worker's lock
    Worker worker{[this] { return next_task(); }};

    Impl(Load load, std::int64_t limit) : load_set(std::move(load)), preview_limit(limit), list(limit) {}
    ~Impl() {
        const auto held = worker.lock();
        list.cancel_job();
    }

    // The thread's.
    Worker::Task next_task();
    void work(SetJob& job);
    void load(SetJob& job);
    void arrange(const SetJob& job);
    void describe(const SetJob& job);
    void replace(const SetJob& job, LoadedLayer layer);
};

Worker::Task SetLoader::Impl::next_task() {
    list.end();
    if (!list.next_task()) return {};
    return [this, job = list.begin_next()] { work(*job); };
}

void SetLoader::Impl::work(SetJob& job) {
    try {
        if (job.task == SetTask::load) load(job);
        if (job.task == SetTask::arrange) arrange(job);
        if (job.task == SetTask::describe) describe(job);
    } catch (const Cancelled&) {  // the caller that cancelled has said in the list what comes next
    } catch (const std::exception& error) {
        const auto held = worker.lock();
        list.fail(job, reason(error));
    }
}

/// The set, and what the preview needs to begin.
void SetLoader::Impl::load(SetJob& job) {
    Progress progress;
    progress.cancelled = &job.cancelled;
    progress.report = [&](double fraction) { job.progress = static_cast<float>(fraction); };
    auto set = std::make_shared<const SplatSet>(load_set(job.source, job.name, progress, job.growing));
    auto layer =
        std::make_shared<const LoadedLayer>(whole_layer(std::move(set), job.source, job.name, preview_limit));

    SetList::Layer old;  // let go after the lock
    const auto held = worker.lock();
    old = list.keep(job, std::move(layer));
}

void SetLoader::Impl::arrange(const SetJob& job) {
    Progress progress;
    progress.cancelled = &job.cancelled;
    replace(job, arranged_layer(*job.loaded, preview_limit, progress));
}

/// After everything that is waited for.
void SetLoader::Impl::describe(const SetJob& job) { replace(job, described_layer(*job.loaded)); }

void SetLoader::Impl::replace(const SetJob& job, LoadedLayer layer) {
    auto better = std::make_shared<const LoadedLayer>(std::move(layer));
    SetList::Layer old;  // let go after the lock
    const auto held = worker.lock();
    old = list.replace(job, std::move(better));
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
        const auto held = impl_->worker.lock();
        impl_->list.want(scene);
    }
    impl_->worker.wake();
}

void SetLoader::outdate(const std::string& layer_name) {
    const auto held = impl_->worker.lock();
    impl_->list.outdate(layer_name);
}

void SetLoader::retry(const std::string& layer_name) {
    {
        const auto held = impl_->worker.lock();
        impl_->list.retry(layer_name);
    }
    impl_->worker.wake();
}

void SetLoader::cancel(const std::string& layer_name) {
    const auto held = impl_->worker.lock();
    impl_->list.cancel(layer_name);
}

bool SetLoader::grow() {
    std::shared_ptr<SetJob> job;
    {
        const auto held = impl_->worker.lock();
        job = impl_->list.growing_job();
    }
    if (!job) return false;
    LoadedLayer grown = growing_layer(job->growing.sample(), job->source, job->name);
    const auto held = impl_->worker.lock();
    return impl_->list.grow(*job, std::move(grown));
}

std::uint64_t SetLoader::revision() const {
    const auto held = impl_->worker.lock();
    return impl_->list.revision();
}

std::shared_ptr<const LoadedLayer> SetLoader::layer(const std::string& layer_name) const {
    const auto held = impl_->worker.lock();
    return impl_->list.shown(layer_name);
}

LayerStatus SetLoader::status(const LayerParams& layer) const {
    const auto held = impl_->worker.lock();
    return impl_->list.status(layer);
}

bool SetLoader::sets_there() const {
    const auto held = impl_->worker.lock();
    return !impl_->list.loading();
}

void SetLoader::hold(bool rest) {
    {
        const auto held = impl_->worker.lock();
        if (!impl_->list.hold(rest)) return;
    }
    impl_->worker.wake();
}

bool SetLoader::idle() const {
    const auto held = impl_->worker.lock();
    return impl_->list.resting();
}

void SetLoader::wait() {
    impl_->worker.wait([&] { return impl_->list.resting(); });
}

}  // namespace astrosplat
