// Rules that every edit keeps: a scene can be saved and read again, values that depend on the edited ones
// follow, and what a drag makes has no digits that nobody chose. In: the scene after an edit, and before it.
// Out: the scene, or an error in one line.
#pragma once

#include <fmt/format.h>

#include <string>

#include "core/error.h"
#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// What `act` returns. A ValueError becomes an InputError, which names the parameter.
template <class Act>
auto naming(const ParameterKey& key, const Act& act) {
    try {
        return act();
    } catch (const ValueError& error) {
        throw InputError(fmt::format("{}: {}", key, error.what()));
    }
}

/// Takes out tracks whose parameter is gone (a noise entry or layer that was removed), then checks everything
/// that loading the saved scene would check. Throws InputError; `name` begins the messages that have no
/// better place.
void check_edited_scene(Scene& scene, const std::string& name);

/// Writes the values of the scene's output.preset, of [output] and [camera], into the scene; nothing where it
/// names none. Throws InputError.
void apply_output_preset(Scene& scene);

/// Makes the frame of a dome master square again where one side of it was changed, by that side.
void keep_dome_square(Scene& scene, const Scene& before);

/// Frames of ten seconds: how long a film is that nobody chose a length for.
double film_frames(const OutputParams& output);

/// A still's first keyframe at a later frame makes it a film of film_frames(), or up to that keyframe.
/// Changes nothing where the edit itself chose frames, or where keyframes lay elsewhere before it.
void film_still(const Scene& before, Scene& after);

/// `value` without the digits that a step this small cannot mean.
double rounded_to_step(double value, double step);

}  // namespace astrosplat
