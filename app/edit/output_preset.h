// A preset of the output taken up in the window. In: a scene that names one. Out: the scene with its values.
#pragma once

#include "scene/scene.h"

namespace astrosplat {

/// What the scene's output.preset says of [output] and [camera], into the scene; nothing where it names none.
/// Throws InputError.
void apply_output_preset(Scene& scene);

/// Makes the frame of a dome master square again where one side of it was changed, by that side.
void keep_dome_square(Scene& scene, const Scene& before);

}  // namespace astrosplat
