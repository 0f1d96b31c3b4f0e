// What the widgets are told: layers, frame, machine, the pixel under the mouse.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "viewer/session.h"

namespace astrosplat {

/// Fills Status but for what commands, jobs and the disk say.
void fill_status(Session& session);

/// Says in the message line why the frame or a layer failed; `said` holds what was said of those that still
/// do.
void say_new_errors(Status& status, std::set<std::string>& said);

/// What is no error leaves the message line after a while; it stays in the log. `now` in seconds.
void forget_old_message(Status& status, MessageAge& age, double now);

/// The pixel of the whole frame at a place of the viewport, px; outside of the frame where that is.
struct FramePixel {
    std::int64_t x = 0, y = 0;
};
FramePixel frame_pixel(const Session& session, glm::dvec2 mouse_px);

/// Fills Status::probe with the linear pixel under the mouse, px of the viewport.
void probe(Session& session, glm::dvec2 mouse_px);

/// The pixel x, y of a whole frame of which `pixels` is the region. The depth is that of `depth`, the final
/// frame's, where there is one and the pixel holds something. None outside of the region.
std::optional<PixelProbe> probe_of(const Image& pixels, const Image* depth, const Region& region,
                                   std::int64_t x, std::int64_t y);

}  // namespace astrosplat
