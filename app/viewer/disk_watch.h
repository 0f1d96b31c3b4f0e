// What others write on the disk while a scene is open: the files it is made of, looked at once a second. In:
// the scene and its layers as loaded. Out: files that were changed. The scene's own file is the document's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "edit/watched_files.h"
#include "scene/scene.h"
#include "viewer/set_loader.h"

namespace astrosplat {

class DiskWatch {
  public:
    /// A second has passed since it was last due; `now` in seconds.
    bool due(double now);
    /// Watches what the scene names and what was found in there, and a picture to compare with (may be
    /// empty).
    void watch(const Scene& scene, const SetLoader& loader, const std::filesystem::path& reference);
    /// Those that were changed since the last call.
    std::vector<std::filesystem::path> changed();
    /// Differs whenever changed() gave some: what is kept of them is to be read again.
    std::uint64_t changes() const { return changes_; }

  private:
    WatchedFiles files_;
    double checked_at_s_ = 0.0;
    std::uint64_t changes_ = 0;
};

/// Outdates the layers that are made of these files, so that they are loaded again.
void outdate_layers_of(const std::vector<std::filesystem::path>& files, const Scene& scene,
                       SetLoader& loader);

}  // namespace astrosplat
