// Files beside the sets. Small images, read in the background: thumbnails of a folder, played frames of the
// output, the finished frame of a job. And those that a scene names: pictures that views share, the
// configuration of OpenColorIO, and what becomes of files that change.
#pragma once

#include <exception>
#include <map>

#include "core/file.h"
#include "core/image.h"
#include "core/worker.h"
#include "edit/status.h"
#include "render/environment.h"
#include "scene/scene.h"
#include "viewer/background_work.h"
#include "viewer/set_loader.h"

namespace astrosplat {

/// RGB on black, the first row on top, in one of two ways that take little memory.
struct PackedImage {
    std::int64_t width = 0, height = 0;            // px
    std::int64_t file_width = 0, file_height = 0;  // px, in the file
    std::vector<std::uint8_t> codes;               // display values, 255 is 1
    std::vector<std::uint16_t> light;              // linear, primaries of Rec. 709, as half floats
    std::string error;                             // one line: it cannot be read
    bool is_light() const { return !light.empty(); }
    std::size_t bytes() const {
        return sizeof(PackedImage) + codes.size() + light.size() * sizeof(std::uint16_t);
    }
};

/// RGBA, opaque, for a texture.
Image to_image(const PackedImage& packed);

/// The longer side is at most `most_px`. FITS is stretched as it is where nothing is set, linear light gets
/// the screen's curve: codes. Throws InputError, Cancelled.
PackedImage thumbnail_of_file(const fs::path& file, std::int64_t most_px, const Progress& progress = {});

/// Thumbnails of files as a folder lists them.
class Thumbnails : public ReadAhead<ListedPicture, PackedImage> {
  public:
    explicit Thumbnails(std::int64_t most_px = 144, std::size_t most_bytes = std::size_t{32} << 20);
    /// Small files first.
    void want(std::vector<ListedPicture> pictures);
};

/// Frames of the output's files, read ahead so that they play. Scene light stays light, to be seen through
/// the viewport's view.
class RenderedFrames : public ReadAhead<ListedPicture, PackedImage> {
  public:
    explicit RenderedFrames(std::int64_t most_px = 1280, std::size_t most_bytes = std::size_t{512} << 20);

    /// These files are read, the first one first, unless they are there as they now lie on the disk. Returns
    /// at once.
    void want(const std::vector<fs::path>& files);
    /// Null while it is not read as it now lies there.
    std::shared_ptr<const PackedImage> found(const fs::path& file) const;
};

struct FinishedView {
    Image image;        // display values, RGBA, opaque
    std::string error;  // one line: it cannot be read
};

/// How files of scene light are seen; others are as they look.
struct FinishedRequest {
    fs::path file;
    OutputParams::View view = OutputParams::View::srgb;  // never automatic
    std::shared_ptr<const DisplayTransform> ocio;        // in place of `view`; null: none
    double exposure = 0.0;                               // stops
    bool operator==(const FinishedRequest&) const = default;
};

/// The longer side is at most `most_px`. Throws InputError.
FinishedView finished_view(const FinishedRequest& request, std::int64_t most_px);

using FinishedFrames = LatestWork<FinishedRequest, FinishedView>;
FinishedFrames::Work finished_frames(std::int64_t most_px = 720);

/// Thickness maps, and environments, which are loaded in the background; kept while the viewer runs.
class PictureFiles {
  public:
    /// Of load_map(). Throws InputError.
    const Image& map(const fs::path& file, Derived derive);
    /// With gain and rotation of `params`; null where there is none to be seen, and while it is being loaded.
    /// Throws InputError where it cannot be.
    std::shared_ptr<const Environment> environment(const EnvironmentParams& params);
    /// The environment asked for last is on its way.
    bool loading() const;
    /// Reads these again: maps when next asked for, environments at once; the old ones are seen until then.
    void forget(const std::vector<fs::path>& files);

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

    std::map<std::pair<fs::path, Derived>, std::unique_ptr<Image>> maps_;  // null: to be read
    std::vector<std::unique_ptr<Image>> old_maps_;        // so that new ones do not get their addresses
    std::map<EnvironmentParams, Sky, ByPictures> skies_;  // with the lock; the comparison may have another
    std::optional<EnvironmentParams> wanted_;             // asked for last; with the lock
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
        fs::path file;
        FileStamp stamp;  // of the file
        bool operator==(const Asked&) const = default;
    };
    void read(const Asked& now);

    std::optional<Asked> asked_;
    std::shared_ptr<const DisplayTransform> transform_;
    std::optional<ColorStatus> status_;
};

/// Files to be watched: those that the scene names, those that were found in there, and a picture to compare
/// with (may be empty). The scene's own file is the document's.
std::vector<fs::path> files_in_use(const Scene& scene, const SetLoader& loader, const fs::path& reference);

/// Outdates the layers that are made of these files, so that they are loaded again.
void outdate_layers_of(const std::vector<fs::path>& files, const Scene& scene, SetLoader& loader);

}  // namespace astrosplat
