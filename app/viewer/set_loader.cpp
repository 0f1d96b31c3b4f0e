// One thread that does what the list says next. The list is used under the lock, the work is done without it.
#include "viewer/set_loader.h"

#include <exception>
#include <new>
#include <utility>

#include "core/error.h"
#include "pipeline.h"
#include "viewer/kept_trees.h"

namespace astrosplat {
namespace {

/// A first sample is so many times smaller than those that come with the sets: all layers are to be seen at
/// once.
constexpr std::int64_t rows_at_first = 4;

/// One line that a person can read.
std::string reason(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error)) return "not enough memory for this layer";
    return error.what();
}

}  // namespace

Worker::Task SetLoader::next_task() {
    list_.end();
    if (!list_.next_task()) return {};
    return [this, job = list_.begin_next()] { work(*job); };
}

void SetLoader::work(SetJob& job) {
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
    Progress progress;
    progress.cancelled = &job.cancelled;
    std::optional<SetSample> there = sample_set_(job.source, job.name, progress);
    if (!there || there->set.size() == 0 || there->set.stars) return;
    GrowingSet::Sample sample;
    sample.box = bounds(there->set);
    sample.set = std::make_shared<const SplatSet>(std::move(there->set));
    sample.kept = there->splats;
    auto layer = std::make_shared<const LoadedLayer>(growing_layer(sample, job.source, job.name));
    list()->show_sample(job, std::move(layer));
} catch (const InputError&) {
} catch (const std::bad_alloc&) {
    // the set may still come without one
}

/// The set, and what the preview needs to begin.
void SetLoader::load(SetJob& job) {
    Progress progress;
    progress.cancelled = &job.cancelled;
    progress.report = [&](double fraction) { job.progress = static_cast<float>(fraction); };
    auto set = std::make_shared<const SplatSet>(load_set_(job.source, job.name, progress, job.growing));
    const MergeSource* const sample = job.sampled ? &job.sampled->sample : nullptr;
    auto layer = std::make_shared<LoadedLayer>(
        whole_layer(std::move(set), job.source, job.name, sample_limit_, sample));
    layer->columns = job.growing.columns();
    const SetList::Layer old = list()->keep(job, std::move(layer));  // let go after the lock
}

void SetLoader::arrange(const SetJob& job) {
    Progress progress;
    progress.cancelled = &job.cancelled;
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
          [cache, rows = sample_limit / rows_at_first](const SourceParams& source, const std::string& name,
                                                       const Progress& progress) {
              return sample_there(cache, source, name, rows, progress);
          },
          sample_limit) {
    trees_ = cache;
}
SetLoader::SetLoader(Load load, Sample sample, std::int64_t sample_limit)
    : load_set_(std::move(load)),
      sample_set_(std::move(sample)),
      sample_limit_(sample_limit),
      list_(sample_limit, sample_set_ != nullptr) {}

SetLoader::~SetLoader() { list()->cancel_job(); }

bool SetLoader::grow() {
    const std::shared_ptr<SetJob> job = list()->growing_job();
    if (!job) return false;
    LoadedLayer grown = growing_layer(job->growing.sample(), job->source, job->name);
    return list()->grow(*job, std::move(grown));
}

}  // namespace astrosplat
