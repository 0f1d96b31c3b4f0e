#include "viewer/window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <glad/gl.h>
#include <imgui.h>

#include <glm/vec2.hpp>
#include <initializer_list>
#include <iterator>

#include "core/hash.h"
#include "gui/gui.h"
#include "gui/widgets.h"

// glad before GLFW, which would bring the system's OpenGL header.

namespace astrosplat {
namespace {

using EventKind = InputEvent::Kind;

bool has(const std::vector<InputEvent>& frame, std::initializer_list<EventKind> kinds) {
    return std::ranges::any_of(
        frame, [&](const InputEvent& event) { return std::ranges::find(kinds, event.kind) != kinds.end(); });
}

bool is_typed(EventKind kind) { return kind == EventKind::key_down || kind == EventKind::character; }

/// A key that a text field takes no notice of, for it has the character.
bool writes(const InputEvent& event) {
    constexpr int shift = 1;
    return (event.kind == EventKind::key_down || event.kind == EventKind::key_up) &&
           event.modifiers <= shift && event.code >= ' ' && event.code <= '~';
}

/// A frame can take another character, or the key it is of, into a text: only Left, Enter and the like change
/// where it would go.
bool fits_in_text(const std::vector<InputEvent>& frame) {
    return std::ranges::none_of(frame, [](const InputEvent& event) {
        return event.kind == EventKind::press || event.kind == EventKind::release ||
               (event.kind == EventKind::key_down && !writes(event));
    });
}

/// Down again in the same frame, the key would seem to be held.
bool lets_go(const std::vector<InputEvent>& frame, int code) {
    return std::ranges::any_of(frame, [&](const InputEvent& event) {
        return event.kind == EventKind::key_up && event.code == code;
    });
}

/// A frame that has taken `frame` can take `next` too: none of those would be seen at the wrong place or in
/// the wrong order.
bool fits(const std::vector<InputEvent>& frame, const InputEvent& next) {
    if (has(frame, {EventKind::press, EventKind::release})) return false;
    switch (next.kind) {
        case EventKind::move:
            return !has(frame,
                        {EventKind::wheel, EventKind::key_down, EventKind::key_up, EventKind::character});
        case EventKind::wheel:
            return !has(frame, {EventKind::key_down, EventKind::key_up, EventKind::character});
        case EventKind::press:    // widgets below others are hovered for a frame before they can be pressed
        case EventKind::release:  // what is dragged is not moved any more by the frame in which it is let go
            return frame.empty();
        case EventKind::key_down:  // with keys held, such as Ctrl, only from the frames before
            return !has(frame, {EventKind::key_down, EventKind::character}) && !lets_go(frame, next.code);
        case EventKind::key_up:  // also of Ctrl after S
            return !has(frame, {EventKind::key_down});
        case EventKind::character:  // of the key before it
            return !has(frame, {EventKind::character});
    }
    return true;
}

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

/// Into the bound target.
void draw_widgets() {
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

/// Into the buffer that is not shown yet.
void draw_widgets(int width, int height) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    draw_widgets();
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

constexpr glm::ivec2 smallest_px(1100, 680);  // at scale 1

/// A size at scale 1 on the first monitor, no larger than that has room for.
glm::ivec2 on_monitor(glm::ivec2 size) {
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    if (!monitor) return size;
    float scale = 1.0f, vertical = 1.0f;
    glfwGetMonitorContentScale(monitor, &scale, &vertical);
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    const auto scaled = [&](int px) {
        return static_cast<int>(std::lround(float(px) * std::max(1.0f, scale)));
    };
    return {std::min(scaled(size.x), width), std::min(scaled(size.y), height)};
}

}  // namespace

std::vector<InputEvent> InputQueue::take(Typing typing) {
    const auto can_take = [&](const std::vector<InputEvent>& frame, const InputEvent& next) {
        if (typing == Typing::later && is_typed(next.kind)) return false;
        const bool text = typing == Typing::text && (next.kind == EventKind::character || writes(next));
        return text ? fits_in_text(frame) : fits(frame, next);
    };
    std::vector<InputEvent> frame;
    while (!events_.empty() && can_take(frame, events_.front())) {
        frame.push_back(events_.front());
        events_.pop_front();
    }
    return frame;
}

Window::Window(int width, int height, const std::string& title) {
    if (!glfwInit()) throw NoContext(glfw_reason("no display"));
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    const glm::ivec2 size = on_monitor({width, height}), least = on_monitor(smallest_px);
    for (const int minor :
         {5, 1}) {  // the first also draws previews; some drivers give no more than is asked
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
        if (!window_) window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    }
    if (!window_) {
        const std::string reason = glfw_reason("no OpenGL 4.1");
        glfwTerminate();
        throw NoContext(reason);
    }
    glfwSetWindowSizeLimits(window_, least.x, least.y, GLFW_DONT_CARE, GLFW_DONT_CARE);
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
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window_, false);
    listen();
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
    frame_began_s_ = glfwGetTime();  // until now, not until the frame is made, a key is known to be held
}

void Window::wake() { glfwPostEmptyEvent(); }

bool Window::begin_frame(bool opening) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (width <= 0 || height <= 0) return false;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    feed_frame(opening);
    ImGui::NewFrame();
    return true;
}

void Window::drop_frame() {
    ImGui::EndFrame();
    frame_took_s_ = glfwGetTime() - frame_began_s_;
}

bool Window::end_frame(std::uint64_t frames) {
    ImGui::Render();
    frame_took_s_ = glfwGetTime() - frame_began_s_;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    const FrameMark frame{hash_of(*ImGui::GetDrawData()), frames, width, height};
    if (frame == shown_ && !damaged_) return false;
    shown_ = frame;
    damaged_ = false;
    draw_widgets(width, height);
    glfwSwapBuffers(window_);
    return true;
}

/// The events of mouse and keyboard go into the queue rather than to Dear ImGui's backend.
void Window::listen() {
    static const auto self = [](GLFWwindow* w) { return static_cast<Window*>(glfwGetWindowUserPointer(w)); };
    glfwSetWindowFocusCallback(window_, ImGui_ImplGlfw_WindowFocusCallback);
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int entered) {
        ImGui_ImplGlfw_CursorEnterCallback(window, entered);
        double x = 0.0, y = 0.0;
        glfwGetCursorPos(window, &x, &y);
        self(window)->push({EventKind::move, 0, 0, x, y, 0.0});
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
        self(window)->push({EventKind::move, 0, 0, x, y, 0.0});
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
        if (button >= 0 && button < static_cast<int>(std::size(self(window)->button_down_)))
            self(window)->push(
                {action == GLFW_PRESS ? EventKind::press : EventKind::release, button, 0, 0, 0, 0.0});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
        self(window)->push({EventKind::wheel, 0, 0, x, y, 0.0});
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int code, int, int action, int modifiers) {
        if (action != GLFW_REPEAT && code >= 0)
            self(window)->push(
                {action == GLFW_PRESS ? EventKind::key_down : EventKind::key_up, code, modifiers, 0, 0, 0.0});
    });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
        self(window)->push({EventKind::character, static_cast<int>(character), 0, 0, 0, 0.0});
    });
}

void Window::push(InputEvent event) {
    event.time_s = glfwGetTime();
    input_.push(event);
}

void Window::feed(const InputEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.kind) {
        case EventKind::move:
            mouse_x_ = event.x;
            mouse_y_ = event.y;
            mouse_known_ = true;
            return;
        case EventKind::press:
        case EventKind::release:
            button_down_[event.code] = event.kind == EventKind::press;
            return;
        case EventKind::wheel:
            return ImGui_ImplGlfw_ScrollCallback(window_, event.x, event.y);
        case EventKind::key_down:
            ImGui_ImplGlfw_KeyCallback(window_, event.code, 0, GLFW_PRESS, event.modifiers);
            // Also those that were held before the window had the keyboard.
            io.KeyCtrl |= (event.modifiers & GLFW_MOD_CONTROL) != 0;
            io.KeyShift |= (event.modifiers & GLFW_MOD_SHIFT) != 0;
            io.KeyAlt |= (event.modifiers & GLFW_MOD_ALT) != 0;
            return;
        case EventKind::key_up:
            return ImGui_ImplGlfw_KeyCallback(window_, event.code, 0, GLFW_RELEASE, event.modifiers);
        case EventKind::character:
            return ImGui_ImplGlfw_CharCallback(window_, static_cast<unsigned>(event.code));
    }
}

void Window::feed_frame(bool opening) {
    constexpr double double_click_s = 0.3, shortest_frame_s = 1e-4;
    constexpr int longest_opening = 4;  // frames until the keyboard's focus has come to a new widget
    frames_opening_ = opening ? frames_opening_ + 1 : 0;
    const bool focus_moves = frames_until_focus_ > 0;
    frames_until_focus_ = std::max(0, frames_until_focus_ - 1);
    const bool may_type = !focus_moves && (frames_opening_ == 0 || frames_opening_ > longest_opening);
    ImGuiIO& io = ImGui::GetIO();
    const Typing typing = !may_type ? Typing::later : io.WantTextInput ? Typing::text : Typing::shortcuts;
    const std::vector<InputEvent> events = input_.take(typing);
    for (const InputEvent& event : events) feed(event);
    // Dialogs, menus and fields come a frame or two after what opens them; till then others have the focus.
    const auto moves_focus = [](const InputEvent& event) {
        const bool shifts = event.code >= GLFW_KEY_LEFT_SHIFT && event.code <= GLFW_KEY_RIGHT_SUPER;
        return event.kind == EventKind::release ||
               (event.kind == EventKind::key_down && !writes(event) && !shifts);
    };
    if (std::ranges::any_of(events, moves_focus)) frames_until_focus_ = 3;
    std::copy(std::begin(button_down_), std::end(button_down_), io.MouseDown);
    if (mouse_known_ && ImGui::IsMousePosValid(&io.MousePos))
        io.MousePos = {static_cast<float>(mouse_x_), static_cast<float>(mouse_y_)};
    // The widgets' clock stands while they catch up. When an event came is known to a frame: as much later
    // may the second click of two be seen.
    const double now = input_.empty() || events.empty() ? frame_began_s_ : events.back().time_s;
    const double step = std::max(shortest_frame_s, now - widget_time_s_);
    widget_time_s_ += step;
    io.DeltaTime = static_cast<float>(step);
    io.MouseDoubleClickTime = static_cast<float>(double_click_s + frame_took_s_);
}

bool Window::close_requested() {
    const bool asked = glfwWindowShouldClose(window_) != 0;
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
}

std::vector<fs::path> Window::take_dropped() { return std::exchange(dropped_, {}); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::size(int& width, int& height) const {
    glfwGetWindowSize(window_, &width, &height);
    width = static_cast<int>(std::lround(static_cast<float>(width) / content_scale()));
    height = static_cast<int>(std::lround(static_cast<float>(height) / content_scale()));
}

float Window::content_scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::max(1.0f, x);
}

void Window::reload_fonts() {
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

std::vector<unsigned char> Window::read(int& width, int& height) const {
    glfwGetFramebufferSize(window_, &width, &height);
    draw_widgets(width, height);  // again: not every driver lets what is shown be read
    glReadBuffer(GL_BACK);
    return read_rgba8(0, width, height);
}

WidgetTarget::WidgetTarget(int width, int height) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.DeltaTime = 1.0f / 60.0f;
    apply_theme(1.0f);
    ImGui_ImplOpenGL3_Init("#version 410 core");
    target_.resize(width, height, GL_RGBA8);
}

WidgetTarget::~WidgetTarget() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void WidgetTarget::begin() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
}

void WidgetTarget::end() {
    ImGui::Render();
    target_.bind();
    draw_widgets();
}

std::vector<unsigned char> WidgetTarget::read() const {
    return read_rgba8(target_.framebuffer(), target_.width(), target_.height());
}

}  // namespace astrosplat
