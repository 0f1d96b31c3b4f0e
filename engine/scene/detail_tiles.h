// Where a camera comes so close that a picture's texels would be seen (DETAIL 4.2). In: a scene with its
// moves, and the meshes of a layer with their pictures. Out: source.structure.detail_tiles of the layer.
#pragma once

#include "scene/scene.h"
#include "sets/kept.h"

namespace astrosplat {

struct DetailTiles {
    std::string tiles;       // as the key has them; empty: none is seen so close
    double shares[3] = {};   // of the picture, by octaves
    double more_splats = 0;  // about how many
};

/// Octaves of each tile of 64 texels, or of the larger ones that 128 a side are: one where a texel is more
/// than 2.5 px wide in a frame that shows it, two above 5, at most one more than its neighbours have. Of the
/// scene's frames every fourth and the last. Where that would be more than `most_splats`, both limits grow
/// until it is not. A texel is as far as the mesh is there, without the relief. The meshes' pictures may be
/// reduced; all get the same tiles.
DetailTiles detail_tiles(const Scene& scene, const LayerParams& layer, std::span<const TexturedMesh> meshes,
                         double most_splats);

constexpr std::int64_t usual_detail_splats = 6'000'000;
constexpr std::int64_t enough_texels = 65536;  // of its meshes' pictures: only their shape counts

/// Whether a layer's pictures are made into bodies, which can have detail.
bool has_bodies(const LayerParams& layer);

struct LayerDetail {
    std::string layer;
    DetailTiles tiles;
};

/// Sets source.structure.detail and detail_tiles of all layers of bodies for the camera's path, each to at
/// most about so many more splats; 0: none. What each got. Throws InputError, Cancelled.
std::vector<LayerDetail> set_detail(Scene& scene, double most_splats, const SetCache& cache,
                                    const Progress& progress = {});

}  // namespace astrosplat
