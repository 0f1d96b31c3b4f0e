// Command lines for work outside of the window: renderings here and on a farm, movies by ffmpeg, the
// preparation of a picture, and a command to paste into a shell. In: the dialog's values and the document.
// Out: words, or the reason why there are none.
#pragma once

#include "camera/camera.h"
#include "core/image.h"
#include "edit/document.h"
#include "edit/settings.h"
#include "source/source.h"

namespace astrosplat {

enum class RenderKind { frame, range, movie, splats };
enum class ExistingFrames {
    resume,   // finished frames of these settings stay, others are replaced
    replace,  // all are rendered again
    refuse    // nothing is rendered where one is in the way
};

struct RenderTask {
    RenderKind kind = RenderKind::range;
    std::string frames;                  // as --frames has them: "1-240", "12"
    std::int64_t width = 0, height = 0;  // px
    fs::path folder;                     // absolute
    std::string name;                    // of the file or files in it: "galaxy.####.exr", "galaxy.mp4"
    ExistingFrames existing = ExistingFrames::resume;
    bool by_slurm = false;    // on the machines of a farm; movies never are
    std::int64_t chunk = 10;  // frames of a task there
    std::string partition;    // of the cluster; empty: its own choice
    // Of splats for other programs:
    std::string layer;             // the only one; empty: all that are visible
    std::int64_t most_splats = 0;  // to which they are merged; 0: any number
    bool operator==(const RenderTask&) const = default;
};

/// [output]'s value for `kind`; a frame and splats are those of number `frame`, next to the scene's own
/// frames.
RenderTask make_render_task(const Document& document, RenderKind kind, double frame);

/// What was chosen for a scene, which holds while its [output] says what it said then.
struct KeptRender {
    fs::path scene;     // its file; empty: of the scene that has none yet
    std::string usual;  // in words, what make_render_task() gave
    RenderTask task;
    bool operator==(const KeptRender&) const = default;
};

/// What was last kept for the document and `kind`, else make_render_task(). A frame, of splats too, is always
/// the one of that number, and what becomes of files that are there is chosen anew.
RenderTask kept_render(const std::vector<KeptRender>& kept, const Document& document, RenderKind kind,
                       double frame);
/// Keeps a task as the newest of 24, in place of another of the same scene and kind.
void keep_render(std::vector<KeptRender>& kept, const Document& document, const RenderTask& task);

/// Of the files: a whole path, with the pattern's `#`.
fs::path render_target(const RenderTask& task);

/// Why it cannot be rendered by this camera, one line; empty: it can.
std::string render_problem(const RenderTask& task, const CameraParams& camera);

/// The endings that files of a kind may have, the usual one first.
std::vector<std::string> render_endings(RenderKind kind);
/// The name with another ending.
std::string with_ending(const std::string& name, const std::string& ending);

/// "Frames 1-240, 1920x1080", "Frame 12, ...", "Movie of 1-240, ...", "Splats of frame 12".
std::string render_title(const RenderTask& task);

/// Of the frames that are rendered: the target, or a movie's in its folder.
fs::path render_files(const RenderTask& task);
/// Where a movie's frames wait until it is written: beside it, so that what was cancelled can go on.
fs::path movie_folder(const fs::path& movie);

/// Where it is written, among them: it takes its name once it is whole.
fs::path movie_part(const fs::path& movie);
/// Among them, what the movie says of itself.
fs::path movie_words(const fs::path& movie);

/// Words that decide frames and their files, as --batch and `status` have them.
std::vector<std::string> frame_arguments(const RenderTask& task);

/// Words of --batch behind the scene: frames, size, files, and what becomes of those that are there. A job of
/// the window takes no more of the machine than the window itself.
std::vector<std::string> batch_arguments(const RenderTask& task, const MachineLimits& limits = {});

/// The file holds one layer's own splats, without its look: `generate` writes it, not `export`.
bool is_own_format(const RenderTask& task);

/// The subcommand that writes splats: "export" or "generate".
std::string export_mode(const RenderTask& task);

/// Words behind that and the scene. Only with ExistingFrames::replace a file is replaced.
std::vector<std::string> export_arguments(const RenderTask& task);

/// The farm renders it.
bool renders_by_slurm(const RenderTask& task);

/// Words of --submit slurm behind the scene. Finished frames always stay there, others are replaced.
std::vector<std::string> submit_arguments(const RenderTask& task);

/// ffmpeg's command, which writes a movie of the frames in its folder, in the colours of BT.709 at any size,
/// and tagged so. Sides of odd size get a black line more, as H.264 wants it.
std::vector<std::string> movie_command(const fs::path& movie, double fps);

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

/// A backslash before each of the `special` characters.
std::string with_backslashes(const std::string& text, std::string_view special);

/// One word for a POSIX shell, in quotes where it needs them.
std::string shell_word(const std::string& text);

/// "prepare" and what follows it. Throws InputError where the source has no picture of its own.
std::vector<std::string> prepare_command(const SourceParams& source, const fs::path& folder);

}  // namespace astrosplat
