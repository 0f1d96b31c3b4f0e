// A movie seen in the window: read back by ffmpeg at the movie's own rate, over and over. In: its file, and
// the size to fit it into. Out: a texture with the frame that is due.
#pragma once

#include <glm/vec2.hpp>

#include "farm/child_process.h"
#include "gl/objects.h"
#include "viewer/files.h"

namespace astrosplat {

class MoviePlayer {
  public:
    /// Plays this file, on black of the shape that `fit_px` had at its beginning; none where it is empty.
    /// Call it every frame. Throws OutputError where ffmpeg cannot be started or finds no frame in the file.
    void want(const fs::path& movie, glm::ivec2 fit_px);
    /// Its found() is null before the first frame.
    const UploadedImage<PackedImage>& image() const { return image_; }

  private:
    fs::path movie_;
    glm::ivec2 size_px_{0};
    std::optional<ChildProcess> process_;
    std::string bytes_;  // of the next frame, as far as it has come
    UploadedImage<PackedImage> image_;
};

}  // namespace astrosplat
