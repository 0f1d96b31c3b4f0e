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

/// The pixels that a command of `fb_height` px may change, as the backend cuts them.
PixelRect cut_of(const ImDrawCmd& command, const ImVec2& origin, int fb_height) {
    const float x0 = command.ClipRect.x - origin.x, x1 = command.ClipRect.z - origin.x;
    const float y0 = command.ClipRect.y - origin.y, y1 = command.ClipRect.w - origin.y;
    const int from_below = static_cast<int>(static_cast<float>(fb_height) - y1);
    const int height = static_cast<int>(y1 - y0), left = static_cast<int>(x0);
    const int bottom = fb_height - from_below;
    return {left, bottom - height, left + static_cast<int>(x1 - x0), bottom};
}

/// What a command draws; `frames` stands for the pixels of every texture but the font's.
DrawnCommand drawn_by(const ImDrawCmd& command, const ImDrawList& list, const ImVec2& origin, int fb_height,
                      std::uint64_t frames) {
    const ImDrawIdx* const first = list.IdxBuffer.Data + command.IdxOffset;
    std::vector<ImDrawIdx> indices(first, first + command.ElemCount);
    DrawnCommand drawn;
    if (indices.empty()) return drawn;
    const auto [least, most] = std::ranges::minmax(indices);
    for (ImDrawIdx& index : indices) index = static_cast<ImDrawIdx>(index - least);
    const std::span<const ImDrawVert> vertices(list.VtxBuffer.Data + command.VtxOffset + least,
                                               std::size_t(most - least) + 1);
    ImVec2 lo = vertices[0].pos, hi = lo;
    for (const ImDrawVert& vertex : vertices) {
        lo = {std::min(lo.x, vertex.pos.x), std::min(lo.y, vertex.pos.y)};
        hi = {std::max(hi.x, vertex.pos.x), std::max(hi.y, vertex.pos.y)};
    }
    const PixelRect cut = cut_of(command, origin, fb_height);
    const void* const texture = command.GetTexID();
    mix(drawn.hash, vertices.data(), vertices.size_bytes());
    mix(drawn.hash, indices.data(), indices.size() * sizeof(ImDrawIdx));
    mix(drawn.hash, &cut, sizeof cut);
    mix(drawn.hash, &texture, sizeof texture);
    if (texture != ImGui::GetIO().Fonts->TexID) mix(drawn.hash, &frames, sizeof frames);
    const auto whole = [](float px) { return static_cast<int>(std::clamp(px, -1e6f, 1e6f)); };
    drawn.box = intersection(cut, {whole(std::floor(lo.x - origin.x)), whole(std::floor(lo.y - origin.y)),
                                   whole(std::ceil(hi.x - origin.x)), whole(std::ceil(hi.y - origin.y))});
    return drawn;
}

DrawnFrame drawn_by(const ImDrawData& data, int fb_height, std::uint64_t frames) {
    DrawnFrame frame;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        std::vector<DrawnCommand>& drawn = frame.emplace_back();
        for (const ImDrawCmd& command : list.CmdBuffer)
            drawn.push_back(drawn_by(command, list, data.DisplayPos, fb_height, frames));
    }
    return frame;
}

/// Into the bound target.
void draw_widgets() {
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

/// Where the picture is drawn pixel by pixel, so that nothing below it is seen.
struct Cover {
    const ImDrawCmd* command = nullptr;
    PixelRect at, cut;  // the picture; what of it is drawn
    unsigned framebuffer = 0;
    int fb_height = 0;
};

/// Copies the part: drawn as a shape it would take a software rasteriser more than twice as long.
void copy_picture(const ImDrawList*, const ImDrawCmd* command) {
    const Cover& cover = *static_cast<const Cover*>(command->UserCallbackData);
    const PixelRect &at = cover.at, &cut = cover.cut;
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, cover.framebuffer);
    glBlitFramebuffer(cut.x0 - at.x0, at.y1 - cut.y1, cut.x1 - at.x0, at.y1 - cut.y0, cut.x0,
                      cover.fb_height - cut.y1, cut.x1, cover.fb_height - cut.y0, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glEnable(GL_SCISSOR_TEST);
}

template <class Call>
void for_each_command(const ImDrawData& data, const Call& call) {
    for (int i = 0; i < data.CmdListsCount; ++i)
        for (ImDrawCmd& command : data.CmdLists[i]->CmdBuffer) call(*data.CmdLists[i], command);
}

/// Of the picture in this part of the target, if it fills that.
Cover find_cover(const ImDrawData& data, const PixelRect& box, int fb_height, const ShownPicture& picture) {
    Cover cover;
    for_each_command(data, [&](const ImDrawList& list, const ImDrawCmd& command) {
        if (!picture.texture || command.GetTexID() != picture.texture || command.ElemCount != 6) return;
        const ImDrawIdx* const indices = list.IdxBuffer.Data + command.IdxOffset;
        const auto corner = [&](int k) { return list.VtxBuffer[int(command.VtxOffset) + indices[k]].pos; };
        const ImVec2 from = corner(0), to = corner(2);
        const PixelRect at{int(from.x - data.DisplayPos.x), int(from.y - data.DisplayPos.y),
                           int(to.x - data.DisplayPos.x), int(to.y - data.DisplayPos.y)};
        const bool whole_px =
            float(at.x0) == from.x - data.DisplayPos.x && float(at.y0) == from.y - data.DisplayPos.y;
        const PixelRect cut = intersection(at, cut_of(command, data.DisplayPos, fb_height));
        const bool same_size = at.x1 - at.x0 == picture.width && at.y1 - at.y0 == picture.height;
        if (whole_px && same_size && intersection(cut, box) == box) cover = {&command, at, box, 0, fb_height};
    });
    return cover;
}

/// Into this part of the bound target.
void draw_widgets(const PixelRect& box, int fb_height, const ShownPicture& picture) {
    ImDrawData& data = *ImGui::GetDrawData();
    GlFramebuffer source;
    Cover cover = find_cover(data, box, fb_height, picture);
    if (cover.command) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, cover.framebuffer = source.get());
        glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                               static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(picture.texture)), 0);
    }
    std::vector<ImDrawCmd> whole;
    bool below = cover.command != nullptr;
    for_each_command(data, [&](const ImDrawList&, ImDrawCmd& command) {
        whole.push_back(command);
        PixelRect cut = intersection(cut_of(command, data.DisplayPos, fb_height), box);
        if (&command == cover.command) {
            below = false;
            command.UserCallback = &copy_picture;
            command.UserCallbackData = &cover;
        }
        if (below) cut = {};
        command.ClipRect = {float(cut.x0) + data.DisplayPos.x, float(cut.y0) + data.DisplayPos.y,
                            float(cut.x1) + data.DisplayPos.x, float(cut.y1) + data.DisplayPos.y};
    });
    glEnable(GL_SCISSOR_TEST);
    glScissor(box.x0, fb_height - box.y1, box.x1 - box.x0, box.y1 - box.y0);
    draw_widgets();
    glDisable(GL_SCISSOR_TEST);
    auto next = whole.begin();
    for_each_command(data, [&](const ImDrawList&, ImDrawCmd& command) { command = *next++; });
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

std::vector<PixelRect> changed_boxes(const DrawnFrame& before, const DrawnFrame& now) {
    std::vector<PixelRect> boxes;
    // A box takes in those that it meets: where two are drawn nothing is drawn twice.
    const auto add = [&](PixelRect box) {
        if (box.empty()) return;
        for (std::size_t i = 0; i < boxes.size();) {
            if (intersection(boxes[i], box).empty()) {
                ++i;
                continue;
            }
            box = {std::min(box.x0, boxes[i].x0), std::min(box.y0, boxes[i].y0),
                   std::max(box.x1, boxes[i].x1), std::max(box.y1, boxes[i].y1)};
            boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
            i = 0;
        }
        boxes.push_back(box);
    };
    const std::vector<DrawnCommand> none;
    for (std::size_t i = 0; i < std::max(before.size(), now.size()); ++i) {
        std::span<const DrawnCommand> a = i < before.size() ? before[i] : none,
                                      b = i < now.size() ? now[i] : none;
        while (!a.empty() && !b.empty() && a.front() == b.front()) a = a.subspan(1), b = b.subspan(1);
        while (!a.empty() && !b.empty() && a.back() == b.back())
            a = a.first(a.size() - 1), b = b.first(b.size() - 1);
        for (const DrawnCommand& command : a) add(command.box);
        for (const DrawnCommand& command : b) add(command.box);
    }
    return boxes;
}

bool WidgetPainter::paint(int width, int height, std::uint64_t frames, const ShownPicture& picture) {
    const ImDrawData& data = *ImGui::GetDrawData();
    const bool resized = target_.width() != width || target_.height() != height;
    if (resized) forget();
    const bool whole = drawn_.empty() || data.FramebufferScale.x != 1.0f || data.FramebufferScale.y != 1.0f;
    DrawnFrame now = drawn_by(data, height, frames);
    const std::vector<PixelRect> boxes = changed_boxes(drawn_, now);
    drawn_ = std::move(now);
    if (boxes.empty()) return false;
    target_.resize(width, height, GL_RGBA8);
    target_.bind();
    if (whole) {
        draw_widgets();
        return true;
    }
    for (const PixelRect& box : boxes)
        draw_widgets(intersection(box, {0, 0, width, height}), height, picture);
    return true;
}

void WidgetPainter::copy_to(unsigned framebuffer) const {
    const int width = target_.width(), height = target_.height();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_.framebuffer());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

std::vector<unsigned char> WidgetPainter::read(int& width, int& height) const {
    width = target_.width();
    height = target_.height();
    return read_rgba8(target_.framebuffer(), width, height);
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
    painter_.reset();
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
    // What is let go while the frame is made counts as held until here only: a long frame repeats no key.
    frame_began_s_ = glfwGetTime();
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

bool Window::end_frame(std::uint64_t frames, const ShownPicture& picture) {
    ImGui::Render();
    frame_took_s_ = glfwGetTime() - frame_began_s_;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    if (!painter_->paint(width, height, frames, picture) && !damaged_) return false;
    damaged_ = false;
    painter_->copy_to(0);
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
    painter_->forget();
}

std::vector<unsigned char> Window::read(int& width, int& height) const {
    return painter_->read(width, height);
}

WidgetTarget::WidgetTarget(int width, int height) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.DeltaTime = 1.0f / 60.0f;
    apply_theme(1.0f);
    ImGui_ImplOpenGL3_Init("#version 410 core");
}

WidgetTarget::~WidgetTarget() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void WidgetTarget::begin() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
}

void WidgetTarget::end(const ShownPicture& picture) {
    ImGui::Render();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    painter_.paint(static_cast<int>(size.x), static_cast<int>(size.y), ++frames_, picture);
}

std::vector<unsigned char> WidgetTarget::read() const {
    int width = 0, height = 0;
    return painter_.read(width, height);
}

}  // namespace astrosplat
