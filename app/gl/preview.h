// The frame in motion, drawn by OpenGL: the splats of a cut, or raw splats in GPU memory with the look
// evaluated there (shaders/shared), sorted, into an RGBA32F frame (DESIGN 10).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gl/preview_layer.h"

namespace astrosplat {

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
