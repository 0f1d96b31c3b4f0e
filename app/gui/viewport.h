// The frame and what belongs to it: gate, badge, wipe handle, and the mouse over it, which moves the camera
// or what else can be dragged there. In: the frame's texture and how far it is. Out: ViewportInput for the
// viewer's camera; edits of the scene, one undo step a drag, which Escape takes back.
#pragma once

#include <glm/vec3.hpp>

#include "edit/edits.h"
#include "edit/lying.h"
#include "edit/placement.h"
#include "edit/selection.h"
#include "gui/gui_frame.h"
#include "scene/reference_place.h"

namespace astrosplat {

/// The reference picture placed by hand: the inside moves it, a corner scales it, the outside (or Shift)
/// turns it, the wheel scales it about the mouse.
class ReferencePlacing {
  public:
    /// The left button went down over the view; `frame_px` in px of the window.
    void press(const GuiFrame& frame, const FrameOnScreen& frame_px, bool turn);
    /// A frame of the mouse. Takes the wheel out of `input`.
    void read(GuiFrame& frame, const FrameOnScreen& frame_px, ViewportInput& input);

  private:
    PlaceGrip grip_ = PlaceGrip::move;
    ReferenceParams pressed_;  // as it was
    glm::dvec2 pressed_px_{0.0};
    Gesture gesture_ = 0, wheel_gesture_ = 0;
    double wheeled_at_ = -1.0;  // seconds
};
/// The view's reference is seen and being placed.
bool places_reference(const GuiFrame& frame);
/// Its outline and corners, in px of the window.
void draw_placing(const GuiFrame& frame, const FrameOnScreen& frame_px);

/// Handles that move, turn and scale the selected layer, one of its crops or the camera's target.
class Handles {
  public:
    /// The left button went down at a place of the viewport, px: true where that is on a handle.
    bool press(const GuiFrame& frame, const glm::dvec2& mouse_px);
    /// A frame of the mouse; `dragged`: the button that was pressed on a handle is still down.
    void read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged);
    void draw(const GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px) const;

  private:
    HandleDrag drag_;
    Scene pressed_at_frame_;  // as it stood at the frame
    Camera camera_;           // through which it was pressed
    DragEdit edit_;
};

/// How the bodies of the selected layer's picture lie: a ring with handles, while a picture's card is open,
/// one of the rows that say it is under the mouse, or it is asked for.
class LyingHandles {
  public:
    /// As Handles has it.
    bool press(const GuiFrame& frame, const glm::dvec2& mouse_px);
    void read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged);
    void draw(GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px) const;

  private:
    LyingGrip grip_;
    LyingRing pressed_;
    glm::dvec2 from_px_{0.0}, to_px_{0.0};
    Camera camera_;  // through which it was pressed
    DragEdit edit_;
};

/// Lasso, box and brush, while ViewState::select: a drag with the left button takes that part of the selected
/// layer, one undo step; Escape drops what is being drawn.
class Selecting {
  public:
    /// As Handles has it.
    bool press(const GuiFrame& frame, const glm::dvec2& mouse_px);
    void read(GuiFrame& frame, const glm::dvec2& mouse_px, bool dragged);
    /// What is being drawn, and the brush under the mouse.
    void draw(const GuiFrame& frame, const Rect& area, const glm::dvec2& mouse_px, bool hovered) const;

  private:
    DrawnLine drawn() const;
    std::vector<glm::dvec2> points_;  // px of the viewport; none: nothing is being drawn
    SelectTool tool_ = SelectTool::none;
    double radius_px_ = 0.0, feather_px_ = 0.0;
    Camera camera_;             // through which it is drawn
    std::string layer_;         // what it is drawn over
    LayerPlacement placement_;  // of that, when it began
};
/// At the view's top, while ViewState::select: the tool, what becomes of what it takes, and the brush.
void draw_select_bar(GuiFrame& frame, const Rect& area);

/// A keyframe of the camera's position, or one of its handles.
struct PathGrip {
    double frame = 0.0;
    std::optional<HandleSide> side;  // none: the keyframe itself
    bool operator==(const PathGrip&) const = default;
};

/// The keyframes of the camera's position as points on its path, in views other than the camera's, with the
/// handles of Bezier ones: dragged in the plane of the view, with Shift along its axis.
class PathPoints {
  public:
    /// Takes the point or handle under the mouse, if there is one. `area` is the viewport's.
    bool press(GuiFrame& frame, const Rect& area);
    /// While the button is held.
    void drag(GuiFrame& frame);
    /// A point that was not moved shows its frame.
    void release(GuiFrame& frame);
    void draw(GuiFrame& frame, const Rect& area) const;

  private:
    struct Place {
        PathGrip grip;
        glm::dvec3 point;    // world
        double frames;       // of a handle
        glm::vec2 px, from;  // on the screen, with its keyframe's
    };
    static std::vector<Place> places(const GuiFrame& frame, const Rect& area);
    static const Place* nearest(const std::vector<Place>& places);

    std::optional<PathGrip> held_;
    glm::dvec3 pressed_at_{0.0}, moved_{0.0};  // world
    double frames_ = 0.0;                      // of the held handle
    DragEdit edit_;
};

class Viewport {
  public:
    void draw(GuiFrame& frame, const Rect& area);
    const ViewportInput& input() const { return input_; }

  private:
    void draw_movie(GuiFrame& frame, const Rect& area);
    void read_mouse(GuiFrame& frame, const Rect& area, const Rect& frame_area);
    void begin_drag(GuiFrame& frame, const Rect& area, const Rect& frame_area);
    void move_frame(GuiFrame& frame, const Rect& area);
    void read_click();

    ViewportInput input_;
    ReferencePlacing placing_;
    Handles handles_;
    LyingHandles lying_;
    Selecting selecting_;
    PathPoints path_points_;
    int button_ = -1;              // that began the drag
    bool moves_frame_ = false;     // 1:1: a pan stays in the window
    bool may_click_ = false;       // the button that is down began nothing else
    glm::dvec2 clicked_px_{-1e9};  // where the last click was
};

/// Which drag a press of this mouse button (ImGuiMouseButton) begins.
ViewportInput::Drag drag_of(int button, bool shift, bool alt);

}  // namespace astrosplat
