#include "gl/preview_layer.h"

#include "gl/image_texture.h"

namespace astrosplat {

std::int64_t shown_count(const PreviewLayer& layer) {
    if (layer.layer.splats) return layer.layer.splats->size();
    return layer.set ? layer.set->size() : 0;
}

RenderSettings settings_of(const PreviewView& view) {
    RenderSettings settings;
    settings.width = view.width;
    settings.height = view.height;
    settings.pixel_filter = view.pixel_filter;
    return settings;
}

Shading shading_of(const PreviewLayer& layer) {
    const Image* map = layer.inputs.thickness_map;
    return {layer.look, layer.inputs, map ? content_probe(*map) : 0.0f};
}

}  // namespace astrosplat
