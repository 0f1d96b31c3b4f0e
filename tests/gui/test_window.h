// The window without a screen: widgets drawn frame by frame, mouse and keyboard given by hand, what they
// asked for kept.
#pragma once

#include <imgui.h>

#include "gui/gui.h"
#include "gui/software_draw.h"
#include "support/test.h"

namespace astrosplat {

class TestWindow {
  public:
    explicit TestWindow(Document document_, int width = 1600, int height = 900, float content_scale = 1.0f);
    ~TestWindow();
    TestWindow(const TestWindow&) = delete;
    TestWindow& operator=(const TestWindow&) = delete;

    void frame(int count = 1);
    void move(glm::vec2 to);
    /// Moves there and lets two frames see it.
    void hover(glm::vec2 to);
    void press(int button = 0);
    void release(int button = 0);
    void click(glm::vec2 at, int button = 0);
    void double_click(glm::vec2 at);
    void drag(glm::vec2 from, glm::vec2 by, int button = 0);
    void wheel(float notches);
    void tap(int code, bool ctrl = false, bool shift = false);
    void hold(bool ctrl, bool shift, bool alt);
    void type(const std::string& text);

    /// Middle of a control by its name; fails the test where it is not there.
    glm::vec2 at(const std::string& name);
    bool has(const std::string& name) const;
    void click(const std::string& name) { click(at(name)); }
    /// Middle of the keyboard's ring; fails the test where there is none.
    glm::vec2 ring() const;
    /// Opens the menus of "File/Open recent/x" one after the other and clicks the last.
    void choose(const std::string& path);

    /// Commands since the last call.
    Commands take_commands();
    /// The one command since then; fails the test where it is none or of another kind.
    Command take_only(Command::Kind kind);
    /// The last frame as it looks.
    Picture8 picture(Style style = Style::as_seen);
    /// Into the folder that $ASTROSPLAT_GUI_PICTURES names, when it names one.
    void keep_screen(const std::string& name);

    Document document;
    ViewState view;
    Status status;
    Gui gui;
    Commands dropped;  // given to the next frame

  private:
    ImGuiContext* context_;
    Picture8 font_, image_;
    Commands commands_;
    int width_, height_;
};

/// A document of three layers with keyframes, untitled; and the status of a window that shows it.
Document example_document();
Status example_status();

/// A window that shows them.
class ExampleWindow : public testing::Test {
  protected:
    TestWindow window{example_document()};
};

/// One unsaved edit, "Opacity of dust".
void make_edited(TestWindow& window);

QueuedJob running_job_of(const std::string& text, float progress);

std::vector<Command::Kind> kinds(const Commands& commands);

}  // namespace astrosplat
