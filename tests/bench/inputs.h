// Inputs of the benchmarks, made on the spot and the same everywhere: sets of splats, meshes of a given
// number of triangles, a picture, lattices.
#pragma once

#include "core/image.h"
#include "generate/lattice.h"
#include "source/textured_mesh.h"
#include "splats/shaded_splats.h"
#include "splats/splat_set.h"

namespace astrosplat::bench {

/// Uniform in [0, 1), a function of its arguments alone.
float random(std::uint32_t n, std::uint32_t purpose);

/// A set as generation leaves it: positions in a box of side 10, ids ascending, all arrays but radius.
SplatSet random_set(std::int64_t count);

/// Splats after a look, spread evenly over a 1080p picture at depths 10..20, `diameter_px` across; with a
/// `share` of the picture's sides nine of ten lie in the middle of it.
ShadedSplats spread(std::int64_t count, float diameter_px, float alpha, float share = 1.0f);

/// Smooth colours with alpha 1 in one half and falling alpha in the other; RGBA, linear, premultiplied.
Image picture(std::int64_t size);

/// A closed, dented ball of radius about 5 with 2 * segments * (rings - 1) triangles, coloured by picture().
TexturedMesh dented_ball(int rings, int segments);

/// The built-in plane, two triangles of side 10, coloured by picture() with alpha 1 everywhere.
TexturedMesh plane();

/// Arguments of generate().
struct GenerateInput {
    std::vector<TexturedMesh> meshes;
    Lattice lattice;
    double max_distance;  // scene units
};

/// 134 million positions around a dented ball, of which about 7 % are near enough.
GenerateInput ball_input(int rings, int segments);
/// 61 million positions around a plane, of which 40 % are near enough.
GenerateInput plane_input();

}  // namespace astrosplat::bench
