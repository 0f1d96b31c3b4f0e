// The right side panel: layers list, tabs, one row per parameter, plots. In: the document, what the person
// looks at, the viewer's status. Out: edits of the document and the view state, commands for the viewer, and
// wishes for a parameter's file. Everything about a parameter comes from its description; writing goes
// through the document, so that a widget never holds a value of its own for longer than a drag. No OpenGL.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat {

class Panel {
  public:
    /// Draws over the content region of the current ImGui window, between NewFrame and Render.
    void draw(const GuiFrame& frame);

    /// The parameter that a file was asked for since the last call.
    std::optional<ParameterKey> take_request() { return std::exchange(memory_.request, std::nullopt); }
    /// The dialog's answer: an edit of the document.
    void answer(const ParameterKey& key, const fs::path& file, const GuiFrame& frame);

    /// Those of the scene and of the selected layer that have an effect, as of the last draw().
    std::vector<const Parameter*> shown_parameters(const GuiFrame& frame) const;
    /// In the next draw() its tab is there, its section unfolded, and its field has the ring.
    void show(const ParameterKey& key, ViewState& view);

    /// Unfolds every section, as a person could one by one.
    void open_all() { memory_.all_open = true; }
    /// Of the last draw(), top to bottom.
    const std::vector<DrawnRow>& rows() const { return memory_.rows; }
    /// Where the last draw() showed the plot that edits a key: x, y, width, height; zeros: it did not.
    glm::vec4 plot_area(const std::string& key) const;
    /// Why the last edit was refused; empty when it was not.
    const std::string& message() const { return memory_.error; }
    /// A value is being dragged or typed: the next frame must be drawn soon.
    bool busy() const;
    /// What show() was asked for gets the ring in the next frame.
    bool awaits_ring() const { return !memory_.wanted.empty(); }

  private:
    panel::Memory memory_;
};

}  // namespace astrosplat
