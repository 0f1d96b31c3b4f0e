// What one parameter's own range cannot say: rules between parameters.
#pragma once

#include "scene/entries.h"
#include "scene/scene.h"

namespace astrosplat {

/// Throws InputError with the place of the key that was set last, or with `file`.
void check_scene(const Scene& scene, const std::string& file, const Places& places);

/// Throws InputError unless the name is [A-Za-z][A-Za-z0-9_]*.
void check_layer_name(const std::string& name, const std::string& place);

}  // namespace astrosplat
