// A screen of the test's own: an X server without a monitor (Xvfb) on a free display, what is to be seen on
// it, and files dropped on its window.
#pragma once

#include <glm/vec2.hpp>

#include "core/standard.h"

namespace astrosplat::test {

/// A rectangle of the screen, px from its upper left.
struct Area {
    int x = 0, y = 0, width = 0, height = 0;
};

/// A part of the screen, 0xRRGGBB, top row first.
struct Pixels {
    int width = 0, height = 0;
    std::vector<std::uint32_t> rgb;
    bool operator==(const Pixels&) const = default;
};

/// How many pixels have exactly this colour (ImU32).
int count_of(const Pixels& pixels, std::uint32_t color);

class Screen {
  public:
    Screen(int width, int height);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// ":7", for $DISPLAY.
    const std::string& display() const;
    Pixels pixels(const Area& area) const;
    /// Of the one window; empty while there is none.
    std::string title() const;
    /// Of the one window, its border not counted; zeros while there is none.
    Area window_area() const;
    /// Dots per inch that the desktop names to programs when they start: 96 is scale 1.
    void set_dpi(int dpi) const;
    /// Keys go to the window, as a window manager would have it.
    void focus() const;
    /// Drags the files of another program over the window and lets go there. False where the window does not
    /// take them.
    bool drop(const std::vector<fs::path>& files, glm::vec2 at) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace astrosplat::test
