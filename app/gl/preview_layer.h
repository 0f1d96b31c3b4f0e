// The input of previews: layers, and the frame in which they are seen.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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
std::int64_t shown_count(const PreviewLayer& layer);

/// All that a layer's splats are shaded with, beside its set: while it stays equal, they stay.
struct Shading {
    Look look;
    LookInputs inputs;
    float map_probe = 0.0f;  // tells another map at the address of an old one
    bool operator==(const Shading&) const = default;
};
Shading shading_of(const PreviewLayer& layer);

/// A frame as previews draw it.
struct PreviewView {
    Camera camera;
    const Environment* environment = nullptr;
    std::int64_t width = 0, height = 0;  // px
    float pixel_filter = 0.5f;           // px
};

/// For the renderer's projections.
RenderSettings settings_of(const PreviewView& view);

}  // namespace astrosplat
