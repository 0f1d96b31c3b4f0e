// What the viewport shows: the view becomes a request for a frame; the frame and what it is compared with
// are placed in the viewport, with lines of the camera over them.
#pragma once

#include "viewer/session.h"

namespace astrosplat {

/// Any scene as it stands at the view's frame, with solo.
Scene evaluated(const Scene& scene, const ViewState& view);

/// What the viewport shows a scene through: what the person chose, else the scene. Never automatic.
OutputParams::View display_view(OutputParams::View chosen, OutputParams::View of_scene);

/// The preview is drawn by OpenGL rather than by the processor.
bool draws_by_opengl(const Session& session);

/// Draws the viewport's content at its size in px into Status::viewport_texture. `now` in seconds; `hurry`:
/// the final frame at once.
void draw_viewport(Session& session, glm::ivec2 viewport_px, double now, bool hurry = false);

}  // namespace astrosplat
