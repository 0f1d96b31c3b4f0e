// Before and after of a picture's preparation, and the way to its files.
#pragma once

#include "gui/panel/context.h"

namespace astrosplat::panel {

/// Below the rows of the section: the two pictures with a line between them to drag, what was done, a button.
void draw_preparation(Context& context);

}  // namespace astrosplat::panel
