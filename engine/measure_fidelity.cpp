#include "measure_fidelity.h"

#include <fmt/format.h>

#include "core/error.h"
#include "image/resample.h"
#include "look/apply.h"
#include "pipeline.h"
#include "scene/animate.h"
#include "scene/layer_setup.h"
#include "scene/source_metadata.h"
#include "source/picture.h"
#include "source/texture.h"

namespace astrosplat {
namespace {

// Of the views from the side: width over height.
constexpr std::int64_t side_aspect[] = {16, 9}, edge_aspect[] = {16, 5};

const LayerParams& layer_with_picture(const Scene& now) {
    const LayerParams* found = nullptr;
    for (const LayerParams& layer : now.layers) {
        if (layer.source.kind != SourceKind::mesh) continue;
        if (layer.visible) return layer;
        if (!found) found = &layer;
    }
    if (!found)
        bad_input(now.file, "a layer of kind \"mesh\", whose picture the front view is compared with",
                  "none");
    return *found;
}

void require_proportions(const FidelityReference& reference) {
    const double width = double(reference.picture.width);
    const double height = double(reference.picture.height);
    const double stretch = width * reference.frame.height / (height * reference.frame.width);
    if (std::fabs(stretch - 1.0) > 0.01)
        bad_input(reference.file,
                  fmt::format("the proportions of layer '{}', {:.4g} x {:.4g}", reference.layer,
                              reference.frame.width, reference.frame.height),
                  fmt::format("{} x {} px", reference.picture.width, reference.picture.height));
}

using LayerSets = std::vector<std::shared_ptr<const SplatSet>>;

// Of all that the views show, of the layer with the picture also where it is not seen, and of the reference.
std::string credit_of(const Scene& now, const LayerSets& sets, const FidelityReference& reference) {
    const SplatSetFacts unseen;
    std::vector<const SplatSetFacts*> facts;
    for (std::size_t i = 0; i < sets.size(); ++i)
        facts.push_back(sets[i] ? sets[i].get() : now.layers[i].name == reference.layer ? &unseen : nullptr);
    const std::string credit = resolved(now.provenance, source_metadata(now, facts)).credit;
    if (reference.file.empty()) return credit;
    return joined_once({credit, utf8_line(read_picture_metadata(reference.file).credit)});
}

LayerSets load_sets(const Scene& now, const SetCache& cache, const Progress& progress) {
    LayerSets sets;
    for (const LayerParams& layer : now.layers) {
        sets.push_back(nullptr);
        if (!layer.visible) continue;
        LoadedSet loaded = load_source(cache, source_of(now, layer), layer.name, progress, nullptr,
                                       columns_read(layer.look));
        sets.back() = std::make_shared<const SplatSet>(std::move(loaded.set));
    }
    return sets;
}

// The scene's sets and a pipeline that renders it from one camera after the other.
class FidelityViews {
  public:
    FidelityViews(const Scene& now, LayerSets sets) : scene_(now), sets_(std::move(sets)) {
        stop_animation(scene_);
        scene_.environment = {};
    }

    Image render(const FrontFrame& frame, JudgingView view, std::int64_t width_px, std::int64_t height_px,
                 const Progress& progress) {
        scene_.camera = judging_camera(frame, view, double(width_px) / double(height_px));
        pipeline_.set_scene(scene_, sets_);
        const FrameScene now = pipeline_.frame_scene(0.0);
        RenderSettings settings = render_settings(now.scene.output);
        settings.width = width_px;
        settings.height = height_px;
        settings.aov_depth = settings.aov_coverage = settings.aov_count = settings.aov_layers = false;
        return pipeline_.frame(now, settings, progress).beauty;
    }

  private:
    Scene scene_;
    LayerSets sets_;
    Pipeline pipeline_;
};

FrontComparison compare_front(FidelityViews& views, const FidelityReference& reference, double pixel_filter,
                              std::int64_t width_px, const Progress& progress) {
    const std::int64_t height_px = reference.height_px(width_px);
    FrontComparison front;
    front.seen = views.render(reference.frame, JudgingView::front, width_px, height_px, progress);
    front.picture = resampled(reference.picture, map_to_width(reference.picture, width_px, height_px),
                              width_px, height_px, pixel_filter);
    progress.check();
    front.fidelity = front_fidelity(front.seen, front.picture, reference.border);
    return front;
}

}  // namespace

std::int64_t FidelityReference::height_px(std::int64_t width_px) const {
    const double height = double(width_px) * frame.height / frame.width;
    return std::max<std::int64_t>(1, std::int64_t(height + 0.5));
}

FidelityReference fidelity_reference(const Scene& now, const std::optional<fs::path>& file,
                                     const Progress& progress, const SetCache& cache) {
    const LayerParams& layer = layer_with_picture(now);
    FidelityReference reference;
    reference.layer = layer.name;
    const StructureParams& structure = layer.source.structure;
    if (structure.kind != StructureKind::columns) reference.border = structure.border;
    if (structure.kind == StructureKind::disk) reference.galaxy = structure.galaxy;
    reference.disk = structure.kind == StructureKind::columns || structure.kind == StructureKind::disk;
    if (file) reference.file = *file;
    if (file) reference.picture = load_linear_image(*file, progress);
    try {
        const std::vector<TexturedMesh> meshes = load_meshes(cache, layer.source, progress);
        const FrontFrame frame = front_frame(meshes);
        reference.frame = in_world(frame, render_layer(layer));
        if (!file) reference.picture = front_picture(meshes, frame, progress);
    } catch (const InputError& error) {
        throw InputError(fmt::format("layer '{}': {}", layer.name, error.what()));
    }
    if (file) require_proportions(reference);
    return reference;
}

std::int64_t FidelityReference::front_width_px(std::int64_t wanted) const {
    constexpr std::int64_t tallest = 5120;
    const std::int64_t fitting = wanted * tallest / height_px(wanted);
    return std::min(wanted, std::max(fitting, picture.width));
}

std::int64_t fidelity_bytes(const FidelityReference& reference, const FidelitySettings& settings) {
    const Image& picture = reference.picture;
    const auto views = [&](std::int64_t width) {
        return width * reference.height_px(width) * (4 + picture.channels);
    };
    const std::int64_t small = reference.front_width_px(settings.width_px),
                       large = std::max(picture.width, small);
    const std::int64_t blurs = 2 * picture.width * picture.height * picture.channels;
    const std::int64_t sides =
        4 * settings.width_px * settings.width_px * (side_aspect[1] + edge_aspect[1]) / side_aspect[0];
    // Two views, their means and what is made of one of them.
    constexpr std::int64_t channels_of_mottle = 2 * 4 + 2 + 4;
    const std::int64_t aside = reference.front_width_px(aside_width_px),
                       tilted = channels_of_mottle * aside * reference.height_px(aside);
    const std::int64_t floats = blurs + views(small) + sides + tilted + views(large);
    return floats * std::int64_t(sizeof(float)) + front_fidelity_bytes(large, reference.height_px(large));
}

FidelityReport measure_fidelity(const Scene& now, const FidelityReference& reference,
                                const FidelitySettings& settings) {
    const auto step = [&](const std::string& name) {
        return settings.begin_step ? settings.begin_step(name) : Progress{};
    };
    LayerSets sets = load_sets(now, settings.cache, step("preparing"));
    FidelityReport report;
    report.credit = credit_of(now, sets, reference);
    FidelityViews views(now, std::move(sets));
    report.layer = reference.layer;
    report.reference = reference.file;
    report.disk = reference.disk;
    const auto front_at = [&](std::int64_t width_px) {
        return compare_front(views, reference, now.output.pixel_filter, width_px,
                             step(fmt::format("front at {} px", width_px)));
    };
    const std::int64_t small = reference.front_width_px(settings.width_px);
    FrontComparison front = front_at(small);
    report.front = std::move(front.fidelity);
    report.front_view = std::move(front.seen);
    report.front_reference = std::move(front.picture);
    const auto render = [&](JudgingView view, const std::int64_t(&aspect)[2], const char* name) {
        return views.render(along_galaxy(reference.frame, reference.galaxy), view, settings.width_px,
                            settings.width_px * aspect[1] / aspect[0], step(name));
    };
    const std::int64_t aside_px = reference.front_width_px(aside_width_px);
    const auto aside = [&](const FrontFrame& frame, JudgingView view, const char* name) {
        return views.render(frame, view, aside_px, reference.height_px(aside_px), step(name));
    };
    report.mottle = mottle(aside(reference.frame, JudgingView::above, "front"),
                           aside(reference.frame, JudgingView::tilted, "from 45 degrees"));
    if (report.disk)
        report.above = disk_from_above(
            aside(along_sight(reference.frame, reference.galaxy), JudgingView::above, "from above"));
    report.side_view = render(JudgingView::side, side_aspect, "from 60 degrees");
    report.needles = needles(report.side_view);
    report.flat_needles = flat_needles(report.front_reference);
    report.edge_view = render(JudgingView::edge, edge_aspect, "edge-on");
    report.edge = edge_on_profile(report.edge_view);
    report.full =
        reference.picture.width == small ? report.front : front_at(reference.picture.width).fidelity;
    return report;
}

FrontComparison compare_front(const Scene& now, LayerSets sets, const FidelityReference& reference,
                              std::int64_t width_px, const Progress& progress) {
    FidelityViews views(now, std::move(sets));
    return compare_front(views, reference, now.output.pixel_filter, reference.front_width_px(width_px),
                         progress);
}

}  // namespace astrosplat
