// --batch: plans, checks that the output can be written, then renders frame after frame. A frame that fails
// does not stop the others; an interrupt stops between two pixels.
#include "batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <set>

#include "batch_plan.h"
#include "core/clock.h"
#include "core/error.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "dry_run.h"
#include "estimate.h"
#include "generate/generate.h"
#include "interrupt.h"
#include "output/write.h"
#include "pipeline.h"
#include "places.h"
#include "progress_report.h"
#include "stats.h"

namespace astrosplat {
namespace {

/// Throws OutputError where a frame or the figures could not be written.
void check_writable(const BatchPlan& plan, const BatchOptions& options) {
    std::filesystem::path last;
    for (const FramePlan& frame : plan.frames) {
        const std::filesystem::path folder = folder_of(frame.file);
        if (frame.render && folder != last) prove_writable(folder);
        if (frame.render) last = folder;
    }
    if (options.stats) prove_writable(folder_of(*options.stats));
}

/// One run over the frames of a plan.
class BatchRun {
  public:
    BatchRun(const BatchPlan& plan, ProgressMode progress)
        : plan_(plan), hasher_(plan.hasher), report_(progress) {}

    void prepare();
    void render_frames();
    RunFigures figures() const;
    const std::vector<FailedFrame>& failed() const { return figures_.failed; }

  private:
    void try_frame(const FramePlan& frame, std::int64_t index, std::int64_t count);
    FrameFigures render_frame(const FramePlan& frame, const Progress& progress);
    void fail(const FramePlan& frame, const std::string& error);
    void find_lost_frames();
    FrameMetadata metadata(const FramePlan& frame, const FrameScene& now, const RenderSettings& settings);
    RenderSettings settings(const OutputParams& output) const;

    const BatchPlan& plan_;
    FrameHasher hasher_;
    ProgressReport report_;
    std::unique_ptr<Pipeline> pipeline_;
    std::int64_t renderer_bytes_ = 0;  // limit; 0: none
    RunFigures figures_;
    Clock::time_point start_ = Clock::now();
};

void BatchRun::prepare() {
    const JobEstimate job = estimate(plan_);
    renderer_bytes_ = job.renderer_bytes;
    const auto frames = count_to_render(plan_);
    log_info(fmt::format("{} of {}x{} px, about {}, about {} of memory", counted(frames, "frame"),
                         plan_.scene.output.width, plan_.scene.output.height,
                         human_count(job.splats, "splat"), human_bytes(static_cast<double>(job.bytes))));
    if (!job.streamed.empty())
        log_info(fmt::format("read block by block, as there is not memory for all: {}",
                             fmt::join(job.streamed, ", ")));
    pipeline_ =
        std::make_unique<Pipeline>(plan_.scene, report_.begin_step("preparing"), plan_.cache, job.streamed);
    check_unchanged(plan_.hasher.files(), Progress{{}, &interrupted()});
}

RenderSettings BatchRun::settings(const OutputParams& output) const {
    RenderSettings settings = render_settings(output);
    settings.region = plan_.region;
    settings.memory_limit_bytes = renderer_bytes_;
    return settings;
}

FrameMetadata BatchRun::metadata(const FramePlan& frame, const FrameScene& now,
                                 const RenderSettings& settings) {
    FrameMetadata metadata;
    const Scene& scene = now.scene;
    metadata.frame = frame.frame;
    metadata.eye = frame.eye;
    metadata.fps = scene.output.fps;
    metadata.frame_hash = frame.hash;
    metadata.hashed_text = hasher_.canonical_text(now);
    metadata.provenance = scene.provenance;
    if (metadata.provenance.credit.empty()) metadata.provenance.credit = pipeline_->input_credit();
    if (!scene.layers.empty())
        metadata.seed = resolved_seed(scene.layers.front().source.seed, scene.layers.front().name);
    const Camera camera = pipeline_->camera(now, settings);
    if (!is_onto_sphere(camera.projection))  // which no matrix can say
        metadata.matrices =
            exr_matrices(camera, static_cast<double>(settings.width), static_cast<double>(settings.height));
    return metadata;
}

FrameFigures BatchRun::render_frame(const FramePlan& frame, const Progress& progress) {
    const Clock::time_point start = Clock::now();
    const FrameScene now = pipeline_->frame_scene(static_cast<double>(frame.frame), frame.eye);
    const RenderSettings settings = this->settings(now.scene.output);
    if (frame.existing == Existing::keep) refuse_existing(frame.file);
    const RenderedFrame rendered = pipeline_->frame(now, settings, progress);
    FrameMetadata metadata = this->metadata(frame, now, settings);
    metadata.pixel_hash = pixel_hash(rendered.beauty);
    progress.check();
    const Clock::time_point writing = Clock::now();
    write_frame({frame.file, now.scene.output, settings.width, settings.height, settings.region,
                 pipeline_->layer_names(now), frame.existing},
                rendered, metadata);
    FrameFigures figures;
    figures.frame = frame.frame;
    figures.file = frame.file;
    figures.seconds = seconds_since(start);
    figures.write_seconds = seconds_since(writing);
    figures.render_seconds = rendered.statistics.seconds;
    figures.splats_in = rendered.statistics.splats_in;
    figures.splats_drawn = rendered.statistics.splats_drawn;
    figures.sha256 = metadata.pixel_hash;
    log_detail(fmt::format("frame {}: {} drawn, mean overlap {:.2f}", frame.frame,
                           human_count(figures.splats_drawn, "splat"), rendered.statistics.mean_overlap));
    return figures;
}

void BatchRun::fail(const FramePlan& frame, const std::string& error) {
    log_error(fmt::format("frame {}: {}", frame.frame, error));
    figures_.failed.push_back({frame.frame, frame.file, error});
}

/// A frame that cannot be rendered or written spares the others, except that bad input which shows in the
/// first frame ends the run: nothing was started.
void BatchRun::try_frame(const FramePlan& frame, std::int64_t index, std::int64_t count) {
    const Progress progress = report_.begin_frame(frame.frame, index, count);
    try {
        figures_.frames.push_back(render_frame(frame, progress));
        report_.saved(frame.file, figures_.frames.back().seconds);
    } catch (const Cancelled&) {
        throw;
    } catch (const InputError& error) {
        if (index == 1) throw;
        fail(frame, error.what());
    } catch (const AlreadyExists& error) {
        if (!plan_.resume || found_at(frame) != Found::same) return fail(frame, error.what());
        log_info(fmt::format("frame {}: another program has written it meanwhile", frame.frame));
    } catch (const OutputError& error) {
        fail(frame, error.what());
    } catch (const std::bad_alloc&) {
        fail(frame, "not enough memory");
    } catch (const std::exception& error) {
        fail(frame, fmt::format("internal error: {}", error.what()));
    }
}

void BatchRun::render_frames() {
    const std::int64_t count = count_to_render(plan_);
    std::int64_t index = 0;
    for (const FramePlan& frame : plan_.frames)
        if (frame.render) try_frame(frame, ++index, count);
    find_lost_frames();
}

/// Frames that were written or found, and removed before the run's end.
void BatchRun::find_lost_frames() {
    std::set<std::filesystem::path> failed;
    for (const FailedFrame& frame : figures_.failed) failed.insert(frame.file);
    for (const FramePlan& frame : plan_.frames) {
        std::error_code ignored;
        if (!failed.count(frame.file) && !std::filesystem::exists(frame.file, ignored))
            fail(frame, frame.file.string() + ": removed during the run");
    }
}

RunFigures BatchRun::figures() const {
    RunFigures figures = figures_;
    if (pipeline_) figures.layers = pipeline_->statistics();
    figures.seconds = seconds_since(start_);
    return figures;
}

void report_failures(const std::vector<FailedFrame>& failed) {
    std::vector<std::int64_t> numbers;
    for (const FailedFrame& frame : failed) numbers.push_back(frame.frame);
    std::ranges::sort(numbers);  // those that were removed later come last
    log_error(fmt::format("{} failed: {}", counted(std::ssize(numbers), "frame"), fmt::join(numbers, ",")));
}

/// The figures, where they are asked for. Without them frames that failed are still to be named: false.
bool keep_stats(const BatchOptions& options, const BatchRun& run) try {
    if (options.stats) write_stats(*options.stats, run.figures());
    return true;
} catch (const OutputError& error) {
    log_error(error.what());
    return false;
} catch (const std::bad_alloc&) {
    log_error(options.stats->string() + ": cannot be written: not enough memory");
    return false;
}

}  // namespace

int run_batch(const BatchOptions& options) {
    const BatchPlan plan = plan_batch(options);
    defer_interrupts();
    if (options.dry_run) {
        print_plan(plan);
        return exit_done;
    }
    check_writable(plan, options);
    std::vector<FailedFrame> failed;
    bool kept = true;
    {
        BatchRun run(plan, options.progress);
        const auto keep_figures = [&] { kept = keep_stats(options, run); };
        try {
            if (count_to_render(plan) > 0) {
                run.prepare();
                run.render_frames();
            }
        } catch (const Cancelled&) {
            keep_figures();
            throw;
        }
        keep_figures();
        failed = run.failed();
    }
    flush_warning_counts();
    if (failed.empty()) return kept ? exit_done : exit_not_writable;
    report_failures(failed);
    return exit_some_failed;
}

}  // namespace astrosplat
