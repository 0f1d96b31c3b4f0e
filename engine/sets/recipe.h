// Names under which things are kept (sets/kept.h): hashes of all that reaches a bit of them, and of nothing
// else.
#pragma once

#include "core/progress.h"
#include "sets/load_source.h"
#include "source/source.h"
#include "source/tiled_sky.h"

namespace astrosplat {

/// Raised whenever generation, or the reading of meshes and pictures, gives other bits than before.
inline constexpr int set_version = 47;

/// The same of the preparation of pictures.
inline constexpr int prepare_version = 6;

/// The hashed text, line by line: versions, the bytes of meshes and pictures (of a mesh without a named
/// picture also its material libraries and their pictures), and the parameters in use, with the seed
/// resolved. Names of files stay out, except for their endings. Empty where an input cannot be read: then the
/// loader says why. For kind mesh. Throws Cancelled.
std::string recipe_text(const SourceParams& source, const std::string& layer_name,
                        const Progress& progress = {});

/// The same of skies of cut-outs (source/tiled_sky.h).
inline constexpr int sky_version = 2;
std::string sky_recipe_text(const fs::path& file, const SkyTiling& tiling, const Progress& progress = {});

/// The same of one prepared picture: its files, how they are read and settings.prepare.
std::string prepared_recipe_text(const std::vector<fs::path>& files, const TextureSettings& settings,
                                 const Progress& progress = {});

/// That text, and its hash, which names the entry; both empty where an input cannot be read.
struct Recipe {
    std::string text, name;
};
Recipe recipe_of(const SourceParams& source, const std::string& layer_name, const Progress& progress = {});

/// The same for what columns are before any picture is looked at: the shapes of the meshes and how pictures
/// lie on them, the lattice, jitter and seed. A picture reaches it where a shape or `splats` is made by it.
Recipe geometry_recipe(const ColumnPlan& plan);

}  // namespace astrosplat
