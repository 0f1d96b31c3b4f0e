// Every parameter of a scene, described once: describe() lists them all with key, words, range and a handle
// on the field. Loading, saving, --set, the manual, animation and the window's sliders are loops over this
// list. To add a parameter: a field, one line in a describe_*.cpp, and its use.
#pragma once

#include "scene/parameter.h"
#include "scene/scene.h"

namespace astrosplat {

/// All parameters of the scene, "output.resolution" ... "layer.NAME.look.alpha.power", in the order of the
/// manual. The handles point into `scene`.
Description describe(Scene& scene);

/// Only the groups ("camera", "layer.NAME") that are wanted: all of a scene is some hundred parameters with
/// all their words, too much for every frame.
Description describe(Scene& scene, const std::function<bool(const ParameterKey& group)>& wanted);

/// Those of a preset file: "look.density" ... "render.isolate".
Description describe_preset(Look& look, LayerRender& render);

/// In file order.
std::vector<std::string> layer_names(const Scene& scene);

/// The key with "0" put in where a list's index is left out: layer.a.look.noise.cull is noise.0.cull.
ParameterKey full_key(const Description& description, const ParameterKey& key);

/// The parameter of a full key, or one with left-out indices; nullptr when there is none.
const Parameter* find_parameter(const Description& description, const ParameterKey& key);

/// The section of a scene file that a generic key is written in: "output", "layer.look", ...; "" at the top.
ParameterKey section_of(const ParameterKey& generic_key);

struct ParameterRow {
    ParameterSpec spec;
    Value value;
};

/// The rows of the manual: generic keys with their defaults, from a scene with one layer and one element in
/// every list.
const std::vector<ParameterRow>& parameter_rows();

/// parameter_rows() as a table for a terminal: key, default, unit, range, animation and help.
std::string parameter_table();

/// "(a number from 0 to 1, px; animated)": what a value may be.
std::string value_words(const ParameterSpec& spec);

}  // namespace astrosplat
