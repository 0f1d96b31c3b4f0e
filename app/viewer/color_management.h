// Colour management in the window. In: the names in the scene. Out: the transform that the viewport shows the
// frame through, and for the panel what the configuration has to choose from, or why it cannot be used.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/file.h"
#include "edit/status.h"

namespace astrosplat {

class ColorManagement {
  public:
    /// Brings both up to date. A configuration is read when its names or files change; one that is not wanted
    /// only where its words are, `seen`.
    void update(const OcioParams& params, bool seen);
    /// Null: the scene wants none, or it cannot be made.
    const std::shared_ptr<const DisplayTransform>& transform() const { return transform_; }
    /// None: there is no configuration, or nobody looks.
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

}  // namespace astrosplat
