// What a source's "0: automatic" comes to. In: a source of meshes. Out: the numbers in use, for people to
// read.
#pragma once

#include "core/progress.h"
#include "source/source.h"

namespace astrosplat {

/// Of the first mesh and its first picture; 0 where nothing is automatic, or there is no such thing.
struct AutomaticValues {
    double body_height = 0.0;  // source.structure.height, scene units
    double uv_width = 0.0;     // source.uv_width, scene units
};

/// Reads meshes, and pictures at a small size, where one of them is automatic. Throws InputError, Cancelled.
AutomaticValues automatic_values(const SourceParams& source, const Progress& progress = {});

}  // namespace astrosplat
