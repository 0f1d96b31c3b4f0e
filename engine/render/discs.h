// Where splats are on the frame and how far they reach, value by value, as vector code wants them.
#pragma once

#include <cstddef>

#include "core/buffer.h"

namespace astrosplat {

/// Centres and reaches in px of the whole frame.
struct Discs {
    Buffer<float> x_px, y_px, reach_px;
    void resize(std::size_t size) {
        x_px.resize(size);
        y_px.resize(size);
        reach_px.resize(size);
    }
    void set(std::size_t i, float x, float y, float reach) {
        x_px[i] = x;
        y_px[i] = y;
        reach_px[i] = reach;
    }
    /// Touches nothing: fills the last vector.
    void set_nowhere(std::size_t i) { set(i, 1e30f, 1e30f, 0.0f); }
};

}  // namespace astrosplat
