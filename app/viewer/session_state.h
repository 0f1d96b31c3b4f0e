// What a Session owns: document, view and status, and the parts that each keep a state of their own.
// session.h brings it forward; session_commands.h, session_picture.h and session_status.h are what it does.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "edit/autosave.h"
#include "edit/commands.h"
#include "edit/document.h"
#include "edit/preferences.h"
#include "edit/status.h"
#include "edit/view_state.h"
#include "gl/context.h"
#include "gl/display.h"
#include "viewer/camera_overlay.h"
#include "viewer/comparison.h"
#include "viewer/disk_watch.h"
#include "viewer/jobs.h"
#include "viewer/navigator.h"
#include "viewer/picture.h"
#include "viewer/playback.h"
#include "viewer/run_viewer.h"
#include "viewer/set_wishes.h"

namespace astrosplat {

struct SessionState {
    /// Opens options.input, or the demo. Throws InputError.
    SessionState(const ViewerOptions& options, const GlInfo& gl_info);

    GlInfo gl;
    Preferences preferences;
    Document document;
    ViewState view;
    Status status;

    SetWishes sets;
    std::shared_ptr<PictureFiles> files = make_picture_files();
    ViewPicture picture{files};  // A
    Comparison comparison{files};
    Display display;
    CameraOverlay overlay;
    Navigator navigator;
    Playback playback;
    DiskWatch disk;
    Jobs jobs;
    Autosave autosave{autosave_folder(), autosave_interval()};

    bool quitting = false, fresh_demo = false;
    bool viewport_is_picture = false;  // for a screenshot without panels
    std::int64_t fixed_splats = 0;     // of the preview; 0: by the frame rate
    std::optional<std::filesystem::path> screenshot;
    std::optional<std::string> clipboard;
    Commands dropped;  // from files, for the next frame of widgets

    // Of the last draw():
    PictureRequest request;
    glm::ivec2 viewport_px{0};

    ShownPicture shown() const { return {request, viewport_px, status.box}; }
};

/// For the message line and the log.
void say(Status& status, const std::string& text, bool error = false);
/// Another document in place of the one that is open.
void take_document(SessionState& state, Document next);
/// A scene, or anything that becomes one. Throws InputError.
void open_file(SessionState& state, const std::filesystem::path& file);
/// Fills Status::recoveries.
void find_recoveries(Status& status);

/// The demo as an untitled scene. Throws InputError where it is not installed.
Document demo_document(std::span<const Assignment> assignments = {});

}  // namespace astrosplat
