// Images on the GPU that the processor fills: images in, textures out.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <utility>

#include "core/image.h"
#include "gl/objects.h"

namespace astrosplat {

/// Filled whole or tile by tile. RGBA32F, top row first.
class ImageTexture {
  public:
    void upload(const Image& rgba);
    /// Only this part of `rgba` (whose size is that of the last upload).
    void upload(const Image& rgba, const Region& part);
    /// The same, shown between its pixels where it is drawn at another size.
    void upload_smooth(const Image& rgba);
    GLuint handle() const { return texture_.name(); }  // 0 before the first upload
    glm::vec2 size_px() const { return {static_cast<float>(width_), static_cast<float>(height_)}; }

  private:
    GlTexture texture_;
    std::int64_t width_ = 0, height_ = 0;
};

/// Something that was found, with its picture on the GPU, where it goes once.
template <class Found>
class ShownPicture {
  public:
    /// Shows the picture `image_of(*found)`, unless it is what is shown; null: nothing is shown.
    template <class ImageOf>
    void show(std::shared_ptr<const Found> found, const ImageOf& image_of) {
        if (found == found_) return;
        found_ = std::move(found);
        ++version_;
        if (found_) texture_.upload_smooth(image_of(*found_));
    }
    void clear() { found_.reset(); }

    /// Null: nothing is shown.
    const Found* found() const { return found_.get(); }
    GLuint texture() const { return found_ ? texture_.handle() : 0; }
    glm::vec2 size_px() const { return texture_.size_px(); }
    float aspect() const { return size_px().x / size_px().y; }  // width / height
    /// Grows whenever another picture is shown.
    std::uint64_t version() const { return version_; }

  private:
    std::shared_ptr<const Found> found_;
    ImageTexture texture_;
    std::uint64_t version_ = 0;
};

/// A texture as the widgets name it.
inline void* to_handle(GLuint texture) {
    return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture));
}

/// A number that another image at the same address hardly has.
float content_probe(const Image& image);

}  // namespace astrosplat
