// An OpenGL context without a window: surfaceless EGL, for screenshots and tests. (GLFW 3.3 needs a display.)
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

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

}  // namespace astrosplat
