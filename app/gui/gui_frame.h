// Arguments of every part of the window for one frame, and the few things all parts do: ask for something,
// edit without letting an error out, say where a control lies and how many splats there are.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>

#include "edit/document.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gui/widgets.h"
#include "scene/reference_place.h"

namespace astrosplat {

/// Mouse and keyboard over the viewport in this frame. px are relative to the viewport's upper left.
struct ViewportInput {
    bool hovered = false;
    glm::dvec2 mouse_px{0.0}, delta_px{0.0};
    float wheel = 0.0f;
    enum class Drag {
        none,
        orbit,
        pan,
        dolly,
        look,
        wipe,
        place,
        handle,
        lying,
        path,
        select
    } drag = Drag::none;
    bool drag_begins = false, drag_ends = false;
    bool double_click = false;
    /// The left button was pressed and let go in one place: `behind` with Ctrl, or in the place of
    /// the last one.
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

/// One row of a parameter in the side panel of the last frame: the middle of each of its parts, window px.
/// For tests and for a driver that wants to reach a control by its key.
struct DrawnRow {
    std::string key;           // full: "layer.dust.look.alpha.power"
    glm::vec2 label, value;    // the first box of several
    glm::vec2 diamond{-1.0f};  // (-1, -1) where it cannot be animated
};

struct GuiFrame {
    Document& document;
    ViewState& view;
    const Status& status;
    Commands& requested;  // completed by CommandFlow: files asked for, unsaved changes saved or not
    std::vector<DrawnItem>& drawn;
};

void request(GuiFrame& frame, Command::Kind kind, std::size_t index = 0);
void request_path(GuiFrame& frame, Command::Kind kind, const fs::path& path);
void request_text(GuiFrame& frame, Command::Kind kind, const std::string& text, std::size_t index = 0);

/// Runs an edit; bad input becomes a line of the message bar and the scene stays as it was.
void try_edit(const std::function<void()>& edit);

/// A gesture that no other drag has.
Gesture new_gesture();

/// The edits of one drag: one undo step, which Escape takes back.
class DragEdit {
  public:
    void begin(const Document& document);
    Gesture gesture() const { return gesture_; }
    /// The scene when it began.
    const Scene& before() const { return before_; }
    /// Escape was pressed: the scene is again as it was, and the drag is over.
    bool taken_back(GuiFrame& frame) const;

  private:
    Scene before_;
    Gesture gesture_ = 0;
};

/// Remembers where ImGui's last item lies, under a name ("File/Open...").
void note_item(GuiFrame& frame, const std::string& name);
void note_item(GuiFrame& frame, const std::string& name, glm::vec2 middle_px);

/// An item of an open menu, remembered as "PREFIX/label". True when chosen.
bool noted_menu_item(GuiFrame& frame, const std::string& prefix, const char* label, bool checked = false,
                     bool enabled = true);

struct DragField {
    const char* name;  // remembered
    float speed;       // per px
    float low, high;
    const char* format;
    float width;  // px at scale 1
    unsigned ink;
    const char* says;
};
/// A field that is dragged, or typed into after a double click. True when it changed the value.
bool drag_field(GuiFrame& frame, float& value, const DragField& field);

/// Buttons joined to one row `height` px high at scale 1, of which one is lit, remembered as "PREFIX/label":
/// returns the one clicked, else -1.
int segmented(GuiFrame& frame, const std::string& prefix, std::initializer_list<Segment> segments, int chosen,
              float height);

/// Three digits at most, thousands as k, M, G: "340", "1.2 k", "12.4 M". `count` >= 0.
std::string short_count(std::int64_t count);
/// "2.9 M splats", "1 splat".
std::string splat_count(std::int64_t count);

}  // namespace astrosplat
