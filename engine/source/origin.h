// The origin of a layer: what is measured, modelled and invented, in one line for the headers of sets
// and frames and for `info`. In: a layer's source, and of its set what lies beyond the picture. Out: such as
// "measured: ...; modelled: ...; invented: ...".
#pragma once

#include <optional>
#include <string>

#include "source/source.h"

namespace astrosplat {

/// Of the splats of pictures, and of their light, what lies beyond the pictures' frames, 0..1.
struct ShareBeyond {
    double splats = 0.0, light = 0.0;
};

/// Of columns around meshes.
inline constexpr const char* columns_origin =
    "measured: colours, those of the pictures; invented: all places, around the meshes";

/// `beyond`: where the set is made. Empty for a file of splats, which says it itself.
std::string origin_of(const SourceParams& source, const std::optional<ShareBeyond>& beyond = {});

}  // namespace astrosplat
