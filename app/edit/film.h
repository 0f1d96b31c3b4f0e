// A scene of one frame that may become a film. In: the scene before and after an edit. Out: the frames of
// [output] of the one after.
#pragma once

#include "scene/scene.h"

namespace astrosplat {

/// Frames of ten seconds: how long a film is that nobody chose a length for.
double film_frames(const OutputParams& output);

/// A still's first keyframe at a later frame makes it a film of film_frames(), or up to that keyframe.
/// Changes nothing where the edit itself chose frames, or where keyframes lay elsewhere before it.
void film_still(const Scene& before, Scene& after);

}  // namespace astrosplat
