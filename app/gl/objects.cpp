#include "gl/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>

namespace astrosplat {

void set_sampling(GLenum target, GLenum filter) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

void GlTarget::resize(int width, int height, GLenum format) {
    width = std::max(width, 1);
    height = std::max(height, 1);
    if (width == width_ && height == height_) return;
    glBindTexture(GL_TEXTURE_2D, texture_.get());
    const GLenum type = format == GL_RGBA8 ? GL_UNSIGNED_BYTE : GL_FLOAT;
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, GL_RGBA, type, nullptr);
    set_sampling(GL_TEXTURE_2D, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error(fmt::format("OpenGL cannot draw into a frame of {} x {} px", width, height));
    width_ = width;
    height_ = height;
}

void GlTarget::bind() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
    glViewport(0, 0, width_, height_);
}

void WholeTarget::draw() {
    glBindVertexArray(nothing_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

std::vector<unsigned char> read_rgba8(GLuint framebuffer, int width, int height) {
    const auto row = static_cast<std::size_t>(width) * 4, rows = static_cast<std::size_t>(height);
    std::vector<unsigned char> bottom_up(row * rows), top_down(row * rows);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bottom_up.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    for (std::size_t y = 0; y < rows; ++y)
        std::copy_n(bottom_up.data() + (rows - 1 - y) * row, row, top_down.data() + y * row);
    return top_down;
}

void bind_texture(int unit, GLenum target, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, texture);
    glActiveTexture(GL_TEXTURE0);
}

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

}  // namespace astrosplat
