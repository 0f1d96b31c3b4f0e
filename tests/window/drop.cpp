// The dragging side of XDND 5, which file managers speak: enter, position, drop, and the list of files when
// the window asks for it.
#include <X11/Xatom.h>
#include <poll.h>

#include <chrono>
#include <optional>

#include "window/screen_impl.h"

namespace astrosplat::test {
namespace {

/// file:// addresses, one a line.
std::string uri_list(const std::vector<std::filesystem::path>& files) {
    constexpr const char* digits = "0123456789ABCDEF";
    std::string text;
    for (const std::filesystem::path& file : files) {
        text += "file://";
        for (const char c : std::filesystem::absolute(file).string()) {
            const auto byte = static_cast<unsigned char>(c);
            const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                               c == '/' || c == '.' || c == '_' || c == '-';
            if (plain)
                text += c;
            else
                text += {'%', digits[byte >> 4], digits[byte & 15]};
        }
        text += "\r\n";
    }
    return text;
}

class DragSource {
  public:
    DragSource(::Display* x, ::Window target, std::string text)
        : x_(x), target_(target), text_(std::move(text)) {
        own_ = XCreateSimpleWindow(x, DefaultRootWindow(x), -10, -10, 1, 1, 0, 0, 0);
        XSetSelectionOwner(x, atom("XdndSelection"), own_, CurrentTime);
    }
    ~DragSource() {
        XDestroyWindow(x_, own_);
        XSync(x_, False);
    }
    DragSource(const DragSource&) = delete;
    DragSource& operator=(const DragSource&) = delete;

    bool drop(int x, int y) {
        const auto list = static_cast<long>(atom("text/uri-list"));
        send("XdndEnter", 5L << 24, list, 0, 0);
        send("XdndPosition", 0, long(x) << 16 | y, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
        const auto status = wait_for("XdndStatus");
        if (!status || !(status->data.l[1] & 1)) return false;
        send("XdndDrop", 0, CurrentTime, 0, 0);
        const auto finished = wait_for("XdndFinished");
        return finished && finished->data.l[1] != 0;  // GLFW says how much it was given
    }

  private:
    Atom atom(const char* name) const { return XInternAtom(x_, name, False); }

    void send(const char* type, long l1, long l2, long l3, long l4) const {
        XEvent event = {};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(type);
        event.xclient.format = 32;
        const long words[] = {static_cast<long>(own_), l1, l2, l3, l4};
        for (int i = 0; i < 5; ++i) event.xclient.data.l[i] = words[i];
        XSendEvent(x_, target_, False, NoEventMask, &event);
        XFlush(x_);
    }

    void hand_over(const XSelectionRequestEvent& wish) const {
        XChangeProperty(x_, wish.requestor, wish.property, wish.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(text_.data()), static_cast<int>(text_.size()));
        XEvent reply = {};
        reply.xselection.type = SelectionNotify;
        reply.xselection.requestor = wish.requestor;
        reply.xselection.selection = wish.selection;
        reply.xselection.target = wish.target;
        reply.xselection.property = wish.property;
        reply.xselection.time = wish.time;
        XSendEvent(x_, wish.requestor, False, NoEventMask, &reply);
        XFlush(x_);
    }

    /// Answers what the window asks until its message of this type comes.
    std::optional<XClientMessageEvent> wait_for(const char* type) const {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point end = Clock::now() + std::chrono::seconds(60);
        while (Clock::now() < end) {
            while (XPending(x_) > 0) {
                XEvent event;
                XNextEvent(x_, &event);
                if (event.type == SelectionRequest) hand_over(event.xselectionrequest);
                if (event.type == ClientMessage && event.xclient.message_type == atom(type))
                    return event.xclient;
            }
            pollfd wakes{ConnectionNumber(x_), POLLIN, 0};
            poll(&wakes, 1, 100);
        }
        return std::nullopt;
    }

    ::Display* x_;
    ::Window target_, own_;
    std::string text_;
};

}  // namespace

bool Screen::drop(const std::vector<std::filesystem::path>& files, glm::vec2 at) const {
    const ::Window window = impl_->window();
    if (!window) return false;
    DragSource source(impl_->connection, window, uri_list(files));
    return source.drop(static_cast<int>(at.x), static_cast<int>(at.y));
}

}  // namespace astrosplat::test
