// The front door of a layer's source. In: what [layer.source] says. Out: its SplatSet, generated from meshes
// and pictures or read from a splat file.
#pragma once

#include <string>

#include "core/progress.h"
#include "source/prepared_picture.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

class KeptWatcher;

/// The whole of a source: kind mesh as above, kind splats by reading the file (sorted by id). Prints at info
/// level what was chosen. Throws InputError; kind stars is refused in one clear line until it exists.
/// `prepared` gives the pictures that source.prepare asks for.
SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress = {},
                     KeptWatcher* watcher = nullptr, const PictureMaker& prepared = make_prepared);

}  // namespace astrosplat
