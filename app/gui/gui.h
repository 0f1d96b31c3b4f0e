// The widgets: everything of the window but the frame. In: the document, the view state, the viewer's status.
// Out: edits of the document and the view state, and commands for the viewer. No OpenGL.
#pragma once

#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gui/gui_frame.h"

namespace astrosplat {

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
    void ask_to_quit();
    /// Something moves or waits (a drag, a text cursor, an open dialog): the next frame must be drawn soon.
    bool busy() const;
    /// An entry, a menu or a dialog is open in which nothing is typed, or the ring moves: the focus may be on
    /// the way.
    bool opening() const;
    /// Controls of the last draw(), the rows of the side panel excepted (Panel::rows).
    const std::vector<DrawnItem>& drawn_items() const;
    const Panel& panel() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
