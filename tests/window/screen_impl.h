// The connection behind a Screen. Apart from screen.h, as Xlib defines short names such as Status.
#pragma once

#include <X11/Xlib.h>
#include <sys/types.h>

#include "window/screen.h"

namespace astrosplat::test {

struct Screen::Impl {
    std::string name;
    pid_t server = -1;
    ::Display* connection = nullptr;

    /// The one window with a title; 0: none.
    ::Window window() const;
    std::string title_of(::Window window) const;
};

}  // namespace astrosplat::test
