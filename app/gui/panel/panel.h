// The right side panel (VIEWER.md): layers list, tabs, one row per parameter, plots. In: the document, what
// the person looks at, the viewer's status. Out: edits of the document and the view state, and commands for
// the viewer. Everything about a parameter comes from its description. No OpenGL.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "edit/commands.h"
#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"

namespace astrosplat {

/// One parameter drawn by the last draw(): where its parts lie, window px. For tests and for a driver that
/// wants to reach a control by its key.
struct DrawnRow {
    std::string key;                  // full: "layer.dust.look.alpha.power"
    glm::vec2 label, value, diamond;  // middle of each; diamond is (-1, -1) where it cannot be keyed
};

class Panel {
  public:
    Panel();
    ~Panel();
    /// Draws over the content region of the current ImGui window, between NewFrame and Render.
    void draw(Document& document, ViewState& view, const Status& status, Commands& commands);
    /// Of the last draw(), top to bottom.
    const std::vector<DrawnRow>& rows() const;
    /// A value is being dragged or typed: the next frame must be drawn soon.
    bool busy() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
