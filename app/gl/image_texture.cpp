#include "gl/image_texture.h"

#include <algorithm>
#include <cassert>

namespace astrosplat {

void ImageTexture::upload(const Image& rgba) {
    assert(rgba.channels == 4);
    const bool fits = handle() != 0 && rgba.width == width_ && rgba.height == height_;
    if (fits) return upload(rgba, {0, 0, width_, height_});
    width_ = rgba.width;
    height_ = rgba.height;
    glBindTexture(GL_TEXTURE_2D, texture_.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_), 0,
                 GL_RGBA, GL_FLOAT, rgba.pixels.data());
    set_sampling(GL_TEXTURE_2D, GL_NEAREST);
}

void ImageTexture::upload(const Image& rgba, const Region& part) {
    assert(rgba.channels == 4 && rgba.width == width_ && rgba.height == height_);
    assert(part.x >= 0 && part.y >= 0 && part.x + part.width <= width_ && part.y + part.height <= height_);
    if (part.width <= 0 || part.height <= 0) return;
    glBindTexture(GL_TEXTURE_2D, handle());
    glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(width_));
    glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<int>(part.x), static_cast<int>(part.y),
                    static_cast<int>(part.width), static_cast<int>(part.height), GL_RGBA, GL_FLOAT,
                    rgba.at(part.x, part.y));
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void ImageTexture::upload_smooth(const Image& rgba) {
    upload(rgba);
    set_sampling(GL_TEXTURE_2D, GL_LINEAR);
}

float content_probe(const Image& image) {
    auto sum = static_cast<float>(image.width);
    const std::size_t step = std::max<std::size_t>(1, image.pixels.size() / 97);
    for (std::size_t i = 0; i < image.pixels.size(); i += step) sum = 0.75f * sum + image.pixels[i];
    return sum;
}

}  // namespace astrosplat
