// manual: the manual pages astrosplat(1) and astrosplat-scene(5) as troff with the man macros, from the
// descriptions of the command line and of the scene file's keys, and from the chapters in app/manual.
#pragma once

#include <string>
#include <vector>

#include "command_words.h"

namespace astrosplat {

std::string command_manual(const std::vector<CommandWords>& commands);
std::string scene_manual();

}  // namespace astrosplat
