#include "viewer/preview_dots.h"

#include <algorithm>
#include <utility>

#include "look/apply.h"
#include "look/view_dependent.h"

namespace astrosplat {
namespace {

FoundSums make_sums(const SumsRequest& request, const Progress& progress) {
    const Shading& shading = request.shading;
    ShadedSplats splats = apply_look(*request.source.set, shading.look, shading.inputs, progress);
    return {merge_splats(request.source, std::move(splats), progress), {}};
}

}  // namespace

PreviewDots::PreviewDots() : work_(make_sums) {}

/// What is kept of the layer with this set: when a layer before it is hidden, the others stay as they are.
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
                      std::span<const std::shared_ptr<const LoadedLayer>> loaded, const Camera& camera,
                      const CutSettings& settings, float pixel_filter) {
    RenderSettings frame;
    frame.width = settings.width;
    frame.height = settings.height;
    frame.pixel_filter = pixel_filter;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        Layer& layer = layer_at(i, *loaded[i]);
        layers[i].layer.stars ? show_stars(layer, layers[i]) : merge(layer, layers[i]);
    }
    layers_.resize(layers.size());
    std::vector<CutLayer> seen;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Layer& layer = layers_[i];
        if (layers[i].layer.stars) continue;
        places.push_back(i);
        seen.push_back({layer.best().get(), layer.dots.get(),
                        make_projection(layers[i].layer, static_cast<std::uint16_t>(i), camera, frame)});
    }
    std::vector<ShadedSplats> splats = cut_splats(seen, settings);
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (is_encoded(layers[places[n]].layer.render)) encode_colors(splats[n]);
        layers_[places[n]].splats = std::make_shared<const ShadedSplats>(std::move(splats[n]));
        layers[places[n]].layer.render.opacity = 1.0f;
    }
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i].layer.splats = layers_[i].splats.get();
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
