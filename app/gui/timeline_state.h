// State of the timeline between frames: the frames it shows, the selected keyframes, the drag at hand. Its
// parts (header and ruler, rows, graph, menu) all work on it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "edit/keyframes.h"
#include "gui/gui_frame.h"

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

inline constexpr float timeline_margin = 16;  // px at scale 1, at both ends of the frames

/// One keyframe of a track.
struct KeyframePlace {
    std::string key;
    double frame = 0.0;
    bool operator==(const KeyframePlace&) const = default;
};

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
    Gesture gesture = 0;
    std::vector<Track> before;          // animation when the drag began
    std::vector<KeyframePlace> picked;  // selection then
    double grabbed_frame = 0.0;         // under the mouse then
    double moved = 0.0;                 // frames so far
    float box_x = 0.0f, box_y = 0.0f;   // corner where the selecting box began

    bool typing_frames = false;  // into the header's range
    std::string typed_frames;

    struct Graph {
        std::string key;
        std::uint64_t revision = 0;
        TimeScale scale;
        std::vector<std::vector<double>> samples;  // [component][sample], evenly from scale.x0 to scale.x1
        double low = 0.0, high = 1.0;              // of the plot
        double grabbed_keyframe = 0.0;             // frame of the dragged keyframe
        std::size_t component = 0;
        HandleSide side = HandleSide::out;  // of the dragged handle
        bool zoomed = false;                // values by hand: they do not follow the curve
        std::vector<bool> hidden;           // channels that the samples' range leaves out
        bool edited = false;                // the drag at hand has changed the scene
    };
    Graph graph;
};

/// Frames zoomed about one of them; `factor` below 1 shows fewer.
void zoom_frames(TimelineState& t, double middle, double factor);

bool is_selected(const TimelineState& t, const KeyframePlace& place);
/// As a press selects it: alone, unless it is one of several; with Shift it is added or taken away.
void select_keyframe(TimelineState& t, const KeyframePlace& place);

}  // namespace astrosplat
