// Plots: a field with a histogram and a curve in it, which may be dragged, captions below. In: values.
// Out: lines, and edits of a curve's points.
#pragma once

#include <span>
#include <vector>

#include "gui/panel/controls.h"

namespace astrosplat::panel {

inline constexpr float plot_height = 84.0f;  // px at scale 1

/// The next plot's area across the panel; draws its ground.
Rect begin_plot(float height = plot_height);

/// Bars over [0, 1] of the width; `stretch` widens the bins' own range: bin i covers
/// [i, i + 1] * stretch / count. Shares of the fullest bin.
void draw_bars(const Rect& area, std::span<const float> shares, double stretch = 1.0);

/// A line through values spread evenly over `stretch` of the width; 0 is the bottom, `top` the upper edge.
void draw_curve(const Rect& area, std::span<const float> values, float top, ImU32 color,
                float stretch = 1.0f);

/// A plot of the curve whose points the parameter `key` holds: click adds, drag moves, right click deletes,
/// arrows nudge. `samples` is the curve itself, over x in 0..1. The area takes the mouse.
void edit_curve(Context& context, const ParameterKey& key, const Rect& area, std::span<const float> samples);

/// Small texts below a plot, at its left and right edge. Leaves the cursor below.
void captions(const std::string& left, const std::string& right);

}  // namespace astrosplat::panel
