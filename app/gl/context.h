// An OpenGL context without a window: surfaceless EGL, for screenshots and tests. (GLFW 3.3 needs a display.)
#pragma once

#include <memory>
#include <string>

namespace astrosplat {

class OffscreenContext {
  public:
    /// OpenGL 4.1 core or later, current on this thread, functions loaded. Throws std::runtime_error in one
    /// line where none can be had.
    OffscreenContext();
    ~OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

struct GlInfo {
    int major = 0, minor = 0;
    std::string renderer;   // "llvmpipe (LLVM 15.0.6, 256 bits)"
    bool software = false;  // drawn by the processor: llvmpipe, softpipe, SwiftShader
};
/// Of the current context, whose functions this loads through `loader` (glfwGetProcAddress). Throws
/// std::runtime_error below 4.1.
using GlLoader = void (*(*)(const char* name))(void);
GlInfo load_gl(GlLoader loader);

}  // namespace astrosplat
