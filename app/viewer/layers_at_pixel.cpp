#include "viewer/layers_at_pixel.h"

#include <algorithm>
#include <functional>

#include "render/render.h"

namespace astrosplat {
namespace {

constexpr float least_share = 0.02f;  // of the brightest layer's light

RenderSettings settings_at(const PreviewView& view, std::int64_t x, std::int64_t y) {
    RenderSettings settings;
    settings.width = view.width;
    settings.height = view.height;
    settings.pixel_filter = view.pixel_filter;
    settings.region = {std::max<std::int64_t>(0, x - 1), std::max<std::int64_t>(0, y - 1), 0, 0};
    settings.region.width = std::min(view.width, x + 2) - settings.region.x;
    settings.region.height = std::min(view.height, y + 2) - settings.region.y;
    return settings;
}

/// Of r, g and b.
double light_of(const Image& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(picture.pixels[i]);
    return sum;
}

bool hides(const RenderLayer& layer) {
    return layer.absorbs || layer.render.holdout || layer.render.blend == Blend::absorb;
}

}  // namespace

std::vector<float> light_of_layers(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                   std::int64_t x, std::int64_t y) {
    std::vector<float> light(layers.size());
    if (x < 0 || y < 0 || x >= view.width || y >= view.height) return light;
    std::vector<RenderLayer> drawn;
    for (const PreviewLayer& layer : layers) {
        drawn.push_back(layer.layer);
        drawn.back().render.lod = {};
    }
    RenderSettings settings = settings_at(view, x, y);
    settings.aov_layers = true;
    const RenderedFrame all = render(drawn, view.camera, view.environment, settings);
    settings.aov_layers = false;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
        double own = light_of(all.layers[i]);
        if (hides(drawn[i])) {
            std::vector<RenderLayer> others = drawn;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            const Image without = render(others, view.camera, view.environment, settings).beauty;
            own = std::max(own, light_of(without) - light_of(all.beauty));
        }
        light[i] = static_cast<float>(own);
    }
    return light;
}

std::vector<std::size_t> seen_layers(const std::vector<float>& light) {
    std::vector<std::size_t> seen;
    const float brightest = light.empty() ? 0.0f : *std::ranges::max_element(light);
    for (std::size_t i = 0; i < light.size(); ++i)
        if (light[i] > least_share * brightest) seen.push_back(i);
    std::ranges::stable_sort(seen, std::greater<>(), [&](std::size_t i) { return light[i]; });
    return seen;
}

std::optional<std::size_t> clicked_layer(const std::vector<std::size_t>& seen, std::size_t selected,
                                         bool behind) {
    if (seen.empty()) return std::nullopt;
    const auto found = std::ranges::find(seen, selected);
    if (!behind || found == seen.end() || found + 1 == seen.end()) return seen.front();
    return *(found + 1);
}

}  // namespace astrosplat
