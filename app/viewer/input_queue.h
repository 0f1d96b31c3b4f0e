// Input of mouse and keyboard in its order, given out in portions that one frame of widgets can take. In:
// events as they come. Out: those of the next frame. Knows neither window nor widgets.
#pragma once

#include <deque>
#include <vector>

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

/// Dear ImGui looks at mouse and keyboard once a frame. Where a frame takes long, a click, a drag or a word
/// falls between two frames: what it cannot tell apart waits for the frame after.
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

}  // namespace astrosplat
