// From the look's keys to the numbers its arithmetic needs: curves become knots, defaults are resolved,
// matching becomes a factor per thickness stop. Costs microseconds, so animation and sliders may call it
// every frame.
#pragma once

#include <string>

#include "look/apply.h"
#include "look/shared_uniforms.h"

namespace astrosplat {

/// Throws InputError as apply_look does. Warns where colours would be divided by alpha twice.
LookUniforms prepare_look(const SplatSet& set, const Look& look, const LookInputs& inputs);

/// Of the steps alone, for the curves an artist looks at. `key` begins the messages of make_curve.
LookProfile density_profile(const DensityCurve& pdf, const std::string& key);
LookProfile vertical_profile(const VerticalAlpha& vertical);
LookAlpha horizontal_step(const HorizontalAlpha& alpha);

/// automatic is resolved: coverage for generated sets, none for files.
VerticalAlpha::Match resolved_match(const SplatSet& set, const VerticalAlpha& vertical);

}  // namespace astrosplat
