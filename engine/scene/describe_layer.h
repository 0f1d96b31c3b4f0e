// The description of one layer.
#pragma once

#include "scene/describer.h"

namespace astrosplat {

/// The keys of one layer; the describer stands at "layer.NAME".
void describe_layer(const Describer& d, LayerParams& layer);

}  // namespace astrosplat
