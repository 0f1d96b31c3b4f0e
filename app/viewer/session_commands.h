// What the menus and keys ask of a session: a table from commands to what they do.
#pragma once

#include "viewer/session_state.h"

namespace astrosplat {

/// Carries out one command. Throws InputError, OutputError.
void carry_out(SessionState& state, const Command& command);

}  // namespace astrosplat
