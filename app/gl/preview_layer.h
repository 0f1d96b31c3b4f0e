// The input of previews: layers, and the frame in which they are seen.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include "camera/camera.h"
#include "core/image.h"
#include "look/apply.h"
#include "render/environment.h"
#include "render/frame.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// One layer of the preview. Where `layer.splats` is given, these are drawn (merge/cut.h); else all of `set`,
/// which the look is applied to here. The same `set` means that nothing needs uploading.
struct PreviewLayer {
    RenderLayer layer;
    std::shared_ptr<const SplatSet> set;
    Look look;
    LookInputs inputs;
};

/// Splats of a layer that are drawn, before its look drops any.
inline std::int64_t shown_count(const PreviewLayer& layer) {
    if (layer.layer.splats) return layer.layer.splats->size();
    return layer.set ? layer.set->size() : 0;
}

/// A number that differs, most likely, from that of another image at the same address.
inline float content_probe(const Image& image) {
    constexpr std::size_t looks = 97;  // at pixels, about
    auto sum = static_cast<float>(image.width);
    const std::size_t step = std::max<std::size_t>(1, image.pixels.size() / looks);
    for (std::size_t i = 0; i < image.pixels.size(); i += step) sum = 0.75f * sum + image.pixels[i];
    return sum;
}

/// All that a layer's splats are shaded with, beside its set: while it stays equal, they stay.
struct Shading {
    Look look;
    LookInputs inputs;
    float map_probe = 0.0f;  // tells another map at the address of an old one
    bool operator==(const Shading&) const = default;
};
inline Shading shading_of(const PreviewLayer& layer) {
    const Image* map = layer.inputs.thickness_map;
    return {layer.look, layer.inputs, map ? content_probe(*map) : 0.0f};
}

/// A frame as previews draw it.
struct PreviewView {
    Camera camera;
    const Environment* environment = nullptr;
    std::int64_t width = 0, height = 0;  // px
    float pixel_filter = 0.5f;           // px
};

/// For the renderer's projections.
inline RenderSettings settings_of(const PreviewView& view) {
    RenderSettings settings;
    settings.width = view.width;
    settings.height = view.height;
    settings.pixel_filter = view.pixel_filter;
    return settings;
}

}  // namespace astrosplat
