// The description of one layer, and of what a layer and a preset share.
#pragma once

#include "scene/describer.h"

namespace astrosplat {

/// The keys of one layer; the describer stands at "layer.NAME".
void describe_layer(const Describer& d, LayerParams& layer);

/// The keys of [layer.look] and [layer.render]; the describer stands there.
void describe_look(const Describer& d, Look& look);
void describe_render(const Describer& d, LayerRender& render);

}  // namespace astrosplat
