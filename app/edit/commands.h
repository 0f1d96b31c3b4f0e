// Requests of the user that widgets cannot do themselves, in order. The viewer empties the list every frame.
// Where a path is needed and empty, the window asks for it first (gui.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace astrosplat {

struct Command {
    enum class Kind {
        new_from_file,  // path: picture, mesh or splats become an untitled scene
        new_scene,      // text: a built-in shape; empty: a scene without layers
        open,           // path: a scene
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
        prepare_picture,  // path: folder for the files, index: layer
        cancel_render,    // the job that runs
        cancel_job,       // index: number of the job
        remove_job,       // likewise
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
    std::filesystem::path path;
    std::string text;
    std::size_t index = 0;
};
using Commands = std::vector<Command>;

}  // namespace astrosplat
