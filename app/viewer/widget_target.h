// Dear ImGui drawing into a frame of its own, without a window: for screenshots and measurements. Needs a
// current OpenGL context, and to be the only user of Dear ImGui.
#pragma once

#include <vector>

#include "gl/objects.h"

namespace astrosplat {

class WidgetTarget {
  public:
    /// A window of this size in px, at scale 1.
    WidgetTarget(int width, int height);
    ~WidgetTarget();
    WidgetTarget(const WidgetTarget&) = delete;
    WidgetTarget& operator=(const WidgetTarget&) = delete;

    /// Between these the widgets are called.
    void begin();
    void end();
    /// The frame last ended as 8-bit RGBA, top row first.
    std::vector<unsigned char> read() const;

  private:
    GlTarget target_;
};

}  // namespace astrosplat
