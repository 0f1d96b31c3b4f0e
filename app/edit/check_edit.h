// What an edit may leave behind: every value in its range, every keyframe fitting its parameter,
// the rules between parameters. In: a scene as an edit made it. Out: the scene, or an error in one line.
#pragma once

#include <string>

#include "scene/scene.h"

namespace astrosplat {

/// Takes out tracks whose parameter is gone (a noise entry or layer that was removed), then checks everything
/// that loading the saved scene would check. Throws InputError; `name` begins the messages that have no
/// better place.
void check_edited_scene(Scene& scene, const std::string& name);

}  // namespace astrosplat
