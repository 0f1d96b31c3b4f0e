// Stars of a layer: a catalogue's, random ones around the camera's path, or those of a picture that another
// layer shows. In: what [layer.source] says. Out: their SplatSet.
#pragma once

#include <functional>
#include <string>

#include "core/progress.h"
#include "source/prepared_picture.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Whether a source of stars takes their places from another layer's picture.
inline bool is_like_a_layer(const SourceParams& source) {
    return source.kind == SourceKind::stars && !source.stars.like.empty();
}

/// The source of that layer, which the rest of `source` is.
SourceParams picture_source(const SourceParams& source);

/// Kind stars. `of_picture` gives the set of picture_source(): bodies are looked through for what they take
/// of each star's light on its way to the picture's camera, so that the light is the table's there. Says in a
/// line what there is. Throws InputError, Cancelled.
SplatSet load_stars(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                    const PictureMaker& prepared, const std::function<SplatSet()>& of_picture);

/// The same of a picture whose layer's set is there already.
SplatSet load_picture_stars(const SourceParams& source, const std::string& layer_name,
                            const Progress& progress, const PictureMaker& prepared,
                            const std::function<const SplatSet&()>& of_picture);

}  // namespace astrosplat
