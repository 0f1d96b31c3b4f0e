// EGL without a display: a graphics card of its own where there is one, else Mesa's surfaceless platform,
// which needs no device and no configuration, else the default platform with a pbuffer of one pixel.
#include "gl/objects.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cstring>
#include <map>
#include <mutex>
#include <regex>
#include <set>
#include <sstream>

#include "core/log.h"
#include "core/parallel.h"
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

/// Contexts share a display, which ends with the last of them.
class SharedDisplays {
  public:
    bool begin(EGLDisplay display) {
        const std::lock_guard lock(mutex_);
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return false;
        ++users_[display];
        return true;
    }
    void end(EGLDisplay display) {
        const std::lock_guard lock(mutex_);
        if (--users_[display] == 0) eglTerminate(display);
    }

  private:
    std::mutex mutex_;
    std::map<EGLDisplay, int> users_;
};

SharedDisplays& shared_displays() {
    static SharedDisplays displays;
    return displays;
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
    return shared_displays().begin(display) ? display : EGL_NO_DISPLAY;
}

EGLConfig pbuffer_config(EGLDisplay display) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return nullptr;
    return config;
}

/// Of a context that a reset of the card ends, rather than the process; some drivers do not make such ones.
EGLContext create_context(EGLDisplay display, EGLConfig config) {
    for (const auto& [major, minor] :
         {std::pair{4, 5}, std::pair{4, 3}, std::pair{oldest_major, oldest_minor}})
        for (const bool tells_of_resets : {true, false}) {
            const EGLint end = tells_of_resets ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY : EGL_NONE;
            const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                         major,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         minor,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
#ifndef NDEBUG
                                         EGL_CONTEXT_OPENGL_DEBUG,
                                         EGL_TRUE,
#endif
                                         end,
                                         EGL_LOSE_CONTEXT_ON_RESET,
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
        shared_displays().end(display);
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
    // Where OpenGL is drawn by the processor, its driver's threads begin like this one.
    const DenormalsAreZero as_on_cards;
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

namespace {

/// A stage's text and where its files begin. (Drivers do not agree on what "#line" with a number means.)
struct StageText {
    std::string text = "#version 410 core\nfloat as_div(float a, float b) { return a / b; }\n";
    std::vector<FileStart> files;
};

StageText stage_text(const ProgramSource& source, const std::vector<std::string>& files,
                     const std::string& head) {
    StageText stage;
    if (!source.compute.empty()) stage.text = "#version 450 core\n";
    for (const std::string& define : source.defines) stage.text += "#define " + define + "\n";
    if (!head.empty()) stage.text += head + "\n";
    for (const std::string& file : files) {
        const auto lines = std::count(stage.text.begin(), stage.text.end(), '\n');
        stage.files.push_back({file, static_cast<int>(lines) + 1});
        stage.text += shader_text(file) + "\n";
    }
    if (!source.compute.empty()) stage.text = made_precise(stage.text);
    if (source.edit) source.edit(stage.text);
    return stage;
}

template <class GetSize, class GetLog>
std::string log_of(GLuint object, GetSize get_size, GetLog get_log) {
    GLint size = 0;
    get_size(object, GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(size > 0 ? size : 1), '\0');
    get_log(object, static_cast<GLsizei>(log.size()), nullptr, log.data());
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
    return log;
}

/// A shader that lives until it has been linked.
struct Stage {
    GLuint shader;
    Stage(GLenum kind, const ProgramSource& source, const std::vector<std::string>& files,
          const std::string& head = {})
        : shader(glCreateShader(kind)) {
        const StageText stage = stage_text(source, files, head);
        const char* pointer = stage.text.c_str();
        glShaderSource(shader, 1, &pointer, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        if (compiled) return;
        const std::string log = readable_log(log_of(shader, glGetShaderiv, glGetShaderInfoLog), stage.files);
        glDeleteShader(shader);
        throw std::runtime_error("OpenGL does not take the shader " + log);
    }
    ~Stage() { glDeleteShader(shader); }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
};

/// Mesa writes "0:117(5): error", NVIDIA "0(117) : error": the number of a string, then of a line.
std::string readable_line(const std::string& line, const std::vector<FileStart>& files) {
    static const std::regex head(R"(\d+(?::(\d{1,6})|\((\d{1,6})\)?)(?!\d)(.*))");
    std::smatch parts;
    if (!std::regex_match(line, parts, head)) return line;
    const int number = std::stoi(parts[1].matched ? parts[1] : parts[2]);
    const FileStart* file = nullptr;
    for (const FileStart& candidate : files)
        if (candidate.line <= number) file = &candidate;
    return file ? fmt::format("{}:{}{}", file->name, number - file->line + 1, parts[3].str()) : line;
}

}  // namespace

std::string readable_log(const std::string& log, const std::vector<FileStart>& files) {
    std::string result;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);)
        result += (result.empty() ? "" : "; ") + readable_line(line, files);
    return result;
}

std::vector<std::string> after_projections(const std::vector<std::string>& more) {
    std::vector<std::string> files = {"lens.glsl", "angles.glsl"};
    const std::string list = shader_text("projections.inc");
    const std::regex include("#include \"([^\"]+)\"");
    for (std::sregex_iterator it(list.begin(), list.end(), include), none; it != none; ++it)
        files.push_back((*it)[1]);
    files.insert(files.end(), more.begin(), more.end());
    return files;
}

namespace {

/// Splits GLSL into words, single signs, and the blanks, comments and lines of the preprocessor between them.
std::vector<std::string> glsl_tokens(const std::string& text) {
    static const std::regex token(R"(//[^\n]*|#[^\n]*|\w[\w.]*|\s+|[^\w\s])");
    return {std::sregex_token_iterator(text.begin(), text.end(), token), {}};
}

bool is_between(const std::string& token) {
    return token.starts_with("//") || token.starts_with('#') ||
           std::isspace(static_cast<unsigned char>(token[0]));
}

}  // namespace

std::string made_precise(const std::string& text) {
    std::set<std::string> floats = {"float", "double", "vec2", "vec3", "vec4", "Float", "Real", "Vec3"};
    std::string result, last = ";", first;  // the token before, and the first of the declaration
    int braces = 0;
    bool function = false, returns = false;
    for (const std::string& token : glsl_tokens(text)) {
        if (is_between(token)) {
            result += token;
            continue;
        }
        const bool begins = last == ";" || last == "{" || last == "}";
        if (braces == 0 && begins) first = token;
        if (last == "struct") floats.insert(token);
        if (token == "{" && braces++ == 0) function = first != "struct" && first != "layout";
        const bool is_float = floats.contains(braces > 0 ? token : first);
        if (function && braces > 0 && begins && is_float)
            result += "precise ";
        else if (braces == 0 && (token == "inout" || token == "out"))
            result += "precise ";
        if (function && token == "return" && floats.contains(first)) {
            result += "{ precise " + first + " result_ =";
            returns = true;
        } else if (token == ";" && returns) {
            result += "; return result_; }";
            returns = false;
        } else {
            result += token;
        }
        if (token == "}" && --braces == 0) function = false;
        last = token;
    }
    return result;
}

std::string compute_text(const ProgramSource& source) { return stage_text(source, source.compute, {}).text; }

GlProgram::GlProgram(const ProgramSource& source) {
    program_ = glCreateProgram();
    const bool computes = !source.compute.empty();
    const Stage vertex(computes ? GL_COMPUTE_SHADER : GL_VERTEX_SHADER, source,
                       computes ? source.compute : source.vertex);
    glAttachShader(program_, vertex.shader);
    if (!source.fragment.empty()) {
        const Stage fragment(GL_FRAGMENT_SHADER, source, source.fragment, source.fragment_head);
        glAttachShader(program_, fragment.shader);  // stays until the program goes
    }
    glLinkProgram(program_);
    GLint linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (!linked) {
        const std::string log = log_of(program_, glGetProgramiv, glGetProgramInfoLog);
        glDeleteProgram(program_);
        throw std::runtime_error("OpenGL does not link the shaders of " +
                                 (computes ? source.compute : source.vertex).back() + ": " + log);
    }
    glUseProgram(program_);
    for (const auto& [sampler, unit] : source.samplers) glUniform1i(uniform(sampler.c_str()), unit);
}

GlProgram::~GlProgram() { glDeleteProgram(program_); }

}  // namespace astrosplat
