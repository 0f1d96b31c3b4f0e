// Generated sets, kept in a folder so that the second run of a scene starts at once. In: what load_source
// takes, and the folder. Out: the same SplatSet, to the bit. Many processes may share the folder; an entry
// that is damaged is generated again, and a folder that cannot be read or written costs a warning, never a
// run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/progress.h"
#include "sets/kept.h"
#include "source/source.h"
#include "splats/splat_set.h"

namespace astrosplat {

// In the folder: NAME.splats (native.h, rows by id; the name is recipe.h's, whose text is in the file; its
// file time says when it was last used), NAME.lock while a process generates that set, .NAME.*.part.splats
// while it is written. Of columns NAME.splats is the geometry, and what is read from pictures lies beside it
// as NAME.texels, which ends its recipe with the geometry's name: scenes that differ in how pictures are read
// share their geometry, and only texels are read again.

class KeptWatcher;

struct LoadedSet {
    SplatSet set;
    bool cached = false;           // read from the cache
    bool geometry_cached = false;  // at least that: no closest points were searched for
};

/// load_source through a cache: reads a mesh source's set where it is kept, else generates and keeps it;
/// other kinds pass by, but stars of a picture ask for their layer's set in this way. Of several processes
/// that need the same set one generates it and the others wait. Columns that are not wanted are empty. Throws
/// as load_source does.
LoadedSet load_source(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                      const Progress& progress = {}, KeptWatcher* watcher = nullptr,
                      const OptionalColumns& wanted = {});

/// load_source of stars of a picture (is_like_a_layer) whose layer's set is there already.
SplatSet load_picture_stars(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                            const SplatSet& of_picture, const Progress& progress = {});

}  // namespace astrosplat
