// --batch: plans, checks that the output can be written, then renders frame after frame; with --dry-run it
// only prints the plan. A frame that fails does not stop the others; an interrupt stops between two pixels.
#include <fmt/format.h>

#include <new>
#include <nlohmann/json.hpp>
#include <set>

#include "batch_plan.h"
#include "command.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/text.h"
#include "device.h"
#include "estimate.h"
#include "exit.h"
#include "farm/child_process.h"
#include "generate/generate.h"
#include "output/metadata.h"
#include "output/write.h"
#include "pipeline.h"
#include "scene/source_metadata.h"

namespace astrosplat {
namespace {

// The figures of a run (--stats), as JSON: of each frame, of each layer, and of the whole.

struct FrameFigures {
    std::int64_t frame = 0;
    fs::path file;
    double seconds = 0.0;         // look, render and write
    double write_seconds = 0.0;   // encoding, compressing, until it is on the disk
    double render_seconds = 0.0;  // from shaded splats to the finished float image in memory
    std::int64_t splats_in = 0, splats_drawn = 0;
    std::string sha256;  // of the float pixels' bytes
    std::string device;  // that drew it
};

struct FailedFrame {
    std::int64_t frame = 0;
    fs::path file;
    std::string error;
};

struct RunFigures {
    std::vector<FrameFigures> frames;  // those rendered and written in this run
    std::vector<FailedFrame> failed;
    std::vector<LayerStatistics> layers;
    double seconds = 0.0;
};

using Json = nlohmann::ordered_json;

/// A number, a text or a truth as JSON. Lists and objects are not made of Json: its destructor takes memory
/// for them, and ends the program where there is none.
template <class T>
std::string json_text(const T& value) {
    return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}
std::string json_text(const fs::path& file) { return json_text(file.string()); }

/// `names`: of the values, one after the other, with commas between them.
template <class... Values>
std::string object_text(std::string_view names, const Values&... values) {
    std::string text;
    for (const std::string& value : {json_text(values)...}) {
        const std::size_t end = names.find(' ');
        text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", names.substr(0, end), value);
        names.remove_prefix(end == names.npos ? names.size() : end + 1);
    }
    return "{" + text + "}";
}

std::string object_of(const FrameFigures& f) {
    return object_text(
        "frame file seconds render_seconds write_seconds splats_in splats_drawn sha256 "
        "device",
        f.frame, f.file, f.seconds, f.render_seconds, f.write_seconds, f.splats_in, f.splats_drawn, f.sha256,
        f.device);
}

std::string object_of(const LayerStatistics& layer) {
    return object_text(
        "name test_positions kept zero_alpha drawn generate_seconds look_seconds cached geometry_cached",
        layer.name, layer.test_positions, layer.kept, layer.zero_alpha, layer.drawn, layer.generate_seconds,
        layer.look_seconds, layer.cached, layer.geometry_cached);
}

std::string object_of(const FailedFrame& frame) {
    return object_text("frame file error", frame.frame, frame.file, frame.error);
}

/// An object a line.
template <class T>
std::string list_of(const std::vector<T>& items) {
    std::string text = "[";
    for (const T& item : items) text += (text.size() > 1 ? ",\n    " : "\n    ") + object_of(item);
    return text + (items.empty() ? "]" : "\n  ]");
}

/// Writes the figures whole or not at all. Throws OutputError.
void write_stats(const fs::path& file, const RunFigures& figures) {
    const std::string lists =
        fmt::format("\n  \"frames\": {},\n  \"failed\": {},\n  \"layers\": {},\n  ", list_of(figures.frames),
                    list_of(figures.failed), list_of(figures.layers));
    std::string text = object_text("seconds peak_memory_bytes threads vector_target version", figures.seconds,
                                   peak_memory_bytes(), thread_count(), vector_target(), ASTROSPLAT_VERSION);
    write_file_atomically(file, text.insert(1, lists) + "\n");
}

// --dry-run: the plan and its cost, as lines on stdout.

std::string human_seconds(double seconds) {
    if (seconds < 99.5) return fmt::format("{:.{}f} s", seconds, seconds < 0.95 ? 2 : seconds < 9.5 ? 1 : 0);
    return clock_text(seconds);
}

/// The sets to be made and the cost of the frames, estimated from a hundredth of the splats.
void print_costs(const BatchPlan& plan, SampledRun& sample) {
    const std::int64_t count = count_to_render(plan);
    if (sample.making_seconds() > 0.0)
        fmt::print("sets are made in about {}\n", human_seconds(sample.making_seconds()));
    if (count == 0) return;
    const FrameCost cost = sample.frame_cost();
    const auto all = static_cast<double>(count);
    fmt::print("time about {} a frame, {} in all\n", human_seconds(cost.seconds),
               human_seconds(sample.making_seconds() + all * cost.seconds));
    if (!cost.file_bytes) return;
    const auto bytes = static_cast<double>(*cost.file_bytes);
    fmt::print("files about {} a frame, {} in all\n", human_bytes(bytes), human_bytes(all * bytes));
}

/// Frames, layers, memory, time and bytes, then a line a frame. Throws as SampledRun and estimate do.
void print_plan(const BatchPlan& plan) {
    const OutputParams& output = plan.scene.output;
    SampledRun sample(plan, SampledRun::Layers::all);
    const JobEstimate job = estimate(plan, sample);
    const auto count = static_cast<std::int64_t>(plan.frames.size());
    fmt::print("scene {}\n", printable(plan.scene.file.string()));
    fmt::print("frame {}x{} px", output.width, output.height);
    if (plan.region.width > 0) {
        fmt::print(", region {},{},{},{}", plan.region.x, plan.region.y, plan.region.width,
                   plan.region.height);
    }
    fmt::print("\nframes {}: {} to render, {} there already\n", count, count_to_render(plan),
               count - count_to_render(plan));
    for (const JobEstimate::Layer& layer : job.layers) {
        fmt::print("layer {}: about {}\n", layer.name, human_count(layer.splats, "splat"));
    }
    if (job.sky_kept)
        fmt::print("sky: {}\n", *job.sky_kept ? "in the cache" : "is made of its picture first");
    if (!job.streamed.empty()) fmt::print("read block by block: {}\n", fmt::join(job.streamed, ", "));
    fmt::print("memory about {}, threads {}\n", human_bytes(static_cast<double>(job.bytes)), thread_count());
    print_costs(plan, sample);
    for (const FramePlan& frame : plan.frames) {
        fmt::print("{} {} {}\n", frame.render ? "render" : "keep", frame.frame,
                   printable(frame.file.string()));
    }
}

/// Throws OutputError where a frame or the figures could not be written.
void check_writable(const BatchPlan& plan, const CommandOptions& options) {
    fs::path last;
    for (const FramePlan& frame : plan.frames) {
        const fs::path folder = folder_of(frame.file);
        if (frame.render && folder != last) prove_writable(folder);
        if (frame.render) last = folder;
    }
    if (options.stats) prove_writable(folder_of(*options.stats));
    if (options.ffmetadata) prove_writable(folder_of(*options.ffmetadata));
}

/// One run over the frames of a plan.
class BatchRun {
  public:
    BatchRun(const BatchPlan& plan, const CommandOptions& options)
        : plan_(plan), options_(options), hasher_(plan.hasher), report_(options.progress) {}

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
    const CommandOptions& options_;
    FrameHasher hasher_;
    std::unique_ptr<FrameDevice> device_;
    ProgressReport report_;
    std::unique_ptr<Pipeline> pipeline_;
    ObjectMetadata sources_;
    std::int64_t renderer_bytes_ = 0;  // limit; 0: none
    RunFigures figures_;
    Clock::time_point start_ = Clock::now();
};

void BatchRun::prepare() {
    const JobEstimate job = estimate(plan_);
    renderer_bytes_ = job.renderer_bytes;
    device_ = std::make_unique<FrameDevice>(options_);
    const auto frames = count_to_render(plan_);
    log_info(fmt::format("{} of {}x{} px, about {}, about {} of memory", counted(frames, "frame"),
                         plan_.scene.output.width, plan_.scene.output.height,
                         human_count(job.splats, "splat"), human_bytes(static_cast<double>(job.bytes))));
    if (!job.streamed.empty())
        log_info(fmt::format("read block by block, as there is not memory for all: {}",
                             fmt::join(job.streamed, ", ")));
    pipeline_ =
        std::make_unique<Pipeline>(plan_.scene, report_.begin_step("preparing"), plan_.cache, job.streamed);
    sources_ = pipeline_->input_metadata();
    check_unchanged(plan_.hasher.files(), stoppable());
}

RenderSettings BatchRun::settings(const OutputParams& output) const {
    RenderSettings settings = render_settings(output);
    settings.region = plan_.region;
    settings.memory_limit_bytes = renderer_bytes_;
    settings.device = device_->get();
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
    metadata.provenance = resolved(scene.provenance, sources_);
    metadata.sources = sources_;
    metadata.origin = pipeline_->input_origin();
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
    device_->check(rendered.statistics);
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
    figures.device = rendered.statistics.device.empty() ? "cpu" : rendered.statistics.device;
    note_device(frame.file, figures.device);
    log_detail(fmt::format("frame {}: {} drawn by {}, mean overlap {:.2f}", frame.frame,
                           human_count(figures.splats_drawn, "splat"), figures.device,
                           rendered.statistics.mean_overlap));
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
    std::set<fs::path> failed;
    for (const FailedFrame& frame : figures_.failed) failed.insert(frame.file);
    for (const FramePlan& frame : plan_.frames) {
        std::error_code ignored;
        if (!failed.count(frame.file) && !fs::exists(frame.file, ignored))
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
bool keep_stats(const CommandOptions& options, const BatchRun& run) try {
    if (options.stats) write_stats(*options.stats, run.figures());
    return true;
} catch (const OutputError& error) {
    log_error(error.what());
    return false;
} catch (const std::bad_alloc&) {
    log_error(options.stats->string() + ": cannot be written: not enough memory");
    return false;
}

/// Of all that a movie of these frames shows.
std::string movie_hash(const BatchPlan& plan) {
    Sha256 hash;
    hash.add(fmt::format("{} fps", plan.scene.output.fps));
    for (const FramePlan& frame : plan.frames) hash.add(frame.hash);
    return hash.hex();
}

/// It is whole, as far as ffmpeg can tell by its head, and says that it was made of these very frames.
bool is_movie_of(const fs::path& movie, const BatchPlan& plan) {
    const auto tags = run_tool({"ffmpeg", "-v", "error", "-i", movie.string(), "-f", "ffmetadata", "-"});
    return tags && tags->code == 0 && tags->out.find(movie_hash(plan)) != std::string::npos;
}

}  // namespace

int run_batch(const CommandOptions& options) {
    const BatchPlan plan = plan_batch(options);
    defer_interrupts();
    if (options.movie && options.resume && is_movie_of(*options.movie, plan)) {
        log_info(fmt::format("kept {}, which was made of these very frames", options.movie->string()));
        return exit_done;
    }
    if (options.dry_run) {
        print_plan(plan);
        return exit_done;
    }
    check_writable(plan, options);
    std::vector<FailedFrame> failed;
    bool kept = true;
    {
        BatchRun run(plan, options);
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
    if (options.ffmetadata && failed.empty())
        write_file_atomically(*options.ffmetadata,
                              movie_metadata(plan.frames.front().file, movie_hash(plan)));
    if (failed.empty()) return kept ? exit_done : exit_not_writable;
    report_failures(failed);
    return exit_some_failed;
}

}  // namespace astrosplat
