// The right side panel: layers list, tabs, one row per parameter, plots. In: the document, what the person
// looks at, the viewer's status. Out: edits of the document and the view state, commands for the viewer, and
// wishes for a parameter's file. Everything about a parameter comes from its description. No OpenGL.
#pragma once

#include <filesystem>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/gui_frame.h"

namespace astrosplat {

namespace panel {
struct Memory;  // context.h
}

class Panel {
  public:
    Panel();
    ~Panel();
    /// Draws over the content region of the current ImGui window, between NewFrame and Render.
    void draw(const GuiFrame& frame);

    /// The parameter that a file was asked for since the last call.
    std::optional<ParameterKey> take_request();
    /// The dialog's answer: an edit of the document.
    void answer(const ParameterKey& key, const std::filesystem::path& file, const GuiFrame& frame);

    /// Unfolds every section, as a person could one by one.
    void open_all();
    /// Of the last draw(), top to bottom.
    const std::vector<DrawnRow>& rows() const;
    /// Where the last draw() showed the plot that edits a key: x, y, width, height; zeros: it did not.
    glm::vec4 plot_area(const std::string& key) const;
    /// Why the last edit was refused; empty when it was not.
    const std::string& message() const;
    /// A value is being dragged or typed: the next frame must be drawn soon.
    bool busy() const;

  private:
    std::unique_ptr<panel::Memory> memory_;
};

}  // namespace astrosplat
