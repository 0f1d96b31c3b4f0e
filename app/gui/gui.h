// The widgets: everything of the window but the picture (VIEWER.md). In: the document, what the person looks
// at, the viewer's status. Out: edits of the document and the view state, and commands for the viewer. No
// OpenGL.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>

#include "edit/commands.h"
#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"

namespace astrosplat {

/// Fonts, colours, spacing: once after ImGui::CreateContext. `content_scale`: of the monitor.
void apply_theme(float content_scale);

/// A rectangle of the window, px from its upper left.
struct Rect {
    float x = 0, y = 0, width = 0, height = 0;
};

/// Where things lie for a window of this size.
struct Layout {
    Rect menu, tools, viewport, panel, timeline, status;
};
Layout make_layout(const ViewState& view, float width_px, float height_px, float content_scale);

/// What mouse and keys did over the viewport this frame. px are relative to the viewport's upper left.
struct ViewportInput {
    bool hovered = false;
    glm::dvec2 mouse_px{0.0}, delta_px{0.0};
    float wheel = 0.0f;
    enum class Drag { none, orbit, pan, dolly, look, wipe } drag = Drag::none;
    bool drag_begins = false, drag_ends = false;
    bool double_click = false;
    glm::dvec3 fly{0.0};  // -1..1 right, up, forward while looking around
    double speed = 1.0;   // of flying and dragging: Shift 10, Alt 0.1
};

class Gui {
  public:
    Gui();
    ~Gui();
    /// Draws one frame of widgets, between ImGui::NewFrame and ImGui::Render.
    void draw(Document& document, ViewState& view, const Status& status, Commands& commands);
    /// Of the last draw().
    const ViewportInput& viewport_input() const;
    /// The person wants to leave: asks about unsaved changes where there are any, then sends Command::quit.
    void ask_to_quit(const Document& document);
    /// Something moves or waits (a drag, a text cursor, an open dialog): the next frame must be drawn soon.
    bool busy() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
