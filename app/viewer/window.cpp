#include "viewer/window.h"

#include <glad/gl.h>
// glad before GLFW, which would bring the system's OpenGL header.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "splats/checksum.h"

namespace astrosplat {
namespace {

std::string glfw_reason(const char* fallback) {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : fallback;
}

/// Takes in the bytes of one more thing.
void mix(std::uint64_t& hash, const void* bytes, std::size_t size) {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15u;  // as large as can be, so that order matters
    hash = hash * odd + xxh64({static_cast<const char*>(bytes), size});
}

/// Into the buffer that is not shown yet.
void draw_widgets(int width, int height) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

/// Of all that the widgets draw: shapes, and with which texture and within which rectangle.
std::uint64_t hash_of(const ImDrawData& data) {
    std::uint64_t hash = 0;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        mix(hash, list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.size_in_bytes()));
        mix(hash, list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.size_in_bytes()));
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const float clip[] = {command.ClipRect.x, command.ClipRect.y, command.ClipRect.z,
                                  command.ClipRect.w};
            const void* texture = command.GetTexID();
            mix(hash, clip, sizeof clip);
            mix(hash, &texture, sizeof texture);
            mix(hash, &command.ElemCount, sizeof command.ElemCount);
        }
    }
    return hash;
}

constexpr int smallest_width = 1100, smallest_height = 680;

}  // namespace

Window::Window(int width, int height, const std::string& title) {
    if (!glfwInit()) throw NoContext(glfw_reason("no display"));
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        const std::string reason = glfw_reason("no OpenGL 4.1");
        glfwTerminate();
        throw NoContext(reason);
    }
    glfwSetWindowSizeLimits(window_, smallest_width, smallest_height, GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwMakeContextCurrent(window_);
    gl_ = load_gl(reinterpret_cast<GlLoader>(glfwGetProcAddress));
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) {
        static_cast<Window*>(glfwGetWindowUserPointer(window))->damaged_ = true;
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        auto* self = static_cast<Window*>(glfwGetWindowUserPointer(window));
        for (int i = 0; i < count; ++i) self->dropped_.emplace_back(paths[i]);
    });
    // Dear ImGui's backend calls this one before its own.
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action == GLFW_PRESS && key >= 0)
            static_cast<Window*>(glfwGetWindowUserPointer(window))->pressed_.push_back({key, modifiers});
    });
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 410 core");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::wait(double seconds) {
    if (seconds > 0.0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

void Window::wake() { glfwPostEmptyEvent(); }

bool Window::begin_frame() {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (width <= 0 || height <= 0) return false;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    hold_short_presses();
    ImGui::NewFrame();
    return true;
}

bool Window::end_frame(std::uint64_t pictures) {
    ImGui::Render();
    release_short_presses();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    const FrameMark frame{hash_of(*ImGui::GetDrawData()), pictures, width, height};
    if (frame == shown_ && !damaged_) return false;
    shown_ = frame;
    damaged_ = false;
    draw_widgets(width, height);
    glfwSwapBuffers(window_);
    return true;
}

void Window::hold_short_presses() {
    ImGuiIO& io = ImGui::GetIO();
    for (const KeyPress& press : pressed_) {
        if (press.key < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[press.key] = true;
        io.KeyCtrl |= (press.modifiers & GLFW_MOD_CONTROL) != 0;
        io.KeyShift |= (press.modifiers & GLFW_MOD_SHIFT) != 0;
        io.KeyAlt |= (press.modifiers & GLFW_MOD_ALT) != 0;
    }
}

void Window::release_short_presses() {
    if (pressed_.empty()) return;
    ImGuiIO& io = ImGui::GetIO();
    const auto down = [this](int key) { return glfwGetKey(window_, key) == GLFW_PRESS; };
    for (const KeyPress& press : pressed_)
        if (press.key < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[press.key] = down(press.key);
    io.KeyCtrl = down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = down(GLFW_KEY_LEFT_ALT) || down(GLFW_KEY_RIGHT_ALT);
    pressed_.clear();
}

bool Window::close_requested() {
    const bool asked = glfwWindowShouldClose(window_) != 0;
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}

std::vector<std::filesystem::path> Window::take_dropped() { return std::exchange(dropped_, {}); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::size(int& width, int& height) const { glfwGetWindowSize(window_, &width, &height); }

float Window::content_scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::max(1.0f, x);
}

std::vector<unsigned char> Window::read(int& width, int& height) const {
    glfwGetFramebufferSize(window_, &width, &height);
    std::vector<unsigned char> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    draw_widgets(width, height);  // anew: not every driver lets what is shown be read
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_BACK);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    const std::size_t row = static_cast<std::size_t>(width) * 4;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height) / 2; ++y)
        std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(y * row),
                         pixels.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                         pixels.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
    return pixels;
}

}  // namespace astrosplat
