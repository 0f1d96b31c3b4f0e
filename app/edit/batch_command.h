// The command line that renders what the window shows, to be pasted into a shell or a queue's script.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/image.h"
#include "edit/document.h"
#include "edit/render_task.h"

namespace astrosplat {

struct BatchCommandOptions {
    std::optional<double> frame;         // empty: the frames of [output]
    std::int64_t width = 0, height = 0;  // px; 0: the resolution of [output]
    std::optional<Region> region;        // of that frame
    std::optional<CameraParams> camera;  // a free view instead of the scene's camera
    std::vector<std::string> arguments;  // more words of --batch
    std::string mode = "--batch";        // or "--submit slurm"
    std::string program = "astrosplat";
};

struct BatchCommand {
    std::string text;    // for a POSIX shell; empty where it cannot be said
    std::string reason;  // why not, one line: "save the scene first: ..."
};

/// Edits that are not saved, and another camera, appear as --set; the command is given only where loading the
/// file with them gives exactly the scene shown. Frames between two frames are rounded.
BatchCommand batch_command(const Document& document, const BatchCommandOptions& options);

/// The command line that renders what the dialog asks for, from any folder; a movie by a second command
/// behind it.
BatchCommand render_command(const Document& document, const RenderTask& task, const std::string& program);

/// One word for a POSIX shell, in quotes where it needs them.
std::string shell_word(const std::string& text);

}  // namespace astrosplat
