// Drives the side panel as a person would: mouse and keyboard frame by frame through ImGui's input, no
// window. In: a scene's text. Out: the document after what was done.
#pragma once

#include <imgui.h>

#include "gui/panel/panel.h"
#include "gui/software_draw.h"

namespace astrosplat {

/// A plane with a picture as the layer "dust"; `more` follows in its source.
inline std::string dust_scene(const std::string& more = "") {
    return "astrosplat = 1\n[[layer]]\nname = \"dust\"\n[layer.source]\n"
           "meshes = [ { mesh = \"plane\", texture = \"dust.png\" } ]\n" +
           more;
}

class PanelDriver {
  public:
    explicit PanelDriver(const std::string& toml, float width_px = 360.0f, float height_px = 3000.0f);
    ~PanelDriver();
    PanelDriver(const PanelDriver&) = delete;
    PanelDriver& operator=(const PanelDriver&) = delete;

    /// Draws `count` frames with the input as it stands.
    void frames(int count = 1);
    void move(glm::vec2 to);
    void press(int button = 0);
    void release(int button = 0);
    void click(glm::vec2 at, int button = 0);
    void double_click(glm::vec2 at);
    /// Presses, moves in `steps` frames and releases.
    void drag(glm::vec2 from, glm::vec2 by, int steps = 8);
    void type(const std::string& text);
    void tap(ImGuiKey_ key);
    /// Types the value of a key, and Enter.
    void enter(const std::string& key, const std::string& text);
    /// Clicks an item of the popup that is open. Fails the test when there is no such item.
    void choose(const std::string& item);

    /// Where the row of a key was drawn last. Fails the test when it was not.
    DrawnRow row(const std::string& key) const;
    bool has_row(const std::string& key) const;
    /// Opens every section of the tab and draws it whole.
    void show(PanelTab tab);
    /// The frame that the window gives the panel.
    GuiFrame frame() { return {document, view, status, commands, drawn_}; }
    /// The value of a key in the scene as it is.
    Value value(const std::string& key) const;

    Document document;
    ViewState view;
    Status status;
    Commands commands;
    Panel panel;
    std::string clipboard;

  private:
    std::vector<DrawnItem> drawn_;
    glm::vec2 size_;
    ImGuiContext* context_;
    Picture8 font_;
};

}  // namespace astrosplat
