// The frame in motion, drawn by OpenGL: raw splats in GPU memory, the look evaluated there
// (shaders/shared), a share of every layer, sorted, into an RGBA32F frame (DESIGN 10).
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

/// One layer of the preview. `set` holds the splats in stratified order (splats/stratified.h), so that any
/// prefix is a fair sample; the same pointer means that nothing needs uploading.
struct PreviewLayer {
    RenderLayer layer;  // name, render, transform; its `splats` are not used
    std::shared_ptr<const SplatSet> set;
    Look look;
    LookInputs inputs;
    float share = 1.0f;      // of the whole set, 0..1; no more than `set` holds is drawn
    std::int64_t whole = 0;  // splats of the whole set, of which `set` is a prefix; 0: `set` is all of it
};

/// Splats that a layer's share is counted of.
inline std::int64_t whole_count(const PreviewLayer& layer) {
    const std::int64_t there = layer.set ? layer.set->size() : 0;
    return layer.whole > there ? layer.whole : there;
}

/// Splats of a layer that its share shows: at least one where the set has any.
std::int64_t shown_count(const PreviewLayer& layer);

/// All that a layer's splats are shaded and thinned out with, beside its rows and share: while it stays
/// equal, they stay.
struct Shading {
    Look look;
    LookInputs inputs;
    bool additive = false;   // light adds up, so fewer splats need no larger radius
    float map_probe = 0.0f;  // tells another map at the address of an old one
    bool operator==(const Shading&) const = default;
};
Shading shading_of(const PreviewLayer& layer);

class GlPreview {
  public:
    /// Needs a current context of OpenGL 4.1 core or later. Throws std::runtime_error with the driver's words
    /// where a shader does not compile.
    GlPreview();
    ~GlPreview();

    /// Draws into its own frame of width x height px and returns the texture (RGBA32F, linear,
    /// premultiplied, top row first). Layers in file order. Throws InputError where a look cannot be applied.
    unsigned draw(const std::vector<PreviewLayer>& layers, const Camera& camera,
                  const Environment* environment, int width, int height, float pixel_filter);
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
