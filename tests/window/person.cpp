// One xdotool a gesture: its words are events and the waits between them.
#include "window/person.h"

#include "support/run_program.h"
#include "support/test.h"

namespace astrosplat::test {
namespace {

using Words = std::vector<std::string>;

void add(Words& words, const Words& more) { words.insert(words.end(), more.begin(), more.end()); }

Words to(glm::vec2 at) {
    return {"mousemove", std::to_string(std::lround(at.x)), std::to_string(std::lround(at.y))};
}

}  // namespace

void Person::act(std::vector<std::string> words) const {
    words.insert(words.begin(), {"/usr/bin/env", "xdotool"});
    expect_success(run_program(words, {.environment = {"DISPLAY=" + display_}}));
}

void Person::move(glm::vec2 at) const {
    Words words = to(at);
    add(words, {"sleep", "0.15"});
    act(words);
}

void Person::click(glm::vec2 at, int button) const {
    const std::string pressed = std::to_string(button);
    Words words = to(at);
    add(words, {"sleep", "0.2", "mousedown", pressed, "sleep", "0.15", "mouseup", pressed, "sleep", "0.15"});
    act(words);
}

void Person::double_click(glm::vec2 at) const {
    Words words = to(at);
    add(words, {"sleep", "0.4"});  // since the last click
    for (int i = 0; i < 2; ++i)
        add(words, {"mousedown", "1", "sleep", "0.05", "mouseup", "1", "sleep", "0.05"});
    add(words, {"sleep", "0.3"});
    act(words);
}

void Person::drag(glm::vec2 from, glm::vec2 by) const {
    constexpr int steps = 10;
    Words words = to(from);
    add(words, {"sleep", "0.4", "mousedown", "1", "sleep", "0.15"});
    for (int i = 1; i <= steps; ++i) {
        add(words, to(from + by * (float(i) / steps)));
        add(words, {"sleep", "0.04"});
    }
    add(words, {"sleep", "0.2", "mouseup", "1", "sleep", "0.15"});
    act(words);
}

void Person::scroll(glm::vec2 at, int notches) const {
    Words words = to(at);
    add(words, {"sleep", "0.15", "click", "--delay", "8", "--repeat", std::to_string(notches), "5"});
    act(words);
}

void Person::press(const std::string& key) const {
    act({"keydown", key, "sleep", "0.2", "keyup", key, "sleep", "0.15"});
}

void Person::press_often(const std::string& key, int times) const {
    act({"key", "--delay", "30", "--repeat", std::to_string(times), "--repeat-delay", "30", key});
}

void Person::type(const std::string& text, int delay_ms) const {
    act({"type", "--delay", std::to_string(delay_ms), text});
}

void Person::enter_and_type(const std::string& text, int delay_ms) const {
    act({"key", "Return", "type", "--delay", std::to_string(delay_ms), text});
}

}  // namespace astrosplat::test
