// What the menus and shortcuts ask of a session: a table from commands to what they do.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Carries out one command. Throws InputError, OutputError.
void carry_out(Session& session, const Command& command);

}  // namespace astrosplat
