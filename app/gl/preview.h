// The frame in motion, drawn by OpenGL: the splats of a cut, or raw splats in GPU memory with the look
// evaluated there (shaders/shared), sorted, into an RGBA32F frame (DESIGN 10).
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

class GlPreview {
  public:
    /// Needs a current context of OpenGL 4.1 core or later. Throws std::runtime_error with the driver's words
    /// where a shader does not compile.
    GlPreview();
    ~GlPreview();

    /// Draws into its own frame and returns the texture (RGBA32F, linear, premultiplied, top row first).
    /// Layers in file order. Throws InputError where a look cannot be applied.
    unsigned draw(const std::vector<PreviewLayer>& layers, const PreviewView& view);
    /// The order of the last draw() was that of an older camera: draw again soon.
    bool sorting() const;
    /// For tests and screenshots: waits for the sorting, so that the next draw() is exact.
    void wait_for_order();
    /// The frame as it is, read back.
    Image read() const;
    std::int64_t shown() const;  // splats of the last draw, before the look dropped any

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
