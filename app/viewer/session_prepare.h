// The prepared picture of the selected layer, small, for the panel's section of that name.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Works towards it while the section is open, and tells the widgets how far it is. With OpenGL's context.
void show_preparation(Session& session);

}  // namespace astrosplat
