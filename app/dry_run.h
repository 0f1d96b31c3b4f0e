// --batch --dry-run: what would be done, and what it would take. In: a plan. Out: lines on stdout, and
// nothing else.
#pragma once

#include "batch_plan.h"

namespace astrosplat {

/// Frames, layers, memory, time and bytes, then a line a frame. Throws as SampledRun and estimate do.
void print_plan(const BatchPlan& plan);

}  // namespace astrosplat
