// Pictures that views share, by file: thickness maps, and environments, which are loaded in the background.
// In: names of files. Out: their pixels, kept while the viewer runs.
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/worker.h"
#include "render/environment.h"
#include "scene/scene.h"

namespace astrosplat {

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

    std::map<std::pair<std::filesystem::path, Derived>, std::unique_ptr<Image>> maps_;
    std::vector<std::unique_ptr<Image>> old_maps_;  // so that new ones do not get their addresses
    /// What is compared may have another one; with the worker's lock.
    std::map<EnvironmentParams, Sky, ByPictures> skies_;
    std::optional<EnvironmentParams> wanted_;  // asked for last; with the lock
    Worker worker_{[this] { return next_sky(); }};
};

}  // namespace astrosplat
