// What the window shows of renderings to files: the jobs, the command of the dialog, a finished frame.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Brings the jobs forward and fills their part of the status. `now` in seconds. Throws what a job throws
/// that cannot begin.
void show_renderings(Session& session, double now);
/// The scene has been opened: what was submitted to a farm of it before comes into the queue, once it is
/// found.
void list_earlier_jobs(Session& session);

}  // namespace astrosplat
