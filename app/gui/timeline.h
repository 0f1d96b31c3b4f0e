// The timeline: ruler and playhead, the keyframes of every animated parameter, the graph of one of them. In:
// the scene's tracks. Out: the frame looked at, and edits of the tracks.
#pragma once

#include <map>

#include "edit/edits.h"
#include "gui/gui_frame.h"
#include "scene/parameter.h"

namespace astrosplat {

/// Frames along the ruler: `first` lies at x0, `last` at x1.
struct TimeScale {
    double first = 1.0, last = 240.0;
    float x0 = 0.0f, x1 = 1.0f;  // px
    bool operator==(const TimeScale&) const = default;

    float x_of(double frame) const {
        return x0 + static_cast<float>((frame - first) / (last - first)) * (x1 - x0);
    }
    double frame_at(float x) const {
        return first + (last - first) * static_cast<double>(x - x0) / (x1 - x0);
    }
};

inline constexpr float timeline_margin = 16;  // px at scale 1, at both ends of the frames

/// One keyframe of a track.
struct KeyframePlace {
    std::string key;
    double frame = 0.0;
    bool operator==(const KeyframePlace&) const = default;
};

/// State kept between frames of the window: the frames shown, the selected keyframes, the drag at hand.
struct TimelineState {
    TimeScale scale;
    FrameRange fitted;                           // range the scale was fitted to
    bool zoomed = false;                         // by hand: a new range does not refit
    std::uint64_t revision = 0;                  // of specs
    std::map<std::string, ParameterSpec> specs;  // of the tracks' parameters

    Gesture rate_gesture = 0;  // of the drag or the typing of the rate

    std::vector<KeyframePlace> selected;
    enum class Drag {
        none,
        scrub,
        in_point,
        out_point,
        keyframes,
        box,
        value,
        handle,
        pan
    } drag = Drag::none;
    DragEdit edit;
    std::vector<KeyframePlace> picked;  // selection then
    double grabbed_frame = 0.0;         // under the mouse then
    double moved = 0.0;                 // frames so far
    float box_x = 0.0f, box_y = 0.0f;   // corner where the selecting box began

    bool typing_frames = false;  // into the header's range
    std::string typed_frames;

    struct Graph {
        struct Of {
            std::string key;
            std::uint64_t revision = 0;  // of the document
            TimeScale scale;
            std::vector<bool> hidden;  // channels that the samples' range leaves out
            bool operator==(const Of&) const = default;
        } of;
        std::vector<std::vector<double>> samples;  // [component][sample], evenly from scale.x0 to scale.x1
        double low = 0.0, high = 1.0;              // of the plot
        double grabbed_keyframe = 0.0;             // frame of the dragged keyframe
        std::size_t component = 0;
        HandleSide side = HandleSide::out;  // of the dragged handle
        bool zoomed = false;                // values by hand: they do not follow the curve
    };
    Graph graph;
};

void draw_timeline(TimelineState& t, GuiFrame& frame, const Rect& area);

/// How far the scene's camera is from what it looks at, and where it moves how fast: "target at 14.2 scene
/// units, 35.8 kly; 2.5 kly/s"; nothing where the scene does not know how long a unit is. `box`: of the
/// visible layers, which a camera without a position frames.
std::string distance_text(const Scene& scene, double frame, const Bounds& box);

/// Of a move of the mouse's wheel: below 1 where less is to be shown.
double zoom_of(float wheel);
/// Frames zoomed about one of them; `factor` below 1 shows fewer.
void zoom_frames(TimelineState& t, double middle, double factor);

bool is_selected(const TimelineState& t, const KeyframePlace& place);
/// As a press selects it: alone, unless it is one of several; with Shift it is added or taken away.
void select_keyframe(TimelineState& t, const KeyframePlace& place);

// The parts below the ruler: the rows of keyframes, one for every animated parameter, and the graph of one of
// them in their place, with its channels.

/// The graph of the parameter ViewState::graph_parameter, else of the first one animated.
void draw_graph(TimelineState& t, GuiFrame& frame, const Rect& area);

/// x, y, z, w or r, g, b: easily distinguished, but muted. A lone channel has the text's.
unsigned channel_color(std::size_t channel, std::size_t count);
bool channel_hidden(const ViewState& view, const Track& track, std::size_t channel);

/// Width in px of the letters that draw_channels draws.
float channels_width(const Track& track);
/// A letter each, clicked to hide and show it; with Shift it alone is shown, or all again.
void draw_channels(GuiFrame& frame, const Track& track, const ParameterSpec& spec, float x, float y,
                   float height);

/// Width in px at the left of the keyframes and of the graph.
float names_width(const ViewState& view);
void draw_rows(TimelineState& t, GuiFrame& frame, const Rect& area);

}  // namespace astrosplat
