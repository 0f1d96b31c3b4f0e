// A curve whose points are edited in its plot.
#pragma once

#include <span>

#include "gui/panel/row.h"

namespace astrosplat::panel {

/// A plot of the curve whose points the parameter `key` holds: click adds, drag moves, right click deletes,
/// arrows nudge. `samples` is the curve itself, over x in 0..1. The area takes the mouse.
void edit_curve(Context& context, const ParameterKey& key, const Area& area, std::span<const float> samples);

}  // namespace astrosplat::panel
