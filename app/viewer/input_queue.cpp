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

/// A key that a text field takes no notice of, for it has the character.
bool writes(const InputEvent& event) {
    constexpr int shift = 1;
    return (event.kind == Kind::key_down || event.kind == Kind::key_up) && event.modifiers <= shift &&
           event.code >= ' ' && event.code <= '~';
}

/// A frame can take another character, or the key it is of, into a text: only Left, Enter and the like change
/// where it would go.
bool fits_in_text(const std::vector<InputEvent>& frame) {
    return std::ranges::none_of(frame, [](const InputEvent& event) {
        return event.kind == Kind::press || event.kind == Kind::release ||
               (event.kind == Kind::key_down && !writes(event));
    });
}

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

std::vector<InputEvent> InputQueue::take(Typing typing) {
    const auto can_take = [&](const std::vector<InputEvent>& frame, const InputEvent& next) {
        if (typing == Typing::later && is_typed(next.kind)) return false;
        const bool text = typing == Typing::text && (next.kind == Kind::character || writes(next));
        return text ? fits_in_text(frame) : fits(frame, next);
    };
    std::vector<InputEvent> frame;
    while (!events_.empty() && can_take(frame, events_.front())) {
        frame.push_back(events_.front());
        events_.pop_front();
    }
    return frame;
}

}  // namespace astrosplat
