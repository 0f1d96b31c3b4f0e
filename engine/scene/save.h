// Scene values back to TOML: edits the text the scene came from, so that comments, order and spelled-out
// defaults stay and only changed keys are touched. load(save(x)) == x.
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace astrosplat {

/// The text of `original` (may be empty: a new file) changed so that it loads as `scene`. Paths are written
/// relative to `file`'s folder where they were relative or lie below it.
std::string save_text(const Scene& scene, const std::string& original, const std::filesystem::path& file);

/// Writes save_text over scene.file atomically. Throws OutputError.
void save_scene(const Scene& scene, const std::filesystem::path& file);

}  // namespace astrosplat
