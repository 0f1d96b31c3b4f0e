// OpenGL's objects as values that own them: each is created where it is first needed, moves, and goes with
// its owner. They know nothing but their name; what is done with them stays plain OpenGL.
#pragma once

#include <glad/gl.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace astrosplat {

/// Kind has static create(GLuint*) and destroy(GLuint*).
template <class Kind>
class GlObject {
  public:
    GlObject() = default;
    ~GlObject() { reset(); }
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        if (this != &other) {
            reset();
            name_ = std::exchange(other.name_, 0);
        }
        return *this;
    }

    /// The object's name; made at the first call.
    GLuint get() {
        if (name_ == 0) Kind::create(&name_);
        return name_;
    }
    /// 0 before the first get().
    GLuint name() const { return name_; }
    void reset() {
        if (name_ != 0) Kind::destroy(&name_);
        name_ = 0;
    }

  private:
    GLuint name_ = 0;
};

struct TextureKind {
    static void create(GLuint* name) { glGenTextures(1, name); }
    static void destroy(GLuint* name) { glDeleteTextures(1, name); }
};
struct BufferKind {
    static void create(GLuint* name) { glGenBuffers(1, name); }
    static void destroy(GLuint* name) { glDeleteBuffers(1, name); }
};
struct VertexArrayKind {
    static void create(GLuint* name) { glGenVertexArrays(1, name); }
    static void destroy(GLuint* name) { glDeleteVertexArrays(1, name); }
};
struct FramebufferKind {
    static void create(GLuint* name) { glGenFramebuffers(1, name); }
    static void destroy(GLuint* name) { glDeleteFramebuffers(1, name); }
};

using GlTexture = GlObject<TextureKind>;
using GlBuffer = GlObject<BufferKind>;
using GlVertexArray = GlObject<VertexArrayKind>;
using GlFramebuffer = GlObject<FramebufferKind>;

/// Of the bound texture: filter, no mip levels, edges clamped.
void set_sampling(GLenum target, GLenum filter);

/// A texture that can be drawn into.
class GlTarget {
  public:
    /// Makes it this large, if it is not; `format` is GL_RGBA32F or GL_RGBA8. The contents are undefined
    /// afterwards. Throws std::runtime_error where the driver cannot draw into such a texture.
    void resize(int width, int height, GLenum format);
    /// Draws go here, viewport over the whole.
    void bind();
    GLuint texture() const { return texture_.name(); }
    GLuint framebuffer() const { return framebuffer_.name(); }
    int width() const { return width_; }
    int height() const { return height_; }

  private:
    GlTexture texture_;
    GlFramebuffer framebuffer_;
    int width_ = 0, height_ = 0;
};

/// A triangle over the whole of the bound target, as screen_vertex.glsl makes it without any array.
class WholeTarget {
  public:
    void draw();

  private:
    GlVertexArray nothing_;
};

/// The pixels of a framebuffer as 8-bit RGBA, top row first.
std::vector<unsigned char> read_rgba8(GLuint framebuffer, int width, int height);

/// Binds a texture to a unit.
void bind_texture(int unit, GLenum target, GLuint texture);

}  // namespace astrosplat
