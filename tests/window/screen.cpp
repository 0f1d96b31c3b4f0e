// The server says which display it took; it ends with the test, however that ends.
#include <X11/Xatom.h>
#include <X11/Xutil.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "window/screen_impl.h"

namespace astrosplat::test {
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

}  // namespace

int count_of(const Pixels& pixels, std::uint32_t color) {
    const std::uint32_t rgb = (color & 0xFF) << 16 | (color & 0xFF00) | (color >> 16 & 0xFF);
    return static_cast<int>(std::count(pixels.rgb.begin(), pixels.rgb.end(), rgb));
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
    XImage* image = XGetImage(x, DefaultRootWindow(x), area.x, area.y, static_cast<unsigned>(area.width),
                              static_cast<unsigned>(area.height), AllPlanes, ZPixmap);
    if (!image) throw std::runtime_error("no picture of the screen");
    pixels.width = image->width;
    pixels.height = image->height;
    for (int row = 0; row < image->height; ++row)
        for (int column = 0; column < image->width; ++column)
            pixels.rgb.push_back(static_cast<std::uint32_t>(XGetPixel(image, column, row) & 0xFFFFFF));
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
                    static_cast<int>(resources.size()));
    XSync(impl_->connection, False);
}

void Screen::focus() const {
    XSetInputFocus(impl_->connection, impl_->window(), RevertToPointerRoot, CurrentTime);
    XSync(impl_->connection, False);
}

}  // namespace astrosplat::test
