// The frames on disk in place of the preview (ViewState::show_rendered), while scrubbing and playing.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Reads the frame that is looked at and those after it, and fills Status::rendered_frame and missing_frame.
/// True: `shown` now shows a file's frame within `place`.
bool show_rendered_frame(Session& session, const Rect& place, DisplaySettings& shown);

}  // namespace astrosplat
