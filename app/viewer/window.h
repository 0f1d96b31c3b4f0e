// The window: GLFW, an OpenGL context and Dear ImGui's backends, owned for as long as the viewer runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gl/context.h"

struct GLFWwindow;

namespace astrosplat {

class Window {
  public:
    /// Opens a window of about width x height (screen units). Throws std::runtime_error in one line where
    /// there is no display or no OpenGL 4.1.
    Window(int width, int height, const std::string& title);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Waits up to `seconds` for events (0: only takes those that are there).
    void wait(double seconds);
    /// Ends a wait() from any thread.
    static void wake();
    /// Begins a frame of widgets; false while the window is minimised.
    bool begin_frame();
    /// Draws the widgets and shows the frame, unless it would look like the one before: filling the window
    /// takes a software rasteriser 30 ms. `pictures`: differs whenever the pixels of a texture do that the
    /// widgets show.
    /// Returns whether it was shown.
    bool end_frame(std::uint64_t pictures);

    bool close_requested();  // and forgets it
    std::vector<std::filesystem::path> take_dropped();
    void set_title(const std::string& title);
    /// Screen units, for the preferences.
    void size(int& width, int& height) const;
    float content_scale() const;
    const GlInfo& gl() const { return gl_; }
    /// The frame last drawn, RGBA, top row first.
    std::vector<unsigned char> read(int& width, int& height) const;

  private:
    struct KeyPress {
        int key, modifiers;
    };
    /// Dear ImGui looks at the state of a key once a frame: a key pressed and released between two frames
    /// would be lost. It is held down for the one frame instead.
    void hold_short_presses();
    void release_short_presses();

    /// What a frame looks like.
    struct FrameMark {
        std::uint64_t widgets = 0, pictures = 0;
        int width = 0, height = 0;
        bool operator==(const FrameMark&) const = default;
    };

    GLFWwindow* window_ = nullptr;
    FrameMark shown_;
    bool damaged_ = true;            // the system wants the frame drawn again
    std::vector<KeyPress> pressed_;  // since the last frame
    GlInfo gl_;
    std::vector<std::filesystem::path> dropped_;
};

}  // namespace astrosplat
