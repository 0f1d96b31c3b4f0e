// completion: scripts with which bash, zsh and fish complete the command line, from the same words as the
// help.
#pragma once

#include <string>
#include <vector>

#include "command_words.h"

namespace astrosplat {

/// `shell`: bash, zsh or fish. `keys`: what --set completes. Throws InputError for another shell.
std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands,
                              const std::vector<std::string>& keys);

}  // namespace astrosplat
