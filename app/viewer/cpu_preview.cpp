// What is kept from draw to draw: each layer's first rows, and those rows shaded and decimated, until the
// share, the look or the set changes. A new camera costs nothing but render().
#include "viewer/cpu_preview.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "look/apply.h"
#include "look/decimate.h"
#include "render/backdrop.h"
#include "splats/stratified.h"

namespace astrosplat {
namespace {

void cut(const PreviewLayer& layer, KeptLayer& kept) {
    const std::int64_t rows = shown_count(layer);
    if (kept.set == layer.set && kept.rows.size() == rows) return;
    kept.rows = first_rows(*layer.set, rows);
    kept.set = layer.set;
    kept.shading.reset();
}

void shade(const PreviewLayer& layer, KeptLayer& kept) {
    Shading shading = shading_of(layer);
    if (kept.shading == shading) return;
    kept.shading.reset();  // an exception below must not leave old splats under a new look
    apply_look(kept.rows, layer.look, layer.inputs, kept.shaded);
    if (kept.rows.size() > 0) {
        const double share = static_cast<double>(kept.rows.size()) / static_cast<double>(whole_count(layer));
        decimate(kept.shaded, static_cast<float>(share), shading.additive);
    }
    kept.shading = std::move(shading);
}

}  // namespace

/// What is kept of the layer that shows this set: when a layer before it is hidden, the others stay as they
/// are.
KeptLayer& CpuPreview::layer_at(std::size_t index, const std::shared_ptr<const SplatSet>& set) {
    const auto first = layers_.begin() + static_cast<std::ptrdiff_t>(std::min(index, layers_.size()));
    const auto found = std::find_if(first, layers_.end(), [&](const KeptLayer& k) { return k.set == set; });
    if (found != layers_.end())
        std::iter_swap(layers_.begin() + static_cast<std::ptrdiff_t>(index), found);
    else
        layers_.emplace(first);
    return layers_[index];
}

const Image& CpuPreview::draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                              const Environment* environment, int width, int height, float pixel_filter) {
    shown_ = 0;
    std::vector<RenderLayer> visible;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        KeptLayer& kept = layer_at(i, layers[i].set);
        cut(layers[i], kept);
        shade(layers[i], kept);
        shown_ += kept.rows.size();
        visible.push_back(layers[i].layer);
        visible.back().render.lod.max_px = 0.0f;
    }
    layers_.resize(layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) visible[i].splats = &layers_[i].shaded;
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.pixel_filter = pixel_filter;
    if (environment && !environment->faces->empty()) {
        draw_backdrop(*environment, camera, width, height, backdrop_);
        settings.backdrop = &backdrop_;
    }
    frame_ = render(visible, camera, nullptr, settings, {}, &cache_).beauty;
    return frame_;
}

std::vector<double> CpuPreview::kept() const {
    std::vector<double> shares;
    for (const KeptLayer& layer : layers_) {
        const auto rows = static_cast<double>(std::max<std::int64_t>(1, layer.rows.size()));
        shares.push_back(static_cast<double>(layer.shaded.size()) / rows);
    }
    return shares;
}

}  // namespace astrosplat
