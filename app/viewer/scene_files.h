// Files that a scene names besides its sets: pictures that views share, the configuration of OpenColorIO, and
// a watch for changes on disk. In: the scene. Out: pixels, a display transform, names of changed files.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/file.h"
#include "core/image.h"
#include "core/worker.h"
#include "edit/disk_files.h"
#include "edit/status.h"
#include "render/environment.h"
#include "scene/scene.h"
#include "viewer/set_loader.h"

namespace astrosplat {

/// Thickness maps, and environments, which are loaded in the background; kept while the viewer runs.
class PictureFiles {
  public:
    /// Of load_map(). Throws InputError.
    const Image& map(const std::filesystem::path& file, Derived derive);
    /// With gain and rotation of `params`; null where there is none to be seen, and while it is being loaded.
    /// Throws InputError where it cannot be.
    std::shared_ptr<const Environment> environment(const EnvironmentParams& params);
    /// The environment asked for last is on its way.
    bool loading() const;
    /// Reads these again: maps when next asked for, environments at once; the old ones are seen until then.
    void forget(const std::vector<std::filesystem::path>& files);

  private:
    /// Of what pictures_of() gives.
    struct ByPictures {
        bool operator()(const EnvironmentParams& a, const EnvironmentParams& b) const;
    };
    struct Sky {
        std::optional<Environment> loaded;
        std::exception_ptr error;  // why it could not be
        bool due = true;           // to be loaded
        bool loading = false;
        bool rests() const { return !due && !loading; }
    };

    Worker::Task next_sky();
    void load(const EnvironmentParams& params);

    std::map<std::pair<std::filesystem::path, Derived>, std::unique_ptr<Image>> maps_;  // null: to be read
    std::vector<std::unique_ptr<Image>> old_maps_;  // so that new ones do not get their addresses
    /// The comparison may have another one; with the worker's lock.
    std::map<EnvironmentParams, Sky, ByPictures> skies_;
    std::optional<EnvironmentParams> wanted_;  // asked for last; with the lock
    Worker worker_{[this] { return next_sky(); }};
};

/// The transform that the viewport shows the frame through, and for the panel what the configuration has to
/// choose from, or why it cannot be used.
class ColorManagement {
  public:
    /// Brings both up to date. A configuration is read when its names or files change; one that is not wanted
    /// only where its words are, `seen`.
    void update(const OcioParams& params, bool seen);
    /// Null: the scene wants none, or it cannot be made.
    const std::shared_ptr<const DisplayTransform>& transform() const { return transform_; }
    /// None: there is no configuration, or its words are not seen.
    const std::optional<ColorStatus>& status() const { return status_; }

  private:
    struct Asked {
        OcioParams params;
        std::filesystem::path file;
        FileStamp stamp;  // of the file
        bool operator==(const Asked&) const = default;
    };
    void read(const Asked& now);

    std::optional<Asked> asked_;
    std::shared_ptr<const DisplayTransform> transform_;
    std::optional<ColorStatus> status_;
};

/// Looks at the files once a second. The scene's own file is the document's.
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
