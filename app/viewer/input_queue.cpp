// An event ends the portion when one of those before it in the same frame would be seen at the wrong place or
// in the wrong order.
#include "viewer/input_queue.h"

#include <algorithm>
#include <initializer_list>

namespace astrosplat {
namespace {

using Kind = InputEvent::Kind;

bool has(const std::vector<InputEvent>& frame, std::initializer_list<Kind> kinds) {
    return std::any_of(frame.begin(), frame.end(), [&](const InputEvent& event) {
        return std::find(kinds.begin(), kinds.end(), event.kind) != kinds.end();
    });
}

bool is_typed(Kind kind) { return kind == Kind::key_down || kind == Kind::character; }

/// A frame that has taken `frame` can take `next` too.
bool fits(const std::vector<InputEvent>& frame, const InputEvent& next) {
    if (has(frame, {Kind::press, Kind::release})) return false;
    switch (next.kind) {
        case Kind::move:
            return !has(frame, {Kind::wheel, Kind::key_down, Kind::key_up, Kind::character});
        case Kind::wheel:
            return !has(frame, {Kind::key_down, Kind::key_up, Kind::character});
        case Kind::press:    // widgets below others are hovered for a frame before they can be pressed
        case Kind::release:  // what is dragged is not moved any more by the frame in which it is let go
            return frame.empty();
        case Kind::key_down:  // with keys held, such as Ctrl, only from the frames before
            return !has(frame, {Kind::key_down, Kind::character});
        case Kind::key_up:  // also of Ctrl after S
            return !has(frame, {Kind::key_down});
        case Kind::character:  // of the key before it
            return !has(frame, {Kind::character});
    }
    return true;
}

}  // namespace

std::vector<InputEvent> InputQueue::take(bool may_type) {
    std::vector<InputEvent> frame;
    while (!events_.empty() && (may_type || !is_typed(events_.front().kind)) &&
           fits(frame, events_.front())) {
        frame.push_back(events_.front());
        events_.pop_front();
    }
    return frame;
}

}  // namespace astrosplat
