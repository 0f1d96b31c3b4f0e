// camera: the scene's camera at each frame, written in a format of other programs.
#include "commands.h"

#include <fmt/format.h>

#include "core/text.h"
#include "exit_code.h"
#include "places.h"
#include "scene/camera_file.h"
#include "scene/frames.h"
#include "scene/load.h"

namespace astrosplat {

int run_camera(const CameraOptions& options) {
    std::vector<Assignment> assignments;
    for (const std::string& text : options.assignments) assignments.push_back(parse_assignment(text));
    const Scene scene = load_scene(options.scene, assignments);
    const std::vector<std::int64_t> frames =
        options.frames ? parse_frames(*options.frames, "--frames")
                       : parse_frames(scene.output.frames, scene.file.string() + ": output.frames");
    refuse_to_overwrite(options.output, options.overwrite);
    const CameraTrack track = camera_track(scene, frames);
    write_file_atomically(options.output, camera_text(track, scene, options.output),
                          existing_of(options.overwrite));
    fmt::print("{}: {}\n", printable(options.output.string()), counted(std::ssize(frames), "frame"));
    return exit_done;
}

}  // namespace astrosplat
