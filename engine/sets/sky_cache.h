// Skies made of one picture, kept beside the sets: their cut-outs take some 16 s. In: the picture's file, how
// it is laid on the sky, and the folder. Out: the same six faces, to the bit.
#pragma once

#include "core/progress.h"
#include "sets/cache_folder.h"
#include "source/tiled_sky.h"

namespace astrosplat {

/// Reads skies where they are kept (as NAME.exr, one face below the other), else makes and keeps them. A
/// damaged entry is made again; a folder that cannot be written costs a warning.
SkyMaker kept_skies(const SetCache& cache);

/// Whether this one is kept. Throws Cancelled.
bool is_kept(const SetCache& cache, const std::filesystem::path& file, const SkyTiling& tiling,
             const Progress& progress = {});

}  // namespace astrosplat
