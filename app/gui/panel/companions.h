// Rules between parameters (engine/scene/check.h) as a person meets them: what else has to change so that an
// edit can stand. Pure.
#pragma once

#include <vector>

#include "scene/parameter.h"
#include "scene/parameter_key.h"
#include "scene/scene.h"

namespace astrosplat::panel {

struct Companion {
    ParameterKey key;
    Value value;
};

/// To be set before `key` is set to `value`, in this order; empty where nothing else is concerned. `scene`
/// as it stands at the frame.
std::vector<Companion> companions(const Scene& scene, const ParameterKey& key, const Value& value);

/// The place in its list of the element that a parameter is of: 2 of "look.noise.2.cull".
std::size_t place_in_list(const ParameterKey& key);

/// Stops for a thickness map that has none: red, green and blue, from thick to thin, all with the look's own
/// shape.
std::vector<ThicknessStop> first_thickness_stops(const Look& look);

}  // namespace astrosplat::panel
