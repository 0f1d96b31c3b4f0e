// Prepared pictures, kept beside the sets: removing stars takes seconds, and a set is made again for every
// change of its structure. In: what prepare_picture() takes, and the folder. Out: the same picture, to the
// bit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "sets/cache_folder.h"
#include "source/prepared_picture.h"
#include "source/textured_mesh.h"

namespace astrosplat {

/// A picture that is kept, and is now used; nothing where there is no entry, or a damaged one, which is
/// removed with a warning that ends in `remedy`. Throws Cancelled.
std::optional<PreparedPicture> read_kept_picture(const std::filesystem::path& file, const char* remedy,
                                                 const Progress& progress);
/// Keeps it where the cache has room; what cannot be written costs a warning.
void keep_picture(const SetCache& cache, const std::filesystem::path& file, const Image& image,
                  const std::string& credit);

/// Reads prepared pictures where they are kept (as NAME.exr), else prepares and keeps them. A damaged entry
/// is made again; a folder that cannot be written costs a warning.
PictureMaker kept_pictures(const SetCache& cache);

/// load_meshes() with them, and larger files reduced to so many texels; 0: none.
std::vector<TexturedMesh> load_meshes(const SetCache& cache, const SourceParams& source,
                                      const Progress& progress = {}, std::int64_t most_texels = 0);

}  // namespace astrosplat
