// A picture on the GPU that the processor fills: images in, a texture out.
#pragma once

#include "core/image.h"

namespace astrosplat {

/// A picture on the GPU that the processor fills, whole or tile by tile. RGBA32F, top row first.
class PictureTexture {
  public:
    PictureTexture();
    ~PictureTexture();
    PictureTexture(PictureTexture&&) noexcept;
    PictureTexture& operator=(PictureTexture&&) noexcept;
    void upload(const Image& rgba);
    /// Only this part of `rgba` (whose size is that of the last upload).
    void upload(const Image& rgba, const Region& part);
    unsigned handle() const;  // 0 before the first upload
    int width() const;
    int height() const;

  private:
    unsigned texture_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace astrosplat
