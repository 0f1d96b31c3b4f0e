#include "viewer/preview_dots.h"

#include <algorithm>
#include <utility>

#include "core/progress.h"
#include "look/apply.h"

namespace astrosplat {
namespace {

FoundSums make_sums(const SumsRequest& request, const Progress& progress) {
    const Shading& shading = request.shading;
    ShadedSplats splats = apply_look(*request.source.set, shading.look, shading.inputs, progress);
    return {merge_splats(request.source, std::move(splats), progress), {}};
}

using SharedSplats = std::shared_ptr<const ShadedSplats>;

/// Gives the layers their splats, which live in what is returned; of stars those that they have.
std::vector<SharedSplats> cut_layers(std::vector<PreviewLayer>& layers, std::span<const CutSource> sources,
                                     const PreviewView& view, std::int64_t budget, float least_px) {
    const RenderSettings frame = settings_of(view);
    std::vector<CutLayer> seen;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (const CutSource& source = sources[i]; source.merged)
            seen.push_back(
                {source.merged.get(), source.dots.get(),
                 make_projection(layers[i].layer, static_cast<std::uint16_t>(i), view.camera, frame)});
    std::vector<ShadedSplats> cut = cut_splats(seen, {budget, least_px, view.width, view.height});
    std::vector<SharedSplats> splats;
    for (std::size_t i = 0, next = 0; i < layers.size(); ++i) {
        RenderLayer& layer = layers[i].layer;
        splats.push_back(sources[i].stars);
        if (sources[i].merged) {
            if (is_encoded(layer.render)) encode_colors(cut[next]);
            splats.back() = std::make_shared<const ShadedSplats>(std::move(cut[next++]));
            layer.render.opacity = 1.0f;
        }
        layer.splats = splats.back().get();
    }
    return splats;
}

FinerFound draw_finer(const FinerRequest& request, CpuPreview& preview, const Progress& progress) {
    const auto start = Clock::now();
    std::vector<PreviewLayer> layers(request.layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i].layer = request.layers[i];
    const std::vector<SharedSplats> splats =
        cut_layers(layers, request.sources, request.view, request.budget, CutSettings().least_px);
    progress.check();
    FinerFound found;
    for (const SharedSplats& of_layer : splats) found.shown += of_layer->size();
    found.image = preview.draw(layers, request.view, progress);
    found.seconds = seconds_since(start);
    return found;
}

}  // namespace

FinerPreview::Work finer_preview() {
    return [preview = std::make_shared<CpuPreview>()](const FinerRequest& request, const Progress& progress) {
        return draw_finer(request, *preview, progress);
    };
}

PreviewDots::PreviewDots() : work_(make_sums) {}

/// The state that is kept of the layer with this set: when a layer before it is hidden, the others stay as
/// they are.
PreviewDots::Layer& PreviewDots::layer_at(std::size_t index, const LoadedLayer& loaded) {
    const auto first = layers_.begin() + static_cast<std::ptrdiff_t>(std::min(index, layers_.size()));
    const auto found =
        std::find_if(first, layers_.end(), [&](const Layer& l) { return l.sample == loaded.sample; });
    if (found != layers_.end()) {
        std::iter_swap(layers_.begin() + static_cast<std::ptrdiff_t>(index), found);
    } else {
        layers_.emplace(first);
        layers_[index].sample = loaded.sample;
    }
    layers_[index].whole = loaded.whole;
    return layers_[index];
}

void PreviewDots::merge(Layer& layer, const PreviewLayer& wanted) {
    if (!layer.dots || !(layer.dots->render == wanted.layer.render))
        layer.dots = std::make_shared<const DotSettings>(wanted.layer.render, wanted.set->is_on_lattice());
    Shading shading = shading_of(wanted);
    if (layer.shading == shading) return;
    layer.shading.reset();  // an exception below must not leave old splats under a new look
    layer.of_whole.reset();
    looks_changed_ = true;
    work_.forget();
    layer.of_sample = std::make_shared<const MergedSplats>(
        merge_splats(layer.sample, apply_look(*layer.sample.set, shading.look, shading.inputs)));
    layer.shading = std::move(shading);
}

void PreviewDots::show_stars(Layer& layer, const PreviewLayer& wanted) {
    Shading shading = shading_of(wanted);
    if (layer.shading == shading) return;
    layer.shading.reset();
    layer.splats =
        std::make_shared<const ShadedSplats>(apply_look(*layer.sample.set, shading.look, shading.inputs));
    layer.shading = std::move(shading);
}

void PreviewDots::cut(std::vector<PreviewLayer>& layers,
                      std::span<const std::shared_ptr<const LoadedLayer>> loaded, const PreviewView& view,
                      std::int64_t budget, float least_px) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
        Layer& layer = layer_at(i, *loaded[i]);
        layers[i].layer.stars ? show_stars(layer, layers[i]) : merge(layer, layers[i]);
    }
    layers_.resize(layers.size());
    std::vector<SharedSplats> splats = cut_layers(layers, sources(), view, budget, least_px);
    for (std::size_t i = 0; i < layers.size(); ++i) layers_[i].splats = std::move(splats[i]);
}

std::optional<SumsRequest> PreviewDots::missing() const {
    for (const Layer& layer : layers_)
        if (layer.whole.tree && layer.shading && !layer.of_whole)
            return SumsRequest{layer.whole, *layer.shading};
    return std::nullopt;
}

bool PreviewDots::whole() const {
    return std::ranges::all_of(layers_, [](const Layer& layer) {
        return !layer.sample.tree || layer.sample.weight <= 1.0f || layer.best() != layer.of_sample;
    });
}

bool PreviewDots::refine(double now) {
    constexpr double rest_s = 0.1;
    if (std::exchange(looks_changed_, false)) at_rest_since_ = now;
    if (now - at_rest_since_ < rest_s) return false;
    const std::optional<SumsRequest> wanted = missing();
    if (!wanted) return false;
    work_.want(*wanted);
    const std::shared_ptr<const FoundSums> found = work_.found(*wanted);
    if (!found) return false;
    for (Layer& layer : layers_)
        if (layer.whole == wanted->source && layer.shading == wanted->shading) layer.of_whole = found;
    work_.forget();  // or sums under a look would outlive it
    return found->error.empty();
}

std::vector<CutSource> PreviewDots::sources() const {
    std::vector<CutSource> sources;
    for (const Layer& layer : layers_) {
        if (layer.sample.tree)
            sources.push_back({layer.best(), layer.dots, nullptr});
        else
            sources.push_back({nullptr, nullptr, layer.splats});
    }
    return sources;
}

std::vector<double> PreviewDots::kept() const {
    std::vector<double> shares;
    for (const Layer& layer : layers_) {
        const auto rows = static_cast<double>(std::max<std::int64_t>(1, layer.sample.set->size()));
        const std::int64_t seen = layer.sample.tree ? layer.of_sample->splats.size() : layer.splats->size();
        shares.push_back(static_cast<double>(seen) / rows);
    }
    return shares;
}

}  // namespace astrosplat
