// Wavefront OBJ files, with their materials. In: a path. Out: Mesh, with polygons triangulated and negative
// indices resolved.
#pragma once

#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "source/mesh.h"

namespace astrosplat {

/// Reads an OBJ: several objects, quads and polygons, negative indices, map_Kd. Faces keep the file's order.
/// A missing MTL is a warning. Throws InputError (file, line where known) for unreadable, truncated or empty
/// files, indices out of range, coordinates that are not finite; Cancelled.
Mesh load_obj(const std::filesystem::path& file, const Progress& progress = {});

/// The files besides the OBJ itself that its map_Kd pictures come from: the material libraries that it names
/// and the pictures that those name, as far as they exist. Reads no geometry. Throws InputError,
/// Cancelled.
std::vector<std::filesystem::path> obj_materials(const std::filesystem::path& file,
                                                 const Progress& progress = {});

}  // namespace astrosplat
