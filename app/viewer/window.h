// Targets of the widgets: the window, or without a display a frame of their own, for screenshots and
// measurements. In: the widgets of a frame. Out: pixels, and the input of mouse and keyboard in its order,
// given out in portions that one frame of widgets can take.
#pragma once

#include <deque>

#include "core/standard.h"
#include "gl/objects.h"

struct GLFWwindow;

namespace astrosplat {

struct InputEvent {
    enum class Kind { move, press, release, wheel, key_down, key_up, character };
    Kind kind = Kind::move;
    int code = 0;             // mouse button, key code, or character
    int modifiers = 0;        // with a key
    double x = 0.0, y = 0.0;  // position, or notches of the wheel
    double time_s = 0.0;      // when it was seen
    bool operator==(const InputEvent&) const = default;
};

/// The use of the keyboard by the widgets now: nothing yet, act, or write.
enum class Typing { later, shortcuts, text };

/// Knows neither window nor widgets. Dear ImGui looks at mouse and keyboard once a frame. Where a frame takes
/// long, a click, a drag or a word falls between two frames: what it cannot tell apart waits for the frame
/// after.
class InputQueue {
  public:
    void push(const InputEvent& event) { events_.push_back(event); }
    bool empty() const { return events_.empty(); }
    /// The longest beginning of what waits in which nothing hides what came before: no button or key is
    /// changed twice, a button is pressed and let go where the mouse was last seen, and no key or character
    /// comes before another that was meant to be first. In a text all characters may come at once.
    std::vector<InputEvent> take(Typing typing = Typing::shortcuts);

  private:
    std::deque<InputEvent> events_;
};

/// One of the widgets' draw commands: where it draws, and a number that differs when it draws something else.
struct DrawnCommand {
    PixelRect box;
    std::uint64_t hash = 0;
    bool operator==(const DrawnCommand&) const = default;
};
using DrawnFrame =
    std::vector<std::vector<DrawnCommand>>;  // of each of Dear ImGui's windows, the hindmost first

/// Outside of these boxes, no two of which overlap, both frames look the same.
std::vector<PixelRect> changed_boxes(const DrawnFrame& before, const DrawnFrame& now);

/// What the widgets show as the texture of this handle: opaque, lowest row first, of this size in px.
struct ShownPicture {
    void* texture = nullptr;
    int width = 0, height = 0;
};

/// Keeps the widgets' last frame, and draws of the next one what differs: filling a window of 1320x765 takes
/// a software rasteriser 30 ms, and mostly only the picture moves.
class WidgetPainter {
  public:
    /// Of what ImGui::Render() made; `frames`: differs whenever the pixels of a texture do that the widgets
    /// show. Returns whether the frame looks different.
    bool paint(int width, int height, std::uint64_t frames, const ShownPicture& picture);
    /// Everything is drawn the next time.
    void forget() { drawn_.clear(); }
    void copy_to(unsigned framebuffer) const;
    /// RGBA, top row first.
    std::vector<unsigned char> read(int& width, int& height) const;

  private:
    GlTarget target_;
    DrawnFrame drawn_;  // that the target holds
};

/// GLFW, an OpenGL context and Dear ImGui's backends, owned for as long as the viewer runs.
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
    /// Input waits for the next frame.
    bool has_input() const { return !input_.empty(); }
    /// Begins a frame of widgets; false while the window is minimised. `opening`: something was opened that
    /// may be about to take what is typed.
    bool begin_frame(bool opening);
    /// Ends the frame without showing it.
    void drop_frame();
    /// Draws the widgets and shows the frame, unless it would look like the one before
    /// (WidgetPainter::paint). Returns whether it was shown.
    bool end_frame(std::uint64_t frames, const ShownPicture& picture);

    bool close_requested();  // and forgets it
    std::vector<fs::path> take_dropped();
    void set_title(const std::string& title);
    /// Px at scale 1, for the preferences.
    void size(int& width, int& height) const;
    float content_scale() const;
    /// After apply_theme() was called again.
    void reload_fonts();
    const GlInfo& gl() const { return gl_; }
    /// The frame last drawn, RGBA, top row first.
    std::vector<unsigned char> read(int& width, int& height) const;

  private:
    void listen();
    void push(InputEvent event);
    void feed(const InputEvent& event);
    /// Gives the widgets a portion of what the hand did, as if it were now.
    void feed_frame(bool opening);

    GLFWwindow* window_ = nullptr;
    std::unique_ptr<WidgetPainter> painter_ = std::make_unique<WidgetPainter>();  // ends before the context
    bool damaged_ = true;  // the system wants the frame drawn again
    InputQueue input_;
    double mouse_x_ = 0.0, mouse_y_ = 0.0;  // as the widgets know it
    bool mouse_known_ = false;
    bool button_down_[3] = {};
    int frames_opening_ = 0;
    int frames_until_focus_ = 0;  // after what may move it
    double widget_time_s_ = 0.0, frame_began_s_ = 0.0, frame_took_s_ = 0.0;
    GlInfo gl_;
    std::vector<fs::path> dropped_;
};

/// Needs a current OpenGL context, and to be the only user of Dear ImGui.
class WidgetTarget {
  public:
    /// A window of this size in px, at scale 1.
    WidgetTarget(int width, int height);
    ~WidgetTarget();
    WidgetTarget(const WidgetTarget&) = delete;
    WidgetTarget& operator=(const WidgetTarget&) = delete;

    /// Between these the widgets are called.
    void begin();
    void end(const ShownPicture& picture = {});
    /// The frame last ended as 8-bit RGBA, top row first.
    std::vector<unsigned char> read() const;

  private:
    WidgetPainter painter_;
    std::uint64_t frames_ = 0;
};

}  // namespace astrosplat
