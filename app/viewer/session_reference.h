// The session's reference aligned to the view, from the wish to the edit of the scene.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Starts it with what the view shows now. With OpenGL's context. Throws InputError where there is nothing to
/// align yet.
void begin_alignment(Session& session);

/// Places the reference where that was found, or says that it was not.
void take_alignment(Session& session);

}  // namespace astrosplat
