// A image on the GPU that the processor fills: images in, a texture out.
#pragma once

#include "core/image.h"
#include "gl/objects.h"

namespace astrosplat {

/// A image on the GPU that the processor fills, whole or tile by tile. RGBA32F, top row first.
class ImageTexture {
  public:
    void upload(const Image& rgba);
    /// Only this part of `rgba` (whose size is that of the last upload).
    void upload(const Image& rgba, const Region& part);
    /// The same, shown between its pixels where it is drawn at another size.
    void upload_smooth(const Image& rgba);
    GLuint handle() const { return texture_.name(); }  // 0 before the first upload

  private:
    GlTexture texture_;
    std::int64_t width_ = 0, height_ = 0;
};

/// A number that another image at the same address hardly has.
float content_probe(const Image& image);

}  // namespace astrosplat
