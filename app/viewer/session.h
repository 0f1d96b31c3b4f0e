// Everything of the viewer but the window: the document, its sets, the frames and jobs, brought forward
// once per frame. The window and the screenshot both drive it; behind what they call come the functions that
// the session's source files share. In: the session. Out: its changed state, above all Status for the
// widgets. Needs a current OpenGL context.
#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <set>
#include <tuple>

#include "edit/document.h"
#include "edit/kept_files.h"
#include "edit/preferences.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "farm/child_process.h"
#include "gl/display.h"
#include "gl/objects.h"
#include "gui/gui.h"
#include "output/metadata.h"
#include "viewer/comparison.h"
#include "viewer/files.h"
#include "viewer/movie_player.h"
#include "viewer/picture_starts.h"
#include "viewer/render_queue.h"
#include "viewer/set_loader.h"
#include "viewer/view_frame.h"
#include "viewer/view_motion.h"
#include "viewer/viewer.h"

namespace astrosplat {

/// The message that is seen, and since when.
struct MessageAge {
    std::uint64_t number = 0;
    double since = 0.0;  // s
};

/// What decides how the frames of the timeline look, but for the frame itself.
struct FramesContext {
    std::uint64_t revision = 0, files = 0;  // of the document, of its files
    ViewKind view = ViewKind::camera;
    FreeCamera free;
    std::set<std::string> solo;
    glm::ivec2 size_px{0};
    Region region;
    std::vector<const SplatSet*> sets;  // one a layer
    bool operator==(const FramesContext&) const = default;
};

/// Document, view and status, and the parts that each keep a state of their own.
struct Session {
    /// Opens options.input, or the demo. Throws InputError.
    Session(const ViewerOptions& options, const GlInfo& gl_info);

    GlInfo gl;
    CardChoice card_choice;
    Preferences preferences;
    ViewState view;
    Status status;
    Document document;

    SetCache cache;
    SetWishes sets;
    std::shared_ptr<PictureFiles> files = std::make_shared<PictureFiles>();
    std::shared_ptr<FinalFrames> final_frames = std::make_shared<FinalFrames>();
    std::optional<FramesContext> frames_context;  // of Status::final_frames; none: to be counted again
    std::uint64_t final_frames_dropped = 0;       // until then
    std::optional<double> frame_looked_for;       // the next one; none: all have been
    ViewFrame view_frame;                         // A
    SnapshotList snapshots;
    Comparison comparison;
    DifferenceMeter difference;
    ReferenceAlignment alignment;
    FrontCheck front;
    UploadedImage<FrontFound> front_difference;
    PreparePreview preparation{prepare_preview()};
    UploadedImage<PreparedView> preparation_before, preparation_after;
    std::unique_ptr<Card> card;  // of the window's own context, that draws previews
    bool card_asked = false;     // there is one, or there will be none
    Display display;
    ColorManagement color;
    /// What the scopes' pictures are of: Display::version(), and which were chosen.
    std::pair<std::uint64_t, std::array<bool, scope_count>> scopes_of;
    std::array<ImageTexture, scope_count> scope_textures;
    CameraOverlay overlay;
    Navigator navigator;
    Playback playback;
    WatchedFiles disk;
    RenderQueue jobs;
    RenderEstimate estimate;  // of the render dialog
    /// Revision and file of the document, and the task, that the command in the status is of.
    std::optional<std::tuple<std::uint64_t, fs::path, RenderTask>> command_source;
    FinishedFrames finished{finished_frames()};
    std::pair<fs::path, FrameHeader> finished_header;  // of the file looked at
    UploadedImage<FinishedView> finished_image;
    RenderedFrames rendered;
    UploadedImage<PackedImage> rendered_image;
    MoviePlayer movie;
    PictureStarts starts;
    KindViews kind_views;
    std::vector<Assignment> assignments;              // `--set`, of the picture that is open
    std::optional<fs::path> kinds_of;                 // the picture of Status::kinds
    std::map<SkyObject, ImageTexture> kind_textures;  // of the picture of view.start
    Thumbnails thumbnails;
    std::map<ListedPicture, ImageTexture> thumbnail_textures;  // of those that are seen
    std::optional<ChildProcess> file_manager;                  // that a folder was opened with
    Autosave autosave{autosave_folder(), autosave_interval(preferences.settings)};

    bool quitting = false, fresh_demo = false;
    Commands after_start;                  // asked for together with the picture that is on its way
    bool opens_input = false;              // the picture that the program was started with is on its way
    bool viewport_is_frame = false;        // for a screenshot without panels
    std::int64_t fixed_splats = 0;         // of the preview; 0: by the frame rate
    std::optional<fs::path> screenshot;    // asked for: the caller reads the window and saves it
    std::optional<std::string> clipboard;  // text for it
    MessageAge message_age;
    double memory_counted_at = -1e9;  // s
    std::string missed_frames;        // what was said of the camera's
    Commands dropped;  // from files, to be shown to the widgets, which ask about unsaved changes

    double frame_took_s = 0.0;  // the last frame of the window, until it was shown

    // Of the last draw_viewport():
    ViewRequest request;
    glm::ivec2 viewport_px{0};
    DisplaySettings displayed;

    ShownView shown() const { return {request, viewport_px, status.box}; }
};

/// Loads what the scene needs and takes what jobs have to say. `now` in seconds.
void advance(Session& session, double now);
/// Draws the viewport's content at its size in px into Status::viewport_texture. `hurry`: the final one now.
void draw_viewport(Session& session, glm::ivec2 viewport_px, double now, bool hurry = false);
/// Mouse and keyboard over the viewport, after the widgets drew.
void navigate(Session& session, const ViewportInput& input, double now);
/// Carries them out and empties the list; errors become the message line.
void carry_out(Session& session, Commands& commands);
/// Files dropped on the window.
void drop(Session& session, const std::vector<fs::path>& files);

/// Of a session in which nothing goes on: it looks at the disk and saves by itself.
constexpr double idle_due_s = 1.0;
/// Seconds until something is due by itself; 0: draw again at once.
double next_due(const Session& session, double now);
/// The preview is that of the present camera, look and sets.
bool preview_exact(const Session& session);
/// The frame is final.
bool settled(const Session& session);
std::string title(const Session& session);

/// For the message line and the log.
void say(Status& status, const std::string& text, bool error = false);
/// A scene, or anything that becomes one; that of a picture is made in the background. Throws InputError.
void open_file(Session& session, const fs::path& file);
/// The scene of a picture that is made in the background is there; until then Status::starting says how far
/// it is. Throws InputError, OutputError where it cannot be made and the program was started with it; else
/// the message line says so.
void take_start(Session& session);
/// Waits for that. Throws likewise.
void wait_for_start(Session& session);

/// For screenshots: the preview draws a fixed number of splats instead of one that holds a frame rate; and
/// where the panels are left out, the whole viewport is the frame, whatever the output's aspect.
void prepare_screenshot(Session& session, bool with_panels);
void save_screenshot(Session& session, const fs::path& file, int width, int height,
                     const std::vector<unsigned char>& rgba);

/// What the files of the layers that are loaded and of the sky say of themselves. Throws InputError.
ObjectMetadata source_metadata(const Session& session);
/// Of the scene, else of those files.
std::string credit_of(const Session& session);

/// For SIGTERM: writes an autosave, which stays, and throws Cancelled.
[[noreturn]] void interrupt(Session& session);
/// A clean end: autosaves of this session are removed, preferences written.
void close(Session& session, int window_width, int window_height);

// session.cpp

/// Another document in place of the one that is open.
void take_document(Session& session, Document next);
/// The demo as an untitled scene. Throws InputError where it is not installed.
Document demo_document(std::span<const Assignment> assignments = {});
/// The scene of the picture that was opened is made again, in the background: Command::start_again. Throws
/// InputError.
void start_again(Session& session, const std::string& choice);
/// What was there stays. Says so.
void cancel_start(Session& session);
/// Offers to choose a picture for a layer whose mesh has none; takes an older offer back.
void offer_picture(Session& session, std::size_t layer);
/// The first of File > Open recent.
void note_recent(Session& session, const fs::path& file);
/// Fills Status::recoveries.
void find_recoveries(Status& status);
/// Says in the message line why the frame or a layer failed, once for as long as it does.
void say_new_errors(Status& status);
/// Messages that are no errors leave the message line after a while; they stay in the log. `now` in seconds.
void forget_old_message(Status& status, MessageAge& age, double now);

// session_commands.cpp

/// Throws InputError, OutputError.
void carry_out(Session& session, const Command& command);

// session_view.cpp

/// Where the whole of the request's frame lies in the viewport, px.
Rect frame_in_viewport(const Session& session);
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
/// Sets camera.focus_distance at the view's frame, as a keyframe where it is animated, to that of what is
/// seen at a place of the viewport, px, whatever camera it is seen through, and ends
/// ViewState::picking_focus. Where nothing is seen it says so. Throws InputError where it cannot be set.
void pick_focus_at(Session& session, glm::dvec2 mouse_px);

// session_images.cpp: images in place of the frame or beside it. All need OpenGL's context.

/// The frames on disk in place of the preview (ViewState::show_rendered), while scrubbing and playing: reads
/// the one that is looked at and those after it, and fills Status::rendered_frame and missing_frame. True:
/// `shown` now shows a file's frame within `place`.
bool show_rendered_frame(Session& session, const Rect& place, DisplaySettings& shown);
/// The movie in place of all else (ViewState::movie). True: `shown` now shows a frame of it.
bool show_movie(Session& session, DisplaySettings& shown);
/// Compares the front of `now`, the scene as it stands, with its picture while A is at rest, and fills
/// Status::front; shows the signed difference in place of all else where that is looked at.
void show_front(Session& session, const Scene& now, DisplaySettings& shown);
/// Fills Status::preparation with the selected layer's picture, small, while the panel's section is open.
void show_preparation(Session& session);
/// Fills Status::thumbnails with those of view.listed_pictures that are read; the others' textures go.
void show_thumbnails(Session& session);
/// Fills Status::kinds with views of what the picture of view.start may be, while its card is shown.
void show_kinds(Session& session);
/// Fills Status::scopes, where they are open, with those of what display draws last.
void show_scopes(Session& session);
/// Starts to align the reference with what the view shows now. Throws InputError where nothing is shown.
void begin_alignment(Session& session);
/// Places the reference where that was found, or says that it was not.
void take_alignment(Session& session);
/// Brings the jobs forward and fills their part of the status. `now` in seconds. Throws what a job throws
/// that cannot begin.
void show_renderings(Session& session, double now);

}  // namespace astrosplat
