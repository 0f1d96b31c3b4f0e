// The files of a cache of sets: whole sets, and geometry and texels of columns. In: recipes. Out: sets, as
// they were kept; nothing where there is no entry, or none that can be used.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "generate/columns.h"
#include "sets/cache_folder.h"
#include "sets/recipe.h"
#include "splat_files/native.h"
#include "splats/splat_set.h"

namespace astrosplat {

/// NAME.splats: a whole set, or the geometry of columns.
std::filesystem::path set_file(const SetCache& cache, const std::string& name);
/// NAME.texels: colours and alphas of columns.
std::filesystem::path texel_file(const SetCache& cache, const std::string& name);

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

/// What the texels' file has as its recipe: the set's own, and the name of the geometry.
std::string texel_recipe(const Recipe& recipe, const std::string& geometry_name);

/// One file to be written.
struct KeptFile {
    std::filesystem::path file;
    NativePart part;
    std::string recipe;
};
/// Files of one set, where the cache has room for all of them; else a line says so. What cannot be written
/// costs a warning. SplatSet::recipe is empty before and after.
void keep(const SetCache& cache, const std::vector<KeptFile>& entries, SplatSet& set,
          const Progress& progress);

}  // namespace astrosplat
