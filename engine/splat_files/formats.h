// The splat files of other programs, one reader (and writer) each; the program's own are native.h. In and
// out: SplatSet. All rows come in the file's order; an id that a file does not say is the row's number.
//
// A new format: a row in core/file_format.cpp, its functions here and in a file of their own,
// and a row in splat_file.cpp.
#pragma once

#include "core/atomic_file.h"
#include "core/progress.h"
#include "splats/splat_set.h"

namespace astrosplat {

// Readers throw InputError with the file and the place in it, and Cancelled; writers OutputError.
// By the file's header: NAME_columns, the columns of its splats, and NAME_splat_count, their number.

/// Maya's ASCII particle files (.pda): a header (ATTRIBUTES, TYPES, NUMBER_OF_PARTICLES, BEGIN DATA) and one
/// line of numbers a particle. Attributes used: position (V), rgbPP (V, linear), opacityPP,
/// DistanceFromSurfaceMeshPP, radiusPP (R), whichMeshPP, particleId or id (I or R); any others are skipped by
/// their type. Missing colour is white, missing opacity 1, missing distance 0.
SplatSet read_pda(const fs::path& file, const Progress& progress = {});
SplatColumns pda_columns(const fs::path& file);
std::int64_t pda_splat_count(const fs::path& file);
/// Shortest decimal numbers that read back to the same float32, 64-bit ids; the same bytes for any thread
/// count. What PDA has no attribute for (uv, normal, spacing, credit) is left out.
void write_pda(const WriteTarget& target, const SplatSet& set, const Progress& progress = {});

/// PLY point clouds (.ply): ASCII, binary little-endian and big-endian. Of element vertex x y z and, where
/// present, red green blue alpha (float 0..1, linear; uchar and ushort: sRGB colour, linear alpha), radius,
/// distance, id (with id_high for its upper 32 bits, as PLY has no 64-bit numbers), mesh, s t are read, or
/// Gaussians as 3D Gaussian Splatting stores them: x y z, f_dc_*, f_rest_* of degree 1 to 3 (all red, all
/// green, all blue), opacity (a logit), scale_* (logarithms), rot_* (w first); instead of f_dc_* red green
/// blue (display values, floats or codes), and Mip-Splatting's filter_3D, which widens them. All else is
/// skipped. Missing colour is white, missing alpha 1, missing distance 0. SuperSplat's compressed Gaussians
/// (vertices of packed_position and others, with an element chunk) are read, too.
SplatSet read_ply(const fs::path& file, const Progress& progress = {});
SplatColumns ply_columns(const fs::path& file);
std::int64_t ply_splat_count(const fs::path& file);
/// Binary little-endian, all numbers as they are in memory; id_high only where an id needs it. A credit
/// becomes a comment; normal and spacing are left out.
void write_ply(const WriteTarget& target, const SplatSet& set, const Progress& progress = {});

inline constexpr std::string_view gltf_gaussians = "KHR_gaussian_splatting";

/// Gaussians of glTF 2.0 files (.glb, .gltf), as Khronos' KHR_gaussian_splatting has them: POINTS with
/// POSITION, ROTATION (x y z w), SCALE (linear), OPACITY and SH_DEGREE_l_COEF_n. All of the scene, in the
/// order of its nodes, each node's placed by it (turned, mirrored and scaled alike along all axes, else
/// InputError). Compressed ones are refused.
SplatSet read_gltf_splats(const fs::path& file, const Progress& progress = {});
SplatColumns gltf_splat_columns(const fs::path& file);

/// Gaussians of USD as text (.usda): ParticleField3DGaussianSplat of OpenUSD's UsdVol (26.03). All that the
/// stage defines, in its order, each prim's placed by its own and its parents' transforms at time 0 (turned,
/// mirrored and scaled alike along all axes, else InputError) and with y up. Lists are of floats or halves;
/// what a prim does not list is the schema's: no turn, scales and opacities of 1, middle grey. Harmonics are
/// display values. Nothing that the file refers to is opened, and no time samples of the lists are read.
SplatSet read_usda_splats(const fs::path& file, const Progress& progress = {});
SplatColumns usda_splat_columns(const fs::path& file);
std::int64_t usda_splat_count(const fs::path& file);

/// Niantic's SPZ (.spz), versions 1 to 4. Y and z change signs, so that a capture lies as its PLY does;
/// SPZ_ADOBE_coordinate_system is followed, other extensions are skipped with a warning. Trained antialiased,
/// as we draw, or not makes no difference; harmonics of degree 4 are left out.
SplatSet read_spz(const fs::path& file, const Progress& progress = {});
SplatColumns spz_columns(const fs::path& file);
std::int64_t spz_splat_count(const fs::path& file);

/// antimatter15's .splat.
SplatSet read_dot_splat(const fs::path& file, const Progress& progress = {});
SplatColumns dot_splat_columns(const fs::path& file);
std::int64_t dot_splat_splat_count(const fs::path& file);

/// PlayCanvas' SOG of version 2, bundled (.sog).
SplatSet read_sog(const fs::path& file, const Progress& progress = {});
SplatColumns sog_columns(const fs::path& file);
std::int64_t sog_splat_count(const fs::path& file);

}  // namespace astrosplat
