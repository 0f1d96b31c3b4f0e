// The window as its users meet it: the program on a screen of its own, a quick scene in a folder of its own,
// and the places of its controls, asked of the same widgets drawn in the test.
#pragma once

#include <csignal>

#include "gui/panel/panel.h"
#include "gui/test_window.h"
#include "scene/load.h"
#include "support/run_program.h"
#include "window/person.h"
#include "window/screen.h"

namespace astrosplat::test {

/// Asks again and again, for longer than the slowest machine needs. False: it never came.
template <class Condition>
bool comes_true(const Condition& condition) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::minutes(5);
    do {
        if (condition()) return true;
        usleep(20'000);
    } while (Clock::now() < end);
    return condition();
}

/// A quick scene of one layer with keyframes of the camera at frames 1 and 24, and a home for the program.
class ViewerTest : public FolderTest {
  protected:
    static constexpr int width = 1280, height = 900;  // px of screen and window

    ViewerTest();
    /// Of an untouched window.
    static Layout layout() { return make_layout(ViewState(), width, height, 1.0f); }
    /// Environment of the program: no home but the test's, no desktop's file dialog.
    virtual RunOptions options() const;
    RunResult run(std::vector<std::string> arguments) const;
    Scene saved() const { return load_scene(scene_file); }
    /// In the file of the scene.
    void replace_in_scene(const std::string& part, const std::string& by) const {
        write_text(scene_file, replaced(text_of(scene_file), part, by));
    }

    fs::path scene_file;
};

class WindowTest : public ViewerTest {
  protected:
    ~WindowTest() override;
    /// Skips the test where Xvfb or xdotool are missing.
    void SetUp() override;

    /// Starts the program in the test's folder and waits for its window.
    void start(std::vector<std::string> arguments);
    void start() { start({scene_file.string(), "--no-cache"}); }
    /// Starts it, and its first final frame.
    Pixels start_settled() {
        start();
        return settled_frame();
    }
    /// Sends the signal, where given, and waits for the end.
    RunResult end(int signal = 0);
    bool running() const;
    /// With the screen, and what start() is to add.
    RunOptions options() const override;

    std::string title() const { return screen->title(); }
    /// Waits for this title: the scene's name, and whether it is edited.
    void expect_title(const std::string& begin);
    /// By its shortcut, until the title says so.
    void save() {
        person->press("ctrl+s");
        expect_title("scene.toml");
    }
    /// The viewport without its badge.
    Pixels frame_pixels() const;
    /// The badge says that the picture is final.
    bool settled(const ViewState& parts = {}) const;
    /// The next final frame other than `before`; fails the test where none comes.
    Pixels settled_frame(const Pixels& before = {});
    /// Waits for this very picture to be final.
    void expect_settled(const Pixels& expected);

    Pixels pixels_of(Rect Layout::*part) const;

    /// The widgets as the program should show them now; a test brings document, view and status to where the
    /// person has brought them.
    TestWindow& same_widgets();
    glm::vec2 value_box(const std::string& key);
    glm::vec2 diamond(const std::string& key);
    /// Waits until the window shows the widgets' control of this name, and clicks it.
    void click_when_shown(const std::string& name);
    /// The longest frame there can be: the program does nothing until go_on().
    void stop() { program->signal(SIGSTOP); }
    void go_on() { program->signal(SIGCONT); }
    /// Clicks menu after menu of "Render/Cancel".
    void choose(const std::string& path);

    std::optional<Screen> screen;
    std::optional<Person> person;
    std::vector<std::string> environment;  // more of it: NAME=VALUE
    std::unique_ptr<RunningProgram> program;

  private:
    DrawnRow row(const std::string& key);
    bool shows(const Picture8& widgets, glm::vec2 middle) const;
    std::optional<TestWindow> widgets_;
};

inline const std::string power = "layer.disc.look.alpha.power";

/// A picture of one colour, opaque.
void write_plain(const fs::path& file, int width, int height, const std::array<unsigned char, 3>& rgb);

/// A picture of soft rings, 64x64 px, of which no two quarters are alike.
void write_rings(const fs::path& file);

}  // namespace astrosplat::test
