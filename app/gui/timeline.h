// The timeline: ruler and playhead, the keys of every animated parameter, the graph of one of them. In: the
// scene's tracks. Out: the frame looked at, and edits of the tracks.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gui/gui_frame.h"

struct ImDrawList;

namespace astrosplat {

/// Frames along the ruler: `first` lies at x0, `last` at x1.
struct TimeScale {
    double first = 1.0, last = 240.0;
    float x0 = 0.0f, x1 = 1.0f;  // px

    float x_of(double frame) const {
        return x0 + static_cast<float>((frame - first) / (last - first)) * (x1 - x0);
    }
    double frame_at(float x) const {
        return first + (last - first) * static_cast<double>(x - x0) / (x1 - x0);
    }
};

/// Distance of ruler numbers in frames (1, 2, 5, 10, ...) that leaves them at least `least_px` apart.
double ruler_step(const TimeScale& scale, float least_px);

/// "dust: Power", "Camera: Position".
std::string track_label(const std::string& key, const ParameterSpec& spec);

class Timeline {
  public:
    void draw(GuiFrame& frame, const Rect& area);
    /// A key or the playhead is being dragged.
    bool busy() const { return drag_ != Drag::none; }

  private:
    struct KeyPlace {
        std::string key;
        double frame = 0.0;
        bool operator==(const KeyPlace&) const = default;
    };
    enum class Drag { none, scrub, keys, box, value };

    // timeline.cpp
    void refresh(const Document& document);
    void draw_header(GuiFrame& frame, const Rect& area);
    void draw_ruler(GuiFrame& frame, const Rect& area);
    void draw_playhead(const GuiFrame& frame, const Rect& ruler);
    void draw_playhead_line(const GuiFrame& frame, const Rect& area);
    void zoom_with_wheel(const Rect& area);
    void end_drag();
    float names_width(const ViewState& view) const;

    // timeline_rows.cpp
    void draw_rows(GuiFrame& frame, const Rect& area);
    void draw_name(GuiFrame& frame, const Track& track, float x, float y, float width);
    void draw_keys(GuiFrame& frame, const Track& track, float y);
    void handle_rows_mouse(GuiFrame& frame, const Rect& keys);
    void press_key(GuiFrame& frame, const KeyPlace& place);
    void drag_keys(GuiFrame& frame);
    void select_in_box(const Scene& scene, float rows_y);
    const KeyPlace* key_under_mouse(const Scene& scene, float rows_y);
    bool is_selected(const KeyPlace& place) const;

    // timeline_menu.cpp
    void remove_selected(GuiFrame& frame);
    void draw_key_menu(GuiFrame& frame);

    // timeline_graph.cpp
    void draw_graph(GuiFrame& frame, const Rect& area);
    void sample_graph(const Track& track, const ParameterSpec& spec, std::uint64_t revision);
    void draw_graph_keys(GuiFrame& frame, const Track& track, const Rect& area);
    void drag_value(GuiFrame& frame, const Track& track, const Rect& area);
    float y_of(double value, const Rect& area) const;

    TimeScale scale_;
    FrameRange fitted_;                           // range the scale was fitted to
    bool zoomed_ = false;                         // by hand: a new range does not refit
    std::uint64_t revision_ = 0;                  // of specs_
    std::map<std::string, ParameterSpec> specs_;  // of the tracks' parameters

    std::vector<KeyPlace> selected_;
    KeyPlace found_;  // by key_under_mouse
    Drag drag_ = Drag::none;
    Gesture gesture_ = 0;
    std::vector<Track> before_;          // animation when the drag began
    std::vector<KeyPlace> picked_;       // selection then
    double grabbed_frame_ = 0.0;         // under the mouse then
    double moved_ = 0.0;                 // frames so far
    float box_x_ = 0.0f, box_y_ = 0.0f;  // corner where the selecting box began

    struct Graph {
        std::string key;
        std::uint64_t revision = 0;
        TimeScale scale;
        std::vector<std::vector<double>> samples;  // [component][sample], evenly from scale.x0 to scale.x1
        double low = 0.0, high = 1.0;              // of the plot
        double grabbed_key = 0.0;                  // frame of the dragged key
        std::size_t component = 0;
    };
    Graph graph_;
};

}  // namespace astrosplat
