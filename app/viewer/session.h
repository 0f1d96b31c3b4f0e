// Everything of the viewer but the window: the document, its sets, the frames and jobs, brought forward
// once per frame. The window and the screenshot both drive it. Needs a current OpenGL context.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "edit/autosave.h"
#include "edit/commands.h"
#include "edit/document.h"
#include "edit/preferences.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "farm/child_process.h"
#include "gl/context.h"
#include "gl/display.h"
#include "gl/image_texture.h"
#include "gui/gui.h"
#include "output/metadata.h"
#include "viewer/comparison.h"
#include "viewer/file_pictures.h"
#include "viewer/layer_picture.h"
#include "viewer/playback.h"
#include "viewer/render_queue.h"
#include "viewer/scene_files.h"
#include "viewer/set_wishes.h"
#include "viewer/view_frame.h"
#include "viewer/viewer_options.h"
#include "viewer/viewport_camera.h"

namespace astrosplat {

/// The inputs of a command of the render dialog.
struct CommandSource {
    std::uint64_t revision = 0;
    std::filesystem::path file;
    RenderTask task;
    bool operator==(const CommandSource&) const = default;
};

/// The message that is seen, and since when.
struct MessageAge {
    std::uint64_t number = 0;
    double since = 0.0;  // s
};

/// Document, view and status, and the parts that each keep a state of their own.
struct Session {
    /// Opens options.input, or the demo. Throws InputError.
    Session(const ViewerOptions& options, const GlInfo& gl_info);

    GlInfo gl;
    Preferences preferences;
    Document document;
    ViewState view;
    Status status;

    SetWishes sets;
    std::shared_ptr<PictureFiles> files = std::make_shared<PictureFiles>();
    ViewFrame view_frame{files};  // A
    Comparison comparison{files};
    DifferenceMeter difference;
    ReferenceAlignment alignment;
    FrontCheck front;
    ShownPicture<FrontFound> front_picture;  // the difference
    PreparePreview preparation{prepare_preview()};
    ShownPicture<PreparedView> preparation_before, preparation_after;
    Display display;
    ColorManagement color;
    CameraOverlay overlay;
    Navigator navigator;
    Playback playback;
    DiskWatch disk;
    RenderQueue jobs;
    std::optional<CommandSource> command_source;  // of the command in the status
    FinishedFrames finished{finished_frames()};
    std::pair<std::filesystem::path, FrameHeader> finished_header;  // of the file looked at
    ShownPicture<FinishedView> finished_picture;
    RenderedFrames rendered;
    ShownPicture<PackedPicture> rendered_picture;
    Thumbnails thumbnails;
    std::map<ListedPicture, ImageTexture> thumbnail_textures;  // of those that are seen
    std::optional<ChildProcess> file_manager;                  // that a folder was opened with
    Autosave autosave{autosave_folder(), autosave_interval(preferences.settings)};

    bool quitting = false, fresh_demo = false;
    bool viewport_is_frame = false;                   // for a screenshot without panels
    std::int64_t fixed_splats = 0;                    // of the preview; 0: by the frame rate
    std::optional<std::filesystem::path> screenshot;  // asked for: the caller reads the window and saves it
    std::optional<std::string> clipboard;             // text for it
    MessageAge message_age;
    double memory_counted_at = -1e9;    // s
    std::set<std::string> said_errors;  // of the frame and the layers, that still hold
    Commands dropped;  // from files, to be shown to the widgets, which ask about unsaved changes

    // Of the last draw_viewport():
    ViewRequest request;
    glm::ivec2 viewport_px{0};
    DisplaySettings displayed;

    ShownView shown() const { return {request, viewport_px, status.box}; }
};

/// Loads what the scene needs and takes what jobs have to say. `now` in seconds.
void advance(Session& session, double now);
/// Draws the viewport's content at its size in px into Status::viewport_texture. `hurry`: the final frame at
/// once.
void draw_viewport(Session& session, glm::ivec2 viewport_px, double now, bool hurry = false);
/// Mouse and keyboard over the viewport, after the widgets drew.
void navigate(Session& session, const ViewportInput& input, double now);
/// Carries them out and empties the list; errors become the message line.
void carry_out(Session& session, Commands& commands);
/// Files dropped on the window.
void drop(Session& session, const std::vector<std::filesystem::path>& files);

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
/// A scene, or anything that becomes one. Throws InputError.
void open_file(Session& session, const std::filesystem::path& file);

/// For screenshots: the preview draws a fixed number of splats instead of one that holds a frame rate; and
/// where the panels are left out, the whole viewport is the frame, whatever the output's aspect.
void prepare_screenshot(Session& session, bool with_panels);
void save_screenshot(Session& session, const std::filesystem::path& file, int width, int height,
                     const std::vector<unsigned char>& rgba);

/// For SIGTERM: writes an autosave, which stays, and throws Cancelled.
[[noreturn]] void interrupt(Session& session);
/// A clean end: autosaves of this session are removed, preferences written.
void close(Session& session, int window_width, int window_height);

}  // namespace astrosplat
