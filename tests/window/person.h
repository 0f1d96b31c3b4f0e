// The hands of the person at the window: real mouse and key events (xdotool), slow enough to be seen by one
// frame each.
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <vector>

namespace astrosplat::test {

class Person {
  public:
    explicit Person(std::string display) : display_(std::move(display)) {}

    void move(glm::vec2 to) const;
    void click(glm::vec2 at, int button = 1) const;  // 3: the right one
    void double_click(glm::vec2 at) const;
    /// With the left button, in steps; rests before letting go.
    void drag(glm::vec2 from, glm::vec2 by) const;
    /// Down, with the mouse there.
    void scroll(glm::vec2 at, int notches) const;
    /// "ctrl+s", "0", "Return", as xdotool names them.
    void press(const std::string& key) const;
    /// So many times, one after the other.
    void press_often(const std::string& key, int times) const;
    void type(const std::string& text, int delay_ms = 60) const;
    /// Return, and text right behind it.
    void enter_and_type(const std::string& text, int delay_ms) const;

  private:
    void act(std::vector<std::string> words) const;
    std::string display_;
};

}  // namespace astrosplat::test
