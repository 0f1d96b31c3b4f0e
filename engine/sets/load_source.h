// The front door of a layer's source. In: the values of [layer.source]. Out: its SplatSet, generated from
// meshes and pictures or read from a splat file; of columns also the steps on the way to it, of bodies a flat
// preview before they are made; stars of a catalogue, random ones around the camera's path, or those of a
// picture that another layer shows; and the values that keys of 0 (automatic) stand for.
#pragma once

#include "bodies/moved_bodies.h"
#include "core/atomic_file.h"
#include "core/progress.h"
#include "generate/generate.h"
#include "generate/kept_store.h"
#include "generate/lattice.h"
#include "source/prepared_picture.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "splats/splat_set.h"

namespace astrosplat {

class KeptWatcher;

/// The whole of a source: kind mesh as above, kind splats by reading the file (sorted by id), kind stars by
/// reading the catalogue. Prints at info level what was chosen. Throws InputError.
/// `prepared` gives the pictures that source.prepare asks for.
SplatSet load_source(const SourceParams& source, const std::string& layer_name, const Progress& progress = {},
                     KeptWatcher* watcher = nullptr, const PictureMaker& prepared = make_prepared);

/// A warning where a set has no splats. `name` is of its file or its layer.
void warn_of_no_splats(const SplatSet& set, const std::string& name);

/// Whether a source is made into columns.
inline bool makes_columns(const SourceParams& source) {
    return source.kind == SourceKind::mesh && source.structure.kind == StructureKind::columns;
}

// ---- the steps on the way

/// All that bodies are made of.
struct BodiesPlan {
    std::vector<TexturedMesh> meshes;
    StructureParams structure;
    std::vector<glm::dvec2> times;  // as wide and high as the pictures, of each mesh (structure.margin)
    bool fits_memory = true;        // else pictures are smaller than the scene asks for
};

/// To which a larger file of a source's pictures is reduced while it is read, for PictureReaders: what the
/// scene asks for, and no more than `room_bytes` could make bodies of. 0: to none, as for columns.
std::int64_t most_texels_read(const SourceParams& source, std::int64_t room_bytes);

/// Of this machine's memory, what bodies may take.
std::int64_t room_for_bodies();

/// Reduces a source's pictures until they are no more than the scene asks for and this machine's memory has
/// room for; a warning says so.
BodiesPlan plan_bodies(const SourceParams& source, std::vector<TexturedMesh> meshes,
                       const std::string& layer_name);

/// Places in the pictures, of those in the pictures with their margins.
void uv_of_pictures(std::span<const glm::dvec2> times, SplatSet& set);

/// All that columns are made of.
struct ColumnPlan {
    std::vector<TexturedMesh> meshes;
    Lattice lattice;
    double max_distance = 0.0;  // scene units
    double jitter = 1.0;        // 0..1 of half a voxel
    std::uint32_t seed = 1;
};

/// Loads meshes and pictures and chooses the lattice, for a source that makes_columns(). Throws as
/// load_source does.
ColumnPlan plan_columns(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                        const PictureMaker& prepared = make_prepared);

/// Searches for the closest points. Throws as load_source does.
Columns make_columns(const ColumnPlan& plan, const std::string& layer_name, const Progress& progress,
                     KeptWatcher* watcher = nullptr);

/// The set of columns into a .splats file, without ever having it in memory (generate.h). Returns how
/// many splats it has. Throws as load_source does, and OutputError.
std::int64_t write_columns(const WriteTarget& target, const ColumnPlan& plan, const std::string& layer_name,
                           const Progress& progress);

/// Of the first mesh and its first picture; 0 where nothing is automatic, or there is no such thing.
struct AutomaticValues {
    double body_height = 0.0;  // source.structure.height, scene units
    double uv_width = 0.0;     // source.uv_width, scene units
};

/// Reads meshes, and pictures at a small size, where one of them is automatic. Throws InputError, Cancelled.
AutomaticValues automatic_values(const SourceParams& source, const Progress& progress = {});

/// All pictures as they lie on their meshes: some 65,000 splats, each with the mean colour of its part.
SplatSet flat_picture(std::span<const TexturedMesh> meshes);

/// For rows of the set that the source is made into; `meshes`: as they were read for it.
MovedBodies moved_bodies(const SourceParams& source, std::vector<TexturedMesh> meshes,
                         const std::string& layer_name, SplatSet rows);

// ---- stars

/// Whether a source of stars takes their places from another layer's picture.
inline bool is_like_a_layer(const SourceParams& source) {
    return source.kind == SourceKind::stars && !source.stars.like.empty();
}

/// The source of that layer, which the rest of `source` is.
SourceParams picture_source(const SourceParams& source);

/// Kind stars. `of_picture` gives the set of picture_source(): bodies are looked through for what they take
/// of each star's light on its way to the picture's camera, so that the light is the table's there. Says in a
/// line what there is. Throws InputError, Cancelled.
SplatSet load_stars(const SourceParams& source, const std::string& layer_name, const Progress& progress,
                    const PictureMaker& prepared, const std::function<SplatSet()>& of_picture);

/// The same of a picture whose layer's set is there already.
SplatSet load_picture_stars(const SourceParams& source, const std::string& layer_name,
                            const Progress& progress, const PictureMaker& prepared,
                            const std::function<const SplatSet&()>& of_picture);

}  // namespace astrosplat
