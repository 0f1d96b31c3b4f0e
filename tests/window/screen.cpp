// The server says which display it took; it ends with the test, however that ends. Files are dropped by the
// dragging side of XDND 5, which file managers speak: enter, position, drop, and the list of files when the
// window asks for it.
#include "window/screen.h"

#include <X11/Xatom.h>
#include <X11/Xutil.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>

namespace astrosplat::test {

struct Screen::Impl {
    std::string name;
    pid_t server = -1;
    ::Display* connection = nullptr;

    /// The one window with a title; 0: none.
    ::Window window() const;
    std::string title_of(::Window window) const;
};

namespace {

// A window may vanish between two questions about it.
int ignore_error(::Display*, XErrorEvent*) { return 0; }

/// Begins Xvfb; returns its process and the number of its display, which it writes into a pipe.
pid_t begin_server(const std::string& geometry, std::string& number) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const std::string fd = std::to_string(ends[1]);
    const pid_t process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        close(ends[0]);
        const int nowhere = open("/dev/null", O_RDWR);
        for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
        execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", geometry.c_str(), "-nolisten", "tcp",
               static_cast<char*>(nullptr));
        _exit(127);
    }
    close(ends[1]);
    for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    return process;
}

/// file:// addresses, one a line.
std::string uri_list(const std::vector<fs::path>& files) {
    constexpr const char* digits = "0123456789ABCDEF";
    std::string text;
    for (const fs::path& file : files) {
        text += "file://";
        for (const char c : fs::absolute(file).string()) {
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
        const auto list = long(atom("text/uri-list"));
        send("XdndEnter", 5L << 24, list, 0, 0);
        send("XdndPosition", 0, long(x) << 16 | y, CurrentTime, long(atom("XdndActionCopy")));
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
        const long words[] = {long(own_), l1, l2, l3, l4};
        for (int i = 0; i < 5; ++i) event.xclient.data.l[i] = words[i];
        XSendEvent(x_, target_, False, NoEventMask, &event);
        XFlush(x_);
    }

    void hand_over(const XSelectionRequestEvent& wish) const {
        XChangeProperty(x_, wish.requestor, wish.property, wish.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(text_.data()), int(text_.size()));
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

int count_of(const Pixels& pixels, std::uint32_t color) {
    const std::uint32_t rgb = (color & 0xFF) << 16 | (color & 0xFF00) | (color >> 16 & 0xFF);
    return int(std::count(pixels.rgb.begin(), pixels.rgb.end(), rgb));
}

Screen::Screen(int width, int height) : impl_(std::make_unique<Impl>()) {
    std::string number;
    impl_->server = begin_server(std::to_string(width) + "x" + std::to_string(height) + "x24", number);
    impl_->name = ":" + number;
    XSetErrorHandler(ignore_error);
    if (!number.empty()) impl_->connection = XOpenDisplay(impl_->name.c_str());
    if (!impl_->connection) throw std::runtime_error("Xvfb does not start");
}

Screen::~Screen() {
    if (impl_->connection) XCloseDisplay(impl_->connection);
    kill(impl_->server, SIGTERM);
    waitpid(impl_->server, nullptr, 0);
}

const std::string& Screen::display() const { return impl_->name; }

Pixels Screen::pixels(const Area& area) const {
    ::Display* x = impl_->connection;
    Pixels pixels;
    XImage* image = XGetImage(x, DefaultRootWindow(x), area.x, area.y, unsigned(area.width),
                              unsigned(area.height), AllPlanes, ZPixmap);
    if (!image) throw std::runtime_error("no picture of the screen");
    pixels.width = image->width;
    pixels.height = image->height;
    for (int row = 0; row < image->height; ++row)
        for (int column = 0; column < image->width; ++column)
            pixels.rgb.push_back(std::uint32_t(XGetPixel(image, column, row) & 0xFFFFFF));
    XDestroyImage(image);
    return pixels;
}

std::string Screen::Impl::title_of(::Window window) const {
    char* text = nullptr;
    if (!XFetchName(connection, window, &text) || !text) return "";
    const std::string title = text;
    XFree(text);
    return title;
}

::Window Screen::Impl::window() const {
    ::Window root = 0, parent = 0, *children = nullptr, found = 0;
    unsigned count = 0;
    XQueryTree(connection, DefaultRootWindow(connection), &root, &parent, &children, &count);
    for (unsigned i = 0; i < count; ++i) {
        XWindowAttributes attributes;
        if (!XGetWindowAttributes(connection, children[i], &attributes)) continue;
        if (attributes.map_state == IsViewable && !title_of(children[i]).empty()) found = children[i];
    }
    if (children) XFree(children);
    return found;
}

std::string Screen::title() const {
    const ::Window window = impl_->window();
    return window ? impl_->title_of(window) : "";
}

Area Screen::window_area() const {
    XWindowAttributes a{};
    const ::Window window = impl_->window();
    if (!window || !XGetWindowAttributes(impl_->connection, window, &a)) return {};
    return {a.x, a.y, a.width, a.height};
}

void Screen::set_dpi(int dpi) const {
    const std::string resources = "Xft.dpi:\t" + std::to_string(dpi) + "\n";
    XChangeProperty(impl_->connection, DefaultRootWindow(impl_->connection), XA_RESOURCE_MANAGER, XA_STRING,
                    8, PropModeReplace, reinterpret_cast<const unsigned char*>(resources.data()),
                    int(resources.size()));
    XSync(impl_->connection, False);
}

void Screen::focus() const {
    XSetInputFocus(impl_->connection, impl_->window(), RevertToPointerRoot, CurrentTime);
    XSync(impl_->connection, False);
}

bool Screen::drop(const std::vector<fs::path>& files, glm::vec2 at) const {
    const ::Window window = impl_->window();
    if (!window) return false;
    DragSource source(impl_->connection, window, uri_list(files));
    return source.drop(int(at.x), int(at.y));
}

}  // namespace astrosplat::test
