// A picture as bodies in depth instead of columns (source.structure): its stars, its bands and their depths
// become dots that show the picture from the front and hold up from everywhere else. In: meshes with
// pictures. Out: a SplatSet whose colours, alphas and radii are final, so that a plain look shows it as it
// is.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Every picture of every mesh by itself; its pixels are given back once they are read. `params.kind` is not
/// columns. A picture that becomes more than its share of `most_dots` (0: any number) is reduced and taken
/// again. Announces its memory before taking it and says at detail level what was found. The same bits with
/// any number of threads. Throws InputError, also where `most_dots` are too few for any picture; Cancelled.
SplatSet make_bodies(std::vector<TexturedMesh> meshes, const StructureParams& params, std::uint32_t seed,
                     const std::string& layer_name, const Progress& progress = {},
                     std::int64_t most_dots = 0);

}  // namespace astrosplat
