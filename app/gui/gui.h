// The widgets: everything of the window but the picture (VIEWER.md). In: the document, what the person looks
// at, the viewer's status. Out: edits of the document and the view state, and commands for the viewer. No
// OpenGL.
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

namespace astrosplat {

/// Fonts, colours, spacing: once after ImGui::CreateContext. `content_scale`: of the monitor.
void apply_theme(float content_scale);

/// A rectangle of the window, px from its upper left.
struct Rect {
    float x = 0, y = 0, width = 0, height = 0;
};

/// Where things lie for a window of this size. What is hidden has no height or width.
struct Layout {
    Rect menu, tools;
    Rect notice;  // one line under the tools: the hint, or that the file changed on disk
    Rect viewport;
    Rect snapshots;  // strip between viewport and timeline
    Rect panel, timeline, status;
};
Layout make_layout(const ViewState& view, float width_px, float height_px, float content_scale);

/// Where a picture of this size is shown, px of the window. Fit: as large as the viewport allows, in its
/// middle; 1:1: zoomed and moved as `view` says. It may reach beyond the viewport.
Rect place_picture(const ViewState& view, const Rect& viewport, int width_px, int height_px);

/// What mouse and keys did over the viewport this frame. px are relative to the viewport's upper left.
struct ViewportInput {
    bool hovered = false;
    glm::dvec2 mouse_px{0.0}, delta_px{0.0};
    float wheel = 0.0f;
    enum class Drag { none, orbit, pan, dolly, look, wipe } drag = Drag::none;
    bool drag_begins = false, drag_ends = false;
    bool double_click = false;
    glm::dvec3 fly{0.0};  // -1..1 right, up, forward while looking around
    double speed = 1.0;   // of flying: Shift 10, Alt 0.1; 1 in other drags
};

/// A file the person is to choose.
struct FileQuery {
    std::string title;                    // "Open a scene"
    bool saving = false;                  // the file need not exist, and is asked for again where it does
    std::string kind;                     // "Scenes", of the filter
    std::vector<std::string> extensions;  // ".toml", lower case; empty: any
    std::filesystem::path folder;         // to begin in
    std::string name;                     // suggested, when saving
};

/// A control of the last frame and the middle of it, px of the window: for tests and for a driver that wants
/// to reach one by its name.
struct DrawnItem {
    std::string name;  // "File/Open...", "play", "key camera.position 12"
    glm::vec2 middle;
};

class Panel;

class Gui {
  public:
    Gui();
    ~Gui();
    /// Draws one frame of widgets, between ImGui::NewFrame and ImGui::Render. Commands come out complete:
    /// where a path was missing a dialog has asked for it, and where unsaved changes would be lost the person
    /// has agreed.
    /// Commands already in the list (dropped files) are asked about in the same way.
    void draw(Document& document, ViewState& view, const Status& status, Commands& commands);
    /// Of the last draw().
    const ViewportInput& viewport_input() const;
    /// The person wants to leave: asks about unsaved changes where there are any, then sends Command::quit.
    void ask_to_quit(const Document& document);
    /// Something moves or waits (a drag, a text cursor, an open dialog): the next frame must be drawn soon.
    bool busy() const;
    /// An entry, a menu or a dialog is open in which nothing is typed: its focus may be on the way.
    bool opening() const;
    /// Files are chosen through `chooser` instead of the own dialog where it returns true;
    /// it must then call file_chosen later, with nothing when the person thought better of it.
    void set_file_chooser(std::function<bool(const FileQuery&)> chooser);
    void file_chosen(const std::optional<std::filesystem::path>& file);
    /// Controls of the last draw(), those of the side panel excepted (Panel::rows).
    const std::vector<DrawnItem>& drawn_items() const;
    const Panel& panel() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace astrosplat
