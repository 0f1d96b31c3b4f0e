// OpenGL's objects as values that own them: each is created where it is first needed, moves, and goes with
// its owner. They know nothing but their name; what is done with them stays plain OpenGL. Among them images
// that the processor fills, and programs from the files of shaders/, whose errors name our file and line
// where the driver only counts strings. And a context without a window: surfaceless EGL, for screenshots and
// tests. (GLFW 3.3 needs a display.)
#pragma once

#include <glad/gl.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/image.h"

namespace astrosplat {

/// No OpenGL context of the version needed can be had; what() is one line.
struct NoContext : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct GlInfo {
    int major = 0, minor = 0;
    std::string renderer;   // "llvmpipe (LLVM 15.0.6, 256 bits)"
    bool software = false;  // drawn by the processor: llvmpipe, softpipe, SwiftShader
};

class OffscreenContext {
  public:
    /// OpenGL 4.1 core or later, current on this thread, functions loaded. Throws NoContext.
    OffscreenContext();
    ~OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;
    const GlInfo& info() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Of the current context, whose functions this loads through `loader` (glfwGetProcAddress). Throws
/// NoContext below 4.1.
using GlLoader = void (*(*)(const char* name))(void);
GlInfo load_gl(GlLoader loader);

/// One object of the kind that these two of OpenGL's functions, as glad has loaded them, make and delete.
template <auto* generate, auto* destroy>
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
        if (name_ == 0) (*generate)(1, &name_);
        return name_;
    }
    /// 0 before the first get().
    GLuint name() const { return name_; }
    void reset() {
        if (name_ != 0) (*destroy)(1, &name_);
        name_ = 0;
    }

  private:
    GLuint name_ = 0;
};

using GlTexture = GlObject<&glGenTextures, &glDeleteTextures>;
using GlBuffer = GlObject<&glGenBuffers, &glDeleteBuffers>;
using GlVertexArray = GlObject<&glGenVertexArrays, &glDeleteVertexArrays>;
using GlFramebuffer = GlObject<&glGenFramebuffers, &glDeleteFramebuffers>;

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

/// Columns and rows of a target, from its upper left; ends excluded.
struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x1 <= x0 || y1 <= y0; }
    bool operator==(const PixelRect&) const = default;
};
inline PixelRect intersection(const PixelRect& a, const PixelRect& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

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

/// Something that was found, with its image on the GPU, where it goes once.
template <class Found>
class UploadedImage {
  public:
    /// Shows `image_of(*found)`, a function's or a member, unless it is shown; null: nothing is.
    template <class ImageOf>
    void show(std::shared_ptr<const Found> found, const ImageOf& image_of) {
        if (found == found_) return;
        found_ = std::move(found);
        ++version_;
        if (found_) texture_.upload_smooth(std::invoke(image_of, *found_));
    }
    void clear() { found_.reset(); }

    /// Null: nothing is shown.
    const Found* found() const { return found_.get(); }
    GLuint texture() const { return found_ ? texture_.handle() : 0; }
    glm::vec2 size_px() const { return texture_.size_px(); }
    float aspect() const { return size_px().x / size_px().y; }  // width / height
    /// Grows whenever another one is shown.
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

/// The GLSL of shaders/ and shaders/shared, which is compiled into the program: text of "look.glsl" and the
/// like. Asking for one that does not exist is our own mistake (std::logic_error).
std::string shader_text(const std::string& name);

/// The parts of a program. Each stage is "#version 410 core", the defines and its files one after the other.
struct ProgramSource {
    std::vector<std::string> defines = {};   // "DITHER" or "KIND 2"
    std::vector<std::string> vertex = {};    // names for shader_text()
    std::vector<std::string> fragment = {};  // empty: no fragment stage
    std::string fragment_head = {};          // GLSL before the files of the fragment stage, from elsewhere
    std::vector<std::pair<std::string, int>> samplers = {};  // and the texture unit that each reads
    /// In place of the other stages: "#version 450 core", made_precise().
    std::vector<std::string> compute = {};
    std::function<void(std::string& text)> edit = {};  // of the whole text: for tests, which plant faults
};

/// GLSL whose arithmetic no compiler contracts, reorders or approximates: all local floats, results and
/// parameters that come out are `precise`. Lines stay lines. In functions' bodies declarations begin
/// statements, and what a buffer gets is computed into a local first.
std::string made_precise(const std::string& text);

/// A compute program's text, as the driver gets it.
std::string compute_text(const ProgramSource& source);

/// The files of projection.glsl and what it needs, followed by `more`.
std::vector<std::string> after_projections(const std::vector<std::string>& more);

class GlProgram {
  public:
    /// Throws std::runtime_error: "shader look.glsl:12: ..." in the driver's words.
    explicit GlProgram(const ProgramSource& source);
    ~GlProgram();
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;

    void use() const { glUseProgram(program_); }
    GLuint name() const { return program_; }
    /// -1 where the program does not use it, which OpenGL's glUniform calls ignore.
    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }

  private:
    GLuint program_ = 0;
};

/// Where a file begins in a shader's text, lines counted from 1.
struct FileStart {
    std::string name;
    int line = 1;
};
/// The driver's compile log as one line, with "0:117" or "0(117)" at the start of its lines written
/// as "look.glsl:17".
std::string readable_log(const std::string& log, const std::vector<FileStart>& files);

}  // namespace astrosplat
