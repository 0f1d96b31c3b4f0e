// The widgets: everything of the window but the frame. In: the document, the view state, the viewer's status.
// Out: edits of the document and the view state, and commands for the viewer. No OpenGL.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "edit/commands.h"
#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gui/layout.h"

namespace astrosplat {

/// Fonts, colours, spacing: once after ImGui::CreateContext. `content_scale`: of the monitor; `contrast` as
/// set_contrast() has it.
void apply_theme(float content_scale, int contrast = 0);

/// Mouse and keyboard over the viewport in this frame. px are relative to the viewport's upper left.
struct ViewportInput {
    bool hovered = false;
    glm::dvec2 mouse_px{0.0}, delta_px{0.0};
    float wheel = 0.0f;
    enum class Drag { none, orbit, pan, dolly, look, wipe, place, handle, path } drag = Drag::none;
    bool drag_begins = false, drag_ends = false;
    bool double_click = false;
    /// The left button was pressed and let go in one place: `behind` with Ctrl, or in the place of the last
    /// one.
    enum class Click { none, in_front, behind } click = Click::none;
    glm::dvec3 fly{0.0};  // -1..1 right, up, forward while looking around
    double speed = 1.0;   // of flying: Shift 10, Alt 0.1; 1 in other drags
};

/// A control of the last frame and the middle of it, px of the window: for tests and for a driver that wants
/// to reach one by its name.
struct DrawnItem {
    std::string name;  // "File/Open...", "play", "keyframe camera.position 12"
    glm::vec2 middle;
};

class Panel;

class Gui {
  public:
    Gui();
    ~Gui();
    /// Draws one frame of widgets, between ImGui::NewFrame and ImGui::Render. Commands come out complete:
    /// where a path was missing a dialog has asked for it, and where unsaved changes would be lost the person
    /// has agreed. Commands already in the list (dropped files) are asked about in the same way.
    void draw(Document& document, ViewState& view, const Status& status, Commands& commands);
    /// Of the last draw().
    const ViewportInput& viewport_input() const;
    /// The person wants to leave: asks about unsaved changes where there are any, then sends Command::quit.
    void ask_to_quit(const Document& document);
    /// Something moves or waits (a drag, a text cursor, an open dialog): the next frame must be drawn soon.
    bool busy() const;
    /// An entry, a menu or a dialog is open in which nothing is typed: its focus may be on the way.
    bool opening() const;
    /// Controls of the last draw(), those of the side panel excepted (Panel::rows).
    const std::vector<DrawnItem>& drawn_items() const;
    const Panel& panel() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
