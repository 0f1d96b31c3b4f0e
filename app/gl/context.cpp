// EGL without a display: a graphics card of its own where there is one, else Mesa's surfaceless platform,
// which needs no device and no configuration, else the default platform with a pbuffer of one pixel.
#include "gl/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/log.h"
#include "core/text.h"

namespace astrosplat {
namespace {

constexpr int oldest_major = 4, oldest_minor = 1;
constexpr const char* no_context = "no OpenGL 4.1 context can be had";

bool lists(const char* extensions, const char* name) {
    return extensions && std::strstr(extensions, name) != nullptr;
}

template <class Function>
Function egl_function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

EGLDisplay platform_display(EGLenum platform, void* native) {
    const auto get = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    return get ? get(platform, native, nullptr) : EGL_NO_DISPLAY;
}

/// The first device that is not the processor itself.
EGLDisplay hardware_display() {
    const auto list = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto text = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (!list || !text || !list(16, devices, &count)) return EGL_NO_DISPLAY;
    for (int i = 0; i < count; ++i)
        if (!lists(text(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software"))
            return platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i]);
    return EGL_NO_DISPLAY;
}

constexpr int attempts = 3;

/// The display to try in this attempt, initialised; EGL_NO_DISPLAY where there is none.
EGLDisplay open_display(int attempt) {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDisplay display = EGL_NO_DISPLAY;
    if (attempt == 0 && lists(client, "EGL_EXT_platform_device")) display = hardware_display();
    if (attempt == 1 && lists(client, "EGL_MESA_platform_surfaceless"))
        display = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
    if (attempt == 2) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_DISPLAY;
    return display;
}

EGLConfig pbuffer_config(EGLDisplay display) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return nullptr;
    return config;
}

EGLContext create_context(EGLDisplay display, EGLConfig config) {
    for (const auto& version : {std::pair{4, 5}, std::pair{4, 3}, std::pair{oldest_major, oldest_minor}}) {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     version.first,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     version.second,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
#ifndef NDEBUG
                                     EGL_CONTEXT_OPENGL_DEBUG,
                                     EGL_TRUE,
#endif
                                     EGL_NONE};
        const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
        if (context != EGL_NO_CONTEXT) return context;
    }
    return EGL_NO_CONTEXT;
}

#ifndef NDEBUG
void GLAD_API_PTR on_driver_message(GLenum, GLenum type, GLuint, GLenum severity, GLsizei,
                                    const GLchar* message, const void*) {
    if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
    log_warning(std::string("OpenGL: ") + message);
}
#endif

bool is_software(const std::string& renderer) {
    constexpr const char* names[] = {"llvmpipe", "softpipe", "swiftshader", "software rasterizer", "swr"};
    return std::ranges::any_of(names, [text = lower_case(renderer)](const char* name) {
        return text.find(name) != std::string::npos;
    });
}

}  // namespace

struct OffscreenContext::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface surface = EGL_NO_SURFACE;

    GlInfo info;
    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { close(); }

    void close() {
        if (display == EGL_NO_DISPLAY) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
        if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
        eglTerminate(display);
        display = EGL_NO_DISPLAY;
        context = EGL_NO_CONTEXT;
        surface = EGL_NO_SURFACE;
    }

    /// With no configuration and no surface, else with a pbuffer of one pixel.
    bool open(int attempt) {
        display = open_display(attempt);
        if (display == EGL_NO_DISPLAY || !eglBindAPI(EGL_OPENGL_API)) return false;
        const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
        if (lists(extensions, "EGL_KHR_surfaceless_context") &&
            lists(extensions, "EGL_KHR_no_config_context"))
            context = create_context(display, EGL_NO_CONFIG_KHR);
        if (context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
            return true;
        const EGLConfig config = pbuffer_config(display);
        if (!config) return false;
        if (context == EGL_NO_CONTEXT) context = create_context(display, config);
        const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        surface = eglCreatePbufferSurface(display, config, size);
        return context != EGL_NO_CONTEXT && surface != EGL_NO_SURFACE &&
               eglMakeCurrent(display, surface, surface, context);
    }
};

OffscreenContext::OffscreenContext() : state_(std::make_unique<State>()) {
    for (int attempt = 0; attempt < attempts; ++attempt) {
        if (state_->open(attempt)) {
            state_->info = load_gl(reinterpret_cast<GlLoader>(&eglGetProcAddress));
            return;
        }
        state_->close();
    }
    throw NoContext(std::string(no_context) + " without a display: EGL offers none");
}

OffscreenContext::~OffscreenContext() = default;

const GlInfo& OffscreenContext::info() const { return state_->info; }

GlInfo load_gl(GlLoader loader) {
    const int version = gladLoadGL(reinterpret_cast<GLADloadfunc>(loader));
    if (version == 0) throw NoContext(std::string(no_context) + ": the driver's functions do not load");
    GlInfo info;
    info.major = GLAD_VERSION_MAJOR(version);
    info.minor = GLAD_VERSION_MINOR(version);
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    info.renderer = renderer ? renderer : "";
    info.software = is_software(info.renderer);
    if (info.major < oldest_major || (info.major == oldest_major && info.minor < oldest_minor))
        throw NoContext(fmt::format("{}: {} has {}.{}", no_context, info.renderer, info.major, info.minor));
#ifndef NDEBUG
    if (glDebugMessageCallback) {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(on_driver_message, nullptr);
    }
#endif
    return info;
}

}  // namespace astrosplat
