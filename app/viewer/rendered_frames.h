// Frames of the output's files, read ahead in the background and kept, so that they play. In: the files that
// are wanted. Out: their pictures: scene light, to be seen through the viewport's view, or display values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/worker.h"

namespace astrosplat {

/// RGB, the first row on top, in one of two ways.
struct FrameOnDisk {
    std::int64_t width = 0, height = 0;
    std::vector<std::uint8_t> codes;   // display values, 255 is 1
    std::vector<std::uint16_t> light;  // linear, primaries of Rec. 709, as half floats
    std::string error;                 // one line: it cannot be read
    bool is_light() const { return !light.empty(); }
    std::size_t bytes() const { return codes.size() + light.size() * sizeof(std::uint16_t); }
};

/// For a texture.
Image to_image(const FrameOnDisk& frame);

class RenderedFrames {
  public:
    /// Pictures are read at most `most_px` wide and high, and kept up to about `most_bytes` of them.
    explicit RenderedFrames(std::int64_t most_px = 1280, std::size_t most_bytes = std::size_t{512} << 20);

    /// These files are read, the first one first, unless they are there as they now lie on the disk. Returns
    /// at once.
    void want(const std::vector<std::filesystem::path>& files);
    /// Null while it is not read, or not wanted.
    std::shared_ptr<const FrameOnDisk> found(const std::filesystem::path& file) const;
    /// Something wanted is not read yet.
    bool working() const;

  private:
    struct Kept {
        std::filesystem::file_time_type written;
        std::shared_ptr<const FrameOnDisk> frame;  // null: not read yet
    };
    Worker::Task next_task();
    void read(const std::filesystem::path& file, std::filesystem::file_time_type written);
    void forget_some();

    std::int64_t most_px_;
    std::size_t most_bytes_;
    std::vector<std::filesystem::path> wanted_;
    std::map<std::filesystem::path, Kept> kept_;
    Worker worker_{[this] { return next_task(); }};
};

}  // namespace astrosplat
