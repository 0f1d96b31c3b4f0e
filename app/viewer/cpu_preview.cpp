#include "viewer/cpu_preview.h"

#include <algorithm>
#include <functional>

#include "render/environment.h"

namespace astrosplat {
namespace {

constexpr float least_share = 0.02f;  // of the brightest layer's light

/// Not split up by level of detail.
std::vector<RenderLayer> drawn_layers(const std::vector<PreviewLayer>& layers) {
    std::vector<RenderLayer> drawn;
    for (const PreviewLayer& layer : layers) drawn.emplace_back(layer.layer).render.lod = {};
    return drawn;
}

/// The pixel (x, y) and its neighbours within the view.
Region around(const PreviewView& view, std::int64_t x, std::int64_t y) {
    Region region{std::max<std::int64_t>(0, x - 1), std::max<std::int64_t>(0, y - 1), 0, 0};
    region.width = std::min(view.width, x + 2) - region.x;
    region.height = std::min(view.height, y + 2) - region.y;
    return region;
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

const Image& CpuPreview::draw(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                              const Progress& progress) {
    RenderSettings settings = settings_of(view);
    if (view.environment && !view.environment->faces->empty()) {
        draw_backdrop(*view.environment, view.camera, static_cast<int>(view.width),
                      static_cast<int>(view.height), backdrop_);
        settings.backdrop = &backdrop_;
    }
    frame_ = render(drawn_layers(layers), view.camera, nullptr, settings, progress, &cache_).beauty;
    return frame_;
}

std::vector<float> light_of_layers(const std::vector<PreviewLayer>& layers, const PreviewView& view,
                                   std::int64_t x, std::int64_t y) {
    std::vector<float> light(layers.size());
    if (x < 0 || y < 0 || x >= view.width || y >= view.height) return light;
    const std::vector<RenderLayer> drawn = drawn_layers(layers);
    RenderSettings settings = settings_of(view);
    settings.region = around(view, x, y);
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
