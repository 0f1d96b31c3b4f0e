// Scene values back to TOML: edits the text the scene came from, so that comments, order and spelled-out
// defaults stay and only changed keys are touched. load(save(x)) == x.
#pragma once

#include "scene/scene.h"

namespace astrosplat {

/// The text of `original` (may be empty: a new file) changed so that it loads as `scene`. Paths are written
/// relative to `file`'s folder where they were relative or lie below it.
std::string save_text(const Scene& scene, const std::string& original, const fs::path& file);

/// A preset file that gives this look and render to any layer; paths relative to `file`'s folder.
std::string save_preset_text(const Look& look, const LayerRender& render, const fs::path& file);

}  // namespace astrosplat
