// Detail below the texels of a scene's pictures, where its camera comes close.
#pragma once

#include "command.h"

namespace astrosplat {

inline constexpr std::int64_t usual_detail_splats = 6000000;  // DETAIL 4

/// Sets source.structure.detail and detail_tiles of all layers of bodies for the camera's path, each to at
/// most about so many more splats; 0: none. What each got, by its name. Throws InputError, Cancelled.
Report set_detail(Scene& scene, std::int64_t most_splats, const SetCache& cache);

}  // namespace astrosplat
