// The state of the view at the window, of which nothing is saved in a scene or reaches a rendered file:
// plain values, changed by the widgets and read by the viewer. And requests that widgets cannot do
// themselves, in order: the viewer empties the list every frame. Where a path is needed and empty, the
// window asks first.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <set>

#include "camera/camera.h"
#include "edit/command_lines.h"
#include "edit/settings.h"
#include "edit/status.h"
#include "objects/identify.h"
#include "output/inspection.h"
#include "output/scopes.h"
#include "scene/scene.h"

namespace astrosplat {

enum class CameraMove { orbit, fly_in, face_on_to_edge_on };
/// The fate of the camera's keyframes after the one at which a move begins: those later than its end
/// stay, all are moved to after it, or all are removed.
enum class LaterKeys { keep, shift, replace };

enum class ViewKind { camera, free, front, top, side };
enum class SizeMode { fit, one_to_one };  // the viewport's size, or the output's resolution
enum class CompareMode {
    a,
    wipe,
    other,  // B or the reference alone
    blink,
    difference,
    front  // where the view from the front differs from the layer's own picture
};
enum class CompareWith { b, reference };
enum class PanelTab { source, look, mixing, camera, environment, output };
/// Of the selected layer; the others are the scene's.
inline bool is_of_layer(PanelTab tab) { return tab <= PanelTab::mixing; }
enum class PlayMode { loop, ping_pong, once };
enum class PreviewEngine { automatic, card, processor };

inline constexpr std::array<const char*, scope_count> scope_names{"Histogram", "Waveform", "Vectorscope"};

enum class HandleTool { none, move, rotate, scale };
enum class HandleTarget { layer, crop, camera_target };  // the selected layer's placement, one of its crops

enum class SelectTool { none, lasso, box, brush };
/// What becomes of what is selected: erased, alone kept, or made a layer of its own.
enum class SelectionFate { erase, keep, part };

/// A camera that belongs to the window, not to the scene.
struct FreeCamera {
    glm::dvec3 position{0.0, 0.0, 10.0}, pivot{0.0}, up{0.0, 1.0, 0.0};
    Projection projection = Projection::perspective;
    double fov_deg = 45.0;                           // vertical
    double height = 10.0;                            // scene units, where rays are parallel
    double near = 0.01, far = 0.0, near_fade = 0.0;  // as CameraParams has them
    bool operator==(const FreeCamera&) const = default;
};

/// State of the window's parts that is kept between sessions.
struct PanelSizes {
    float panel_width = 360.0f, timeline_height = 148.0f;  // px at scale 1
    bool timeline_open = true;
    bool scopes_open = false;  // those that are chosen, over the view
    std::array<bool, scope_count> scopes{true, true, true};
    Settings settings;
    std::vector<fs::path> recent_folders;  // that files were chosen in, newest first
    std::vector<KeptRender> renders;       // newest first
    bool operator==(const PanelSizes&) const = default;
};

/// What a picture that was opened was taken for, and how else its scene can be made.
struct PictureStart {
    fs::path picture;
    std::optional<SkyObject> as = {};  // as a person says; none: as was found
    bool film = false;                 // with a camera move of ten seconds
    bool parted = false;               // its stars are a layer of their own
    std::int64_t most_splats = 0;      // source.splats of the picture; 0: any number

    // Filled when the scene is made:
    SkyObject object = SkyObject::galaxy;
    std::vector<ObjectGuess> guesses = {};  // of what was found, the likeliest first
    std::string seen = {};                  // "seen at 62 degrees"; may be empty
    std::string because = {};
};

struct ViewState : PanelSizes {
    std::size_t layer = 0;  // selected
    PanelTab tab = PanelTab::look;
    double frame = 1.0;
    bool playing = false;
    PlayMode play_mode = PlayMode::loop;
    std::optional<double> play_first, play_last;  // in and out points; none: the ends of the frames
    bool every_frame = false;                     // playing leaves none out, however long it takes
    bool play_final = false;                      // playing waits for every final frame
    bool show_rendered = false;                   // frames of the output's files in place of the preview

    ViewKind view = ViewKind::camera;
    FreeCamera free;
    bool lock_to_camera = false;  // moving the mouse edits the scene's camera
    SizeMode size = SizeMode::fit;
    glm::dvec2 pan_px{0.0};  // 1:1: the frame's middle from the viewport's
    double zoom = 1.0;       // 1:1: screen px per frame px

    CompareMode compare = CompareMode::a;
    float wipe = 0.5f;  // 0..1 of the frame's width; A lies to the left
    CompareWith compare_with = CompareWith::b;
    float difference_gain = 4.0f;
    float blink_hz = 2.0f;  // changes a second
    bool placing = false;   // the mouse in the view places the reference

    Inspection inspection;                                       // shown in amber while it is another
    OutputParams::View display = OutputParams::View::automatic;  // as [output] view has it
    bool gate = true, safe_areas = false, camera_path = true;
    bool selected_box = false, all_boxes = false;  // bounding boxes of layers
    bool grid = false, axes = false, scale_bar = false;
    HandleTool tool = HandleTool::none;  // handles in the view
    HandleTarget handle_target = HandleTarget::layer;
    std::size_t handle_crop = 0;           // of the selected layer
    SelectTool select = SelectTool::none;  // in place of orbiting with the left button
    SelectionFate selection = SelectionFate::erase;
    float brush_px = 24.0f, feather_px = 0.0f;  // radius, and width of the soft edge; px at scale 1
    bool picking_focus = false;  // the next click sets the camera's focus to what is seen there
    bool lying = false;          // handles of how its picture's bodies lie
    PreviewEngine engine = PreviewEngine::automatic;
    float preview_share = 0.0f;  // 0: sized to hold the frame rate; else 0..1 of every layer
    bool settle = true;          // the final frame follows by itself

    std::set<std::string> solo;  // names of layers; empty: all

    bool panels = true;  // F11
    bool graph_open = false;
    std::string graph_parameter;            // parameter shown in the timeline's graph
    std::set<std::string> hidden_channels;  // of graphs: "camera.position 1"
    std::string hovered_row;                // key of the panel's row under the mouse, set every frame
    std::string hovered_parameter;          // the same where it can be animated; K sets a keyframe
    bool preparation_open = false;          // the panel shows before and after; set every frame
    bool snapshots_open = false;
    int renamed_snapshot = -1;               // whose name is being typed; -1: none
    std::string typed_name;                  // so far
    std::optional<CameraMove> asked_move;    // the dialog of adding it is open
    LaterKeys later_keys = LaterKeys::keep;  // what that says
    bool help_open = false, log_open = false, settings_open = false, find_open = false;
    bool render_open = false;  // the dialog of:
    RenderTask render;
    bool command_open = false;  // its row with the shell's command is unfolded
    bool queue_open = false;
    std::uint64_t queue_job = 0;  // whose frames are looked at; 0: of the last one
    int queue_frame = -1;         // the finished frame that is seen; -1: the newest
    bool queue_playing = false;
    fs::path movie;                // plays in place of the frame; empty: none
    bool changed_on_disk = false;  // the line that offers Reload or Keep is shown
    std::string grey_layer;        // whose mesh has no picture: the line that offers to choose one is shown
    std::vector<ListedPicture> listed_pictures;  // rows of the file dialog that are seen; set every frame
    std::optional<PictureStart> start;           // the card over the view; gone with the first edit
    bool hint_open = false;  // "Drop a picture, mesh or splat file here. F1 shows the keys."
};

/// The references that a view shows, besides those for any.
inline ReferenceParams::View reference_view(ViewKind kind) {
    static_assert(static_cast<int>(ReferenceParams::View::side) == static_cast<int>(ViewKind::side) + 1);
    return static_cast<ReferenceParams::View>(static_cast<int>(kind) + 1);
}

/// Something other than the view is shown beside, over or in place of it.
inline bool compares(const ViewState& view) {
    return view.compare != CompareMode::a && view.compare != CompareMode::front;
}

/// The reference is compared with, over the view where nothing was compared so far.
inline void show_reference(ViewState& view) {
    view.compare_with = CompareWith::reference;
    if (!compares(view)) view.compare = CompareMode::other;
}

struct Command {
    enum class Kind {
        start_again,   // text: a kind of object, "film", "still", "part", "keep", "whole" or "splats N":
                       // ViewState::start's otherwise
        cancel_start,  // the making of a picture's scene
        new_scene,     // text: a built-in shape; empty: a scene without layers
        open,          // path: a scene; a picture, mesh or splats become an untitled one
        open_demo,
        save,
        save_as,  // path
        reload,   // from disk
        keep,     // ignore the change on disk
        recover,  // path: an autosave
        discard_recovery,
        quit,             // unsaved changes already answered for
        import_file,      // path: as a new layer
        add_shape,        // text: a built-in shape, as a new layer
        choose_picture,   // path: of a layer's first mesh, index: layer
        set_reference,    // path
        align_reference,  // to what the view shows
        import_camera,    // path: another program's camera in place of the scene's
        export_camera,    // path: the scene's camera, at the frames of [output]
        save_look,        // path: of the selected layer
        apply_look,       // path: to the selected layer
        regenerate,       // index: layer whose set is stale
        cancel_load,      // index: layer being generated
        render,           // what ViewState::render says
        choose_target,    // path: where that goes
        make_detail,      // where the camera comes close, in all layers of bodies
        prepare_picture,  // path: folder for the files, index: layer
        cancel_render,    // the job that runs
        cancel_job,       // index: number of the job
        remove_job,       // likewise
        retry_job,        // likewise
        open_folder,      // path: in the desktop's file manager
        save_view,        // path: the frame as it is seen, without the window
        screenshot,       // path
        store_b,          // the look now becomes B
        take_snapshot,
        restore_snapshot,  // index
        rename_snapshot,   // index, text
        delete_snapshot,   // index
        compare_snapshot,  // index becomes B
        show_snapshot,     // likewise, and is seen in place of A
        copy_batch_command,
        copy_text,    // text
        say,          // text: for the message line
        frame_layer,  // camera on the selected layer
        frame_all,
        add_move,  // index: CameraMove
        keep_settings
    };
    Kind kind;
    fs::path path;
    std::string text;
    std::size_t index = 0;
};
using Commands = std::vector<Command>;

}  // namespace astrosplat
