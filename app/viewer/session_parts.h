// Functions of a session that its source files share, by the file that defines them. In: the session. Out:
// its changed state, above all Status for the widgets.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "viewer/session.h"

namespace astrosplat {

// session.cpp

/// Another document in place of the one that is open.
void take_document(Session& session, Document next);
/// The demo as an untitled scene. Throws InputError where it is not installed.
Document demo_document(std::span<const Assignment> assignments = {});
/// Offers to choose a picture for a layer whose mesh has none; takes an older offer back.
void offer_picture(Session& session, std::size_t layer);
/// The first of File > Open recent.
void note_recent(Session& session, const std::filesystem::path& file);
/// Fills Status::recoveries.
void find_recoveries(Status& status);
/// Says in the message line why the frame or a layer failed; `said` holds what was said of those that still
/// do.
void say_new_errors(Status& status, std::set<std::string>& said);
/// Messages that are no errors leave the message line after a while; they stay in the log. `now` in seconds.
void forget_old_message(Status& status, MessageAge& age, double now);

// session_commands.cpp

/// Throws InputError, OutputError.
void carry_out(Session& session, const Command& command);

// session_view.cpp

/// The transform to display values in the viewport: the one chosen, else the scene's. Never automatic.
OutputParams::View display_view(OutputParams::View chosen, OutputParams::View of_scene);
/// Fills Status but for what commands, jobs and the disk say.
void fill_status(Session& session);
/// Fills Status::probe with the linear pixel under the mouse, px of the viewport.
void probe(Session& session, glm::dvec2 mouse_px);
/// The pixel x, y of a whole frame of which `pixels` is the region. The depth is that of `depth`, the final
/// frame's, where there is one and the pixel holds something. None outside of the region.
std::optional<PixelProbe> probe_of(const Image& pixels, const Image* depth, const Region& region,
                                   std::int64_t x, std::int64_t y);
/// Selects the layer with the most light at a place of the viewport, px; `behind`: of the others there, the
/// next one after the selected layer. Shows its box and says which one of how many it is. Where no layer
/// is seen the box goes.
void select_layer_at(Session& session, glm::dvec2 mouse_px, bool behind);

// session_pictures.cpp: pictures in place of the frame or beside it. All need OpenGL's context.

/// The frames on disk in place of the preview (ViewState::show_rendered), while scrubbing and playing: reads
/// the one that is looked at and those after it, and fills Status::rendered_frame and missing_frame. True:
/// `shown` now shows a file's frame within `place`.
bool show_rendered_frame(Session& session, const Rect& place, DisplaySettings& shown);
/// Compares the front of `now`, the scene as it stands, with its picture while A is at rest, and fills
/// Status::front; shows the signed difference in place of all else where that is looked at.
void show_front(Session& session, const Scene& now, DisplaySettings& shown);
/// The prepared picture of the selected layer, small, while the panel's section of that name is open: fills
/// Status::preparation.
void show_preparation(Session& session);
/// Fills Status::thumbnails with those of view.listed_pictures that are read; the others' textures go.
void show_thumbnails(Session& session);
/// Starts to align the reference with what the view shows now. Throws InputError where there is nothing to
/// align yet.
void begin_alignment(Session& session);
/// Places the reference where that was found, or says that it was not.
void take_alignment(Session& session);

// session_jobs.cpp

/// Brings the jobs forward and fills their part of the status. `now` in seconds. Throws what a job throws
/// that cannot begin.
void show_renderings(Session& session, double now);

}  // namespace astrosplat
