// A picture as bodies in depth instead of columns (source.structure): its stars, its bands and their depths
// become splats that show the picture from the front and hold up from everywhere else. In: meshes with
// pictures. Out: a SplatSet whose colours, alphas and radii are final, so that a plain look shows it as it
// is; before that, how many splats and bytes they will be, and pictures made smaller or larger to suit.
#pragma once

#include "core/progress.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// Every picture of every mesh by itself; its pixels are given back once they are read. `params.kind` is not
/// columns. A picture that becomes more than its share of `most_splats` (0: any number) is reduced and taken
/// again. Announces its memory before taking it and says at detail level what was found. The same bits with
/// any number of threads. Throws InputError, also where `most_splats` are too few for any picture; Cancelled.
SplatSet make_bodies(std::vector<TexturedMesh> meshes, const StructureParams& params, std::uint32_t seed,
                     const std::string& layer_name, const Progress& progress = {},
                     std::int64_t most_splats = 0);

/// A picture of a mesh's material, where a face shows it.
struct PictureOnMesh {
    const TexturedMesh* mesh = nullptr;
    std::uint32_t mesh_index = 0, material = 0;
    const Texture& texture() const { return mesh->textures[material]; }
};

/// All of them, in order. Throws InputError where they are more than ids can number.
std::vector<PictureOnMesh> pictures_of(std::span<const TexturedMesh> meshes);

/// From samples of the picture, taken apart as the whole will be; within some 5 %, of invented detail 15 %.
double expected_splats(const Texture& texture, const StructureParams& params);

/// More than a picture of width x height texels can become; at once.
double splats_at_most(std::int64_t width, std::int64_t height, const StructureParams& params);

/// Splats that make_bodies() will make, within some 5 %: told from samples of the pictures.
std::int64_t expected_splats(std::span<const TexturedMesh> meshes, const StructureParams& params);

/// Bytes that make_bodies() will take at its peak beside the meshes and pictures for so many splats, within
/// about 15 %.
std::int64_t bodies_memory_bytes(std::span<const TexturedMesh> meshes, const StructureParams& params,
                                 std::int64_t splats);

/// No picture of more texels could be made bodies of in so many bytes.
std::int64_t most_texels_within(std::int64_t bytes);

struct BodiesLimit {
    std::int64_t room_bytes = 0;
    std::int64_t splats = 0;  // 0: as many as there are
};

/// Enlarges small pictures by whole numbers, to no more than a picture of 2048x2048 has, for a texel to be
/// several splats that together show it as sharp as it was. None that was reduced while it was read. Says so
/// at detail level.
void enlarge_small_pictures(std::vector<TexturedMesh>& meshes, const std::string& layer_name);

/// Reduces every picture of more texels by an area filter to so many; 0: none. Says so at detail level, also
/// of those that were reduced as they were read.
void reduce_to(std::vector<TexturedMesh>& meshes, std::int64_t most_texels, const std::string& layer_name);

/// Whether all pictures are at least as large as reduce_to() makes their files.
bool have_all_texels(std::span<const TexturedMesh> meshes, std::int64_t most_texels);

/// Texels of the largest picture.
std::int64_t largest_picture(std::span<const TexturedMesh> meshes);

/// Reduces the largest picture by an area filter until make_bodies() just keeps to the limit, as far as that
/// can be told before; then the next one where that does not suffice. A warning says so.
void reduce_pictures(std::vector<TexturedMesh>& meshes, const StructureParams& params,
                     const BodiesLimit& limit, const std::string& layer_name);

inline std::int64_t texels_of(const Texture& texture) { return texture.image.width * texture.image.height; }

}  // namespace astrosplat
