// Small pictures of files, read in the background: thumbnails of a folder, frames of the output while they
// are played, and the finished frame of a job. In: files. Out: images for textures.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "edit/listed_picture.h"
#include "scene/scene.h"
#include "viewer/background_work.h"

namespace astrosplat {

/// RGB on black, the first row on top, in one of two ways that take little memory.
struct PackedPicture {
    std::int64_t width = 0, height = 0;            // px
    std::int64_t file_width = 0, file_height = 0;  // px of the picture in the file
    std::vector<std::uint8_t> codes;               // display values, 255 is 1
    std::vector<std::uint16_t> light;              // linear, primaries of Rec. 709, as half floats
    std::string error;                             // one line: it cannot be read
    bool is_light() const { return !light.empty(); }
    std::size_t bytes() const {
        return sizeof(PackedPicture) + codes.size() + light.size() * sizeof(std::uint16_t);
    }
};

/// RGBA, opaque, for a texture.
Image to_image(const PackedPicture& picture);

/// The longer side is at most `most_px`. FITS is stretched as it is where nothing is set, linear light gets
/// the screen's curve: codes. Throws InputError, Cancelled.
PackedPicture thumbnail_of_file(const std::filesystem::path& file, std::int64_t most_px,
                                const Progress& progress = {});

/// Pictures of files as a folder lists them.
class Thumbnails : public ReadAhead<ListedPicture, PackedPicture> {
  public:
    explicit Thumbnails(std::int64_t most_px = 144, std::size_t most_bytes = std::size_t{32} << 20);
    /// Small files first.
    void want(std::vector<ListedPicture> pictures);
};

/// Frames of the output's files, read ahead so that they play. Scene light stays light, to be seen through
/// the viewport's view.
class RenderedFrames {
  public:
    explicit RenderedFrames(std::int64_t most_px = 1280, std::size_t most_bytes = std::size_t{512} << 20);

    /// These files are read, the first one first, unless they are there as they now lie on the disk. Returns
    /// at once.
    void want(const std::vector<std::filesystem::path>& files);
    /// Null while it is not read, or not wanted.
    std::shared_ptr<const PackedPicture> found(const std::filesystem::path& file) const;
    bool working() const { return frames_.working(); }

  private:
    struct Key {
        std::filesystem::path file;
        std::filesystem::file_time_type written;
        auto operator<=>(const Key&) const = default;
    };
    std::map<std::filesystem::path, std::filesystem::file_time_type> wanted_;
    ReadAhead<Key, PackedPicture> frames_;
};

struct FinishedView {
    Image image;        // display values, RGBA, opaque
    std::string error;  // one line: it cannot be read
};

/// How files of scene light are seen; others are as they look.
struct FinishedRequest {
    std::filesystem::path file;
    OutputParams::View view = OutputParams::View::srgb;  // never automatic
    std::shared_ptr<const DisplayTransform> ocio;        // in place of `view`; null: none
    double exposure = 0.0;                               // stops
    bool operator==(const FinishedRequest&) const = default;
};

/// The longer side is at most `most_px`. Throws InputError.
FinishedView finished_view(const FinishedRequest& request, std::int64_t most_px);

using FinishedFrames = LatestWork<FinishedRequest, FinishedView>;
FinishedFrames::Work finished_frames(std::int64_t most_px = 720);

}  // namespace astrosplat
