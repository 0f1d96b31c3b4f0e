// The folder in which sets and pictures are kept from run to run, so that the second run of a scene starts at
// once: whole sets, geometry and texels of columns, prepared pictures (removing stars takes seconds, and a
// set is made again for every change of its structure), and skies made of one picture, whose cut-outs take
// some 16 s. In: the folder's name and limit, and what is wanted. Out: the same as if made, to the bit. Many
// processes may share the folder; an entry that is damaged is made again, and a folder that cannot be read or
// written costs a warning, never a run.
#pragma once

#include "core/progress.h"
#include "sets/load_source.h"
#include "sets/recipe.h"
#include "source/prepared_picture.h"
#include "source/source.h"
#include "source/textured_mesh.h"
#include "source/tiled_sky.h"
#include "splat_files/native.h"
#include "splats/splat_set.h"

namespace astrosplat {

// In it: NAME.splats (native.h, rows by id; the name is its recipe's, whose text is in the file; its file
// time says when it was last used), NAME.lock while a process generates that set, .NAME.*.part.splats while
// it is written. Of columns NAME.splats is the geometry, and what is read from pictures lies beside it as
// NAME.texels, which ends its recipe with the geometry's name: scenes that differ in how pictures are read
// share their geometry, and only texels are read again.

struct SetCache {
    fs::path folder;  // made when something is kept; empty: no cache
    /// Bytes of all entries; the least recently used go first. 0: 20 GiB or a tenth of the disk,
    /// whichever is less.
    std::int64_t limit_bytes = 0;
};

/// $ASTROSPLAT_CACHE, else $XDG_CACHE_HOME/astrosplat, else ~/.cache/astrosplat; empty without a home.
fs::path default_cache_folder();

/// The limit; for 0 the one that it stands for in this folder.
std::int64_t limit_bytes(const SetCache& cache);

struct LoadedSet {
    SplatSet set;
    bool cached = false;           // read from the cache
    bool geometry_cached = false;  // at least that: no closest points were searched for
};

/// load_source through a cache: reads a mesh source's set where it is kept, else generates and keeps it;
/// other kinds pass by, but stars of a picture ask for their layer's set in this way. Of several processes
/// that need the same set one generates it and the others wait. Columns that are not wanted are empty. Throws
/// as load_source does.
LoadedSet load_source(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                      const Progress& progress = {}, KeptWatcher* watcher = nullptr,
                      const OptionalColumns& wanted = {});

/// load_source of stars of a picture (is_like_a_layer) whose layer's set is there already.
SplatSet load_picture_stars(const SetCache& cache, const SourceParams& source, const std::string& layer_name,
                            const SplatSet& of_picture, const Progress& progress = {});

// ---- entries

/// Removes entries (.splats, .texels, .tree, .exr), least recently used first, until they take at most
/// `bytes` together.
void shrink_cache(const SetCache& cache, std::int64_t bytes);

/// A warning: the run goes on without the cache.
void warn_unkept(const SetCache& cache, const std::string& why);

/// NAME.splats: a whole set, or the geometry of columns.
fs::path set_file(const SetCache& cache, const std::string& name);
/// NAME.texels: colours and alphas of columns.
fs::path texel_file(const SetCache& cache, const std::string& name);

/// An entry that is damaged, or that was made of something else, is removed with a warning; so are those of
/// the functions below. All throw Cancelled.
std::optional<SplatSet> read_whole(const SetCache& cache, const Recipe& recipe, const Progress& progress,
                                   const OptionalColumns& wanted);

/// All positions, to which texels are to be read.
std::optional<Columns> read_geometry(const SetCache& cache, const std::string& name,
                                     const Progress& progress);

struct KeptColumns {
    SplatSet set;
    Columns sample;              // of all positions
    std::int64_t positions = 0;  // that there are
};
/// The set of geometry and texels that belong together, and a sample of at most so many positions.
std::optional<KeptColumns> read_columns(const SetCache& cache, const Recipe& recipe,
                                        std::int64_t sample_limit, const OptionalColumns& wanted,
                                        const Progress& progress);

/// The recipe of the texels' file: the set's own, and the name of the geometry.
std::string texel_recipe(const Recipe& recipe, const std::string& geometry_name);

/// One file to be written.
struct KeptFile {
    fs::path file;
    NativePart part;
    std::string recipe;
};
/// Files of one set, where the cache has room for all of them; else a line says so. What cannot be written
/// costs a warning. SplatSet::recipe is empty before and after.
void keep(const SetCache& cache, const std::vector<KeptFile>& entries, SplatSet& set,
          const Progress& progress);

/// Reads prepared pictures where they are kept (as NAME.exr), else prepares and keeps them. A damaged entry
/// is made again; a folder that cannot be written costs a warning.
PictureMaker kept_pictures(const SetCache& cache);

/// load_meshes() with them, and larger files reduced to so many texels; 0: none.
std::vector<TexturedMesh> load_meshes(const SetCache& cache, const SourceParams& source,
                                      const Progress& progress = {}, std::int64_t most_texels = 0);

/// Reads skies where they are kept (as NAME.exr, one face below the other), else makes and keeps them. A
/// damaged entry is made again; a folder that cannot be written costs a warning.
SkyMaker kept_skies(const SetCache& cache);

/// Whether this one is kept. Throws Cancelled.
bool is_kept(const SetCache& cache, const fs::path& file, const SkyTiling& tiling,
             const Progress& progress = {});

}  // namespace astrosplat
