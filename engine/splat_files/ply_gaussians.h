// 3D Gaussian Splatting's properties of a PLY file. In: the vertex element of its header. Out: columns that
// know which of them are which numbers of a Gaussian.
#pragma once

#include <filesystem>
#include <vector>

#include "splat_files/ply_header.h"
#include "splat_files/splat_table.h"

namespace astrosplat {

/// Whether the vertices are Gaussians as training stores them: f_dc_0.., opacity, scale_0.., rot_0.. (w
/// first).
bool holds_gaussians(const PlyElement& vertex);

/// The columns of such a vertex: these, x y z and f_rest_* of degree 1 to 3 (all red, all green, all blue);
/// all else is skipped. Throws InputError where some of them are missing.
std::vector<Column> gaussian_columns(const PlyElement& vertex, const std::filesystem::path& file);

}  // namespace astrosplat
