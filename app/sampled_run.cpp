#include "estimate.h"

#include "core/error.h"
#include "core/file.h"
#include "core/progress.h"
#include "exit.h"
#include "output/write.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "sets/kept.h"
#include "sets/load_source.h"
#include "sets/set_sample.h"
#include "splats/splat_set.h"

namespace astrosplat {
namespace {

/// Some of the frames that are rendered, evenly spread: the first, the last, and what lies between.
std::vector<const FramePlan*> some_frames(const BatchPlan& plan, std::size_t most) {
    std::vector<const FramePlan*> all, some;
    for (const FramePlan& frame : plan.frames)
        if (frame.render) all.push_back(&frame);
    const std::size_t count = std::min(all.size(), most);
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(all[count == 1 ? 0 : i * (all.size() - 1) / (count - 1)]);
    return some;
}

/// So many rows that each stands for as many splats as those of the other layers.
SplatSet thinned(SetSample sample, double each) {
    const auto rows = static_cast<std::int64_t>(static_cast<double>(sample.splats) / each + 0.5);
    return rows < sample.set.size() ? sample_rows(sample.set, std::max<std::int64_t>(1, rows))
                                    : std::move(sample.set);
}

std::optional<SetSample> sample_of(const BatchPlan& plan, const LayerParams& layer,
                                   SampledRun::Layers layers) {
    const SourceParams source = source_of(plan.scene, layer);
    if (!ever_visible(plan.scene, layer) || is_like_a_layer(source)) return std::nullopt;
    if (layers == SampledRun::Layers::there ||
        (layers == SampledRun::Layers::meshes && source.kind != SourceKind::mesh))
        return sample_there(plan.cache, source, layer.name);
    return sample_set(plan.cache, source, layer.name, stoppable());
}

/// The scene as it is sampled: without a sky that would have to be read, or made first.
Scene sampled_scene(const BatchPlan& plan, SampledRun::Layers layers) {
    Scene scene = plan.scene;
    EnvironmentParams& sky = scene.environment;
    if (layers != SampledRun::Layers::all ||
        (!sky.tile.empty() && !is_kept(plan.cache, sky.tile, sky.tiling, stoppable())))
        sky = {};
    return scene;
}

}  // namespace

SampledRun::SampledRun(const BatchPlan& plan, Layers layers)
    : plan_(plan), frames_(some_frames(plan, layers == Layers::all ? 5 : 3)) {
    std::vector<std::optional<SetSample>> samples;
    for (const LayerParams& layer : plan.scene.layers) {
        samples.push_back(sample_of(plan, layer, layers));
        if (!samples.back()) continue;
        const SetSample& sample = *samples.back();
        layers_.push_back({layer.name, sample.splats, sample.making.seconds > 0.0, !sample.set.radius.empty(),
                           sample.making.bytes});
        making_seconds_ += sample.making.seconds;
        each_ = std::max(each_, sample.each());
    }
    std::vector<std::shared_ptr<const SplatSet>> sets(samples.size()), single(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!samples[i]) continue;
        single[i] = std::make_shared<SplatSet>(sample_rows(samples[i]->set, 1));
        sets[i] = std::make_shared<SplatSet>(thinned(std::move(*samples[i]), each_));
    }
    const Scene scene = sampled_scene(plan, layers);
    pipeline_.set_scene(scene, std::move(sets), nullptr, stoppable());
    if (layers == Layers::all) empty_.set_scene(scene, std::move(single), nullptr, stoppable());
}

const SampledRun::Layer* SampledRun::find(const std::string& name) const {
    const auto found = std::ranges::find(layers_, name, &Layer::name);
    return found == layers_.end() ? nullptr : &*found;
}

RenderSettings SampledRun::settings(const FrameScene& frame) const {
    RenderSettings settings = render_settings(frame.scene.output);
    settings.region = plan_.region;
    settings.splats_each = each_;
    return settings;
}

std::int64_t SampledRun::record_bytes() {
    std::int64_t most = 0;
    if (layers_.empty()) return most;
    for (const FramePlan* const frame : frames_) {
        const FrameScene now = scene_of(*frame);
        const std::vector<RenderLayer> layers = pipeline_.shaded_layers(now, stoppable());
        if (layers.empty()) continue;
        const RenderSettings settings = this->settings(now);
        most = std::max(
            most, scattered_bytes(layers, pipeline_.camera(now, settings), settings, cache_, stoppable()));
    }
    return most;
}

/// The shorter of two renderings: the first one also makes what stays.
double SampledRun::seconds_of(Pipeline& pipeline, const FrameScene& frame, RenderedFrame& rendered) const {
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i < 2; ++i) {
        const Clock::time_point start = Clock::now();
        rendered = pipeline.frame(frame, settings(frame), stoppable());
        least = std::min(least, seconds_since(start));
    }
    return least;
}

/// None where there is no place to write to.
std::optional<std::int64_t> SampledRun::bytes_of(const fs::path& name, const FrameScene& frame,
                                                 const RenderedFrame& rendered) const try {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / name;
    const RenderSettings settings = this->settings(frame);
    write_frame({file, frame.scene.output, settings.width, settings.height, settings.region,
                 pipeline_.layer_names(frame)},
                rendered, {});
    return static_cast<std::int64_t>(fs::file_size(file));
} catch (const OutputError&) {
    return std::nullopt;
}

FrameCost SampledRun::frame_cost() {
    FrameCost cost;
    if (frames_.empty()) return cost;
    const double count = static_cast<double>(frames_.size());
    double bytes = 0.0;
    bool has_bytes = true;
    for (const FramePlan* const frame : frames_) {
        RenderedFrame rendered;
        const FrameScene now = scene_of(*frame);
        const double without = seconds_of(empty_, now, rendered);
        const double with = seconds_of(pipeline_, now, rendered);
        const Clock::time_point writing = Clock::now();
        const std::optional<std::int64_t> written = bytes_of(frame->file.filename(), now, rendered);
        cost.seconds += (without + each_ * std::max(0.0, with - without) + seconds_since(writing)) / count;
        has_bytes &= written.has_value();
        bytes += static_cast<double>(written.value_or(0)) / count;
    }
    if (has_bytes) cost.file_bytes = static_cast<std::int64_t>(bytes);
    return cost;
}

}  // namespace astrosplat
