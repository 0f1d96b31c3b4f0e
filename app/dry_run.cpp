#include "dry_run.h"

#include <fmt/format.h>

#include <string>

#include "core/memory.h"
#include "core/parallel.h"
#include "core/text.h"
#include "estimate.h"
#include "progress_report.h"
#include "sampled_run.h"

namespace astrosplat {
namespace {

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

}  // namespace

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

}  // namespace astrosplat
