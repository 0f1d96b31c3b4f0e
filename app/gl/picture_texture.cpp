#include "gl/picture_texture.h"

#include <glad/gl.h>

#include <cassert>
#include <utility>

#include "gl/objects.h"

namespace astrosplat {

PictureTexture::PictureTexture() = default;
PictureTexture::~PictureTexture() {
    if (texture_ != 0) glDeleteTextures(1, &texture_);
}
PictureTexture::PictureTexture(PictureTexture&& other) noexcept
    : texture_(std::exchange(other.texture_, 0)), width_(other.width_), height_(other.height_) {}
PictureTexture& PictureTexture::operator=(PictureTexture&& other) noexcept {
    std::swap(texture_, other.texture_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    return *this;
}

void PictureTexture::upload(const Image& rgba) {
    assert(rgba.channels == 4);
    const auto width = static_cast<int>(rgba.width), height = static_cast<int>(rgba.height);
    const bool fits = texture_ != 0 && width == width_ && height == height_;
    if (texture_ == 0) glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    if (fits) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, rgba.pixels.data());
        return;
    }
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, rgba.pixels.data());
    set_sampling(GL_TEXTURE_2D, GL_NEAREST);
    width_ = width;
    height_ = height;
}

void PictureTexture::upload(const Image& rgba, const Region& part) {
    assert(rgba.channels == 4 && rgba.width == width_ && rgba.height == height_);
    assert(part.x >= 0 && part.y >= 0 && part.x + part.width <= width_ && part.y + part.height <= height_);
    if (part.width <= 0 || part.height <= 0) return;
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, width_);
    glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<int>(part.x), static_cast<int>(part.y),
                    static_cast<int>(part.width), static_cast<int>(part.height), GL_RGBA, GL_FLOAT,
                    rgba.at(part.x, part.y));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

unsigned PictureTexture::handle() const { return texture_; }
int PictureTexture::width() const { return width_; }
int PictureTexture::height() const { return height_; }

}  // namespace astrosplat
