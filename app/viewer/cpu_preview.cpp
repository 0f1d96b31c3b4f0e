#include "viewer/cpu_preview.h"

#include "render/backdrop.h"

namespace astrosplat {

const Image& CpuPreview::draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                              const Environment* environment, int width, int height, float pixel_filter,
                              const Progress& progress) {
    std::vector<RenderLayer> visible;
    for (const PreviewLayer& layer : layers) {
        visible.push_back(layer.layer);
        visible.back().render.lod = {};
    }
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.pixel_filter = pixel_filter;
    if (environment && !environment->faces->empty()) {
        draw_backdrop(*environment, camera, width, height, backdrop_);
        settings.backdrop = &backdrop_;
    }
    frame_ = render(visible, camera, nullptr, settings, progress, &cache_).beauty;
    return frame_;
}

}  // namespace astrosplat
