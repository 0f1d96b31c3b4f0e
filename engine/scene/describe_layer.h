// The description of one layer, of what a layer and a preset share, and of how a picture is read and made
// ready: keys of a source, and options of the command `prepare`.
#pragma once

#include "scene/describer.h"

namespace astrosplat {

/// The keys of one layer; the describer stands at "layer.NAME".
void describe_layer(const Describer& d, LayerParams& layer);

/// The keys of [layer.look] and [layer.render]; the describer stands there.
void describe_look(const Describer& d, Look& look);
void describe_render(const Describer& d, LayerRender& render);

/// The part of FITS that is read, and how its values become light.
void describe_fits(const Describer& d, TextureSettings& t);

/// The keys of [layer.source.prepare]; the describer stands there.
void describe_prepare(const Describer& d, PrepareParams& p);

/// Both, without a group before their names: "stretch", "stars", "ellipse".
Description describe_preparation(TextureSettings& t);

/// The option of the command that stands for one of these: "--lupton-stretch".
std::string prepare_option(const ParameterKey& key);

}  // namespace astrosplat
