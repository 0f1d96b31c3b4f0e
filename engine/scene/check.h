// Rules between parameters, which one parameter's own range cannot say.
#pragma once

#include "scene/parameter_key.h"
#include "scene/scene.h"

namespace astrosplat {

/// Throws InputError with the place of the key that was set last, or with `file`.
void check_scene(const Scene& scene, const std::string& file, const Places& places);

/// Throws InputError, with the place of the key, for what this release reads and keeps but cannot render:
/// stars along a camera without a place, splat files of other kinds. Layers that are never visible
/// are left out.
void check_renderable(const Scene& scene, const Places& places);

/// Whether frames are dome masters: of the preset of this name, one of one's own included.
bool is_dome(const OutputParams& output);

/// A key of a group whose value cannot stand, and "expected ..., found ...".
struct KeyProblem {
    std::string key, message;
};
/// Rules that a scene and the command `prepare` share.
std::optional<KeyProblem> problem_of(const PrepareParams& prepare);

/// Throws InputError unless the name is [A-Za-z][A-Za-z0-9_]*.
void check_layer_name(const std::string& name, const std::string& place);

}  // namespace astrosplat
