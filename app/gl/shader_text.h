// The GLSL sources of shaders/ and shaders/shared, compiled into the program.
#pragma once

#include <string>

namespace astrosplat {

/// Text of "look.glsl" and the like. Asking for one that does not exist is our own
/// mistake (std::logic_error).
std::string shader_text(const std::string& name);

}  // namespace astrosplat
