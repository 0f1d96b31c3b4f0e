// The status shown by the window: how far the frame is, what layers hold, what jobs run. Filled by the viewer
// every frame, only read by the widgets.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <set>

#include "camera/camera.h"
#include "core/bounds.h"
#include "objects/impression.h"
#include "output/scopes.h"
#include "scene/scene.h"
#include "sets/set_sample.h"

namespace astrosplat {

/// A picture file as a folder lists it: what its thumbnail is kept under.
struct ListedPicture {
    fs::path file;
    fs::file_time_type changed{};
    std::uintmax_t bytes = 0;
    auto operator<=>(const ListedPicture&) const = default;
};

/// How many of a layer's splats lie at each distance, and how its picture's values spread.
struct LayerHistograms {
    static constexpr int bins = 64;
    std::array<float, bins> distance{};  // share of the fullest bin, over 0 .. max_distance
    double max_distance = 0.0;           // scene units
    struct Values {  // of the picture as it lies in the file (FITS: data values); empty for splat files
        std::vector<float> share;  // of the fullest bin
        double lo = 0.0, hi = 1.0;
        double black = 0.0, white = 1.0;  // what "auto" means
    };
    Values values;
};

struct LayerStatus {
    std::int64_t splats = 0;  // in the set
    Bounds box;               // of these, in layer space; empty: not known
    std::int64_t kept = 0;    // by the look, estimated from the preview's share; -1: not known
    std::int64_t shown = 0;   // by the preview
    bool loading = false;
    float progress = 0.0f;                      // 0..1 while loading
    std::int64_t found = 0;                     // splats so far while loading
    Making making;                              // what it will take, while loading; without splats: not known
    bool stale = false;                         // the source was changed and not generated again
    std::string error;                          // why it could not be loaded, one line
    double radius_min = 0.0, radius_max = 0.0;  // what radius 0, 0 means for this set, scene units
    double body_height = 0.0, uv_width = 0.0;   // what 0 means of structure.height, uv_width; 0: not known
    std::optional<glm::vec3> color;             // mean of its splats, linear
    std::shared_ptr<const LayerHistograms> histograms;
};

enum class ViewFrameState { loading, preview, refining, final, failed };

struct ViewFrameStatus {
    ViewFrameState state = ViewFrameState::loading;
    std::int64_t shown = 0, total = 0;  // splats in the preview and in the sets
    int samples = 1;                    // renderings that the preview is the mean of
    bool round_splats = false;          // the preview shows Gaussians as round splats
    float progress = 0.0f;              // refining
    double seconds = 0.0;               // final: how long it took
    std::string device;                 // and what drew it; empty: the processor
    std::string error;
    int width = 0, height = 0;  // px of the whole frame, also where a part of it is shown
};

/// How true the view from the front is to the picture that the splats were made of.
struct FrontStatus {
    /// What of the look differs from what shows a picture as it is: "gain, saturation"; not empty: then it is
    /// not meant to be true, and is compared only where that is asked for.
    std::string changed_by;
    bool working = false;
    bool measured = false;
    bool matches = false;  // meets the targets of fidelity/front.h
    double psnr_db = 0.0, ssim = 0.0;
    double light = 1.0;  // over the picture's; NaN: that has none
    std::string error;   // why there is nothing to compare with, one line
};

/// The selected layer's picture before and after its preparation, while the panel shows that.
struct PrepareStatus {
    bool working = false;
    void* before = nullptr;  // texture handles for the widgets, top row first; null: nothing to show yet
    void* after = nullptr;
    float aspect = 1.0f;     // width / height
    std::int64_t stars = 0;  // removed
    std::string error;       // why it cannot be prepared, one line
};

/// The reference picture of the view that is seen.
struct ReferenceStatus {
    std::size_t index = 0;  // in the scene
    double aspect = 0.0;    // width / height; 0: not read yet
    std::string error;      // why it cannot be read, one line
    bool aligning = false;
};

/// View minus what it is compared with, where both are seen.
struct DifferenceStatus {
    double mean = 0.0;     // of display values, 0..1
    double psnr_db = 0.0;  // infinite where both are the same
    double light = 1.0;    // linear light of the view over the other's; not finite: that has none
};

/// The configuration of OpenColorIO that the scene or the environment names.
struct ColorStatus {
    ColorConfig config;                // empty where it cannot be read
    std::string display, view, space;  // in use; empty: the scene wants none
    std::string error;                 // why not, one line; the program's own view is seen then
};

struct PixelProbe {
    int x = 0, y = 0;
    float rgba[4] = {0, 0, 0, 0};  // linear, premultiplied
    std::optional<float> depth;    // scene units; of final frames of scenes that write depth
};

struct Snapshot {
    std::string name;
    void* thumbnail = nullptr;  // texture handle for the widgets, top row first
    float aspect = 1.0f;
    std::int64_t splats = 0;
    double seconds = 0.0;  // render time; 0: from the preview
};

/// One of the jobs that write files.
struct QueuedJob {
    /// submitted: a farm has it, whatever else runs here.
    enum class State { waiting, running, submitted, done, failed, cancelled };
    std::uint64_t number = 0;  // its name among all of this session
    State state = State::waiting;
    std::string title;      // "galaxy.toml: Frames 1-240, 1920x1080"
    fs::path target;        // a file, a pattern of files or a folder
    std::string text;       // what it said last: "frame 12 (3/10)", or why it failed
    float progress = 0.0f;  // 0..1
    std::optional<double> seconds_left;
    std::vector<fs::path> files;  // frames that are finished
    bool is_movie = false;
    bool is_splats = false;     // `text` says how many and how large, once it is done
    bool kept = false;          // the movie was there already
    std::uint64_t held_by = 0;  // number of the job that failed while this one waited; 0: none did
};

/// The finished frame of a job that is looked at.
struct FinishedFrame {
    void* texture = nullptr;  // handle for the widgets, top row first; null: none yet
    float aspect = 1.0f;      // width / height
    std::string error;        // why it cannot be shown, one line
};

/// A picture file as it looks. Zeros and nothing: it cannot be read.
struct ListedThumbnail {
    void* texture = nullptr;             // handle for the widgets, top row first
    std::int64_t width = 0, height = 0;  // px, in the file
};

/// An autosave that may be wanted.
struct RecoveryOffer {
    fs::path autosave;
    std::string scene;  // "whirlpool.toml", "Untitled"
    std::string time;   // "2026-05-01 12:30:00 UTC"
};

struct Message {
    std::string text;
    bool error = false;
    std::uint64_t number = 0;  // differs from message to message, also where the text is the same
};

/// The scene of a picture that is being made.
struct StartingStatus {
    fs::path picture;
    std::string choice;     // of Command::start_again; empty: it is being opened
    float progress = 0.0f;  // 0..1
};

/// What a picture would be as another kind, seen from aside.
struct KindStatus {
    void* texture = nullptr;  // handle for the widgets, top row first; null: not made yet
    std::string error;        // why it cannot be, one line
};

struct Status {
    ViewFrameStatus view_frame;
    std::optional<StartingStatus> starting;    // none: nothing is made
    std::map<SkyObject, KindStatus> kinds;     // of ViewState::start
    std::optional<FrontStatus> front;          // none: no layer has a picture
    std::optional<PrepareStatus> preparation;  // none: nothing to prepare, or not asked for
    std::vector<LayerStatus> layers;           // as in the scene
    Bounds box;                                // of all visible layers, world space
    std::optional<PixelProbe> probe;
    std::vector<Snapshot> snapshots;
    int b_snapshot = -1;
    std::string b_name;
    std::optional<ReferenceStatus> reference;    // none: the scene has none for this view
    std::optional<DifferenceStatus> difference;  // none: not shown, or not measured yet
    std::optional<ColorStatus> color;            // none: no configuration
    bool blink_shows_other = false;
    std::vector<QueuedJob> jobs;    // oldest first
    FinishedFrame finished;         // of the queue's dialog
    std::string render_command;     // that does what the dialog would
    std::string no_render_command;  // why it cannot be said, one line
    std::string render_estimate;    // of time and bytes, one line; empty: not known
    Message message;
    std::set<std::string> standing_errors;  // of the frame and the layers, said, whose cause is still there
    std::uint64_t scenes = 0;               // that were opened so far: messages belong to the last one
    std::vector<Message> log;
    std::int64_t memory_bytes = 0;
    int threads = 1;
    std::vector<fs::path> recent;
    bool changed_on_disk = false;
    std::vector<RecoveryOffer> recoveries;                // of scenes that were not closed
    std::map<ListedPicture, ListedThumbnail> thumbnails;  // of the files listed that are looked at so far
    bool has_ffmpeg = false;
    bool has_slurm = false;
    std::string engine;  // "NVIDIA H100" or "processor"

    double played_fps = 0.0;              // frames a second that playing reaches; 0: not playing
    std::vector<double> final_frames;     // those of the timeline that are kept as they would be seen now
    std::int64_t final_frames_bytes = 0;  // of all that are kept
    bool final_frames_full = false;       // the last one found no room
    std::string rendered_frame;           // name of the file shown in place of the preview; empty: none
    std::string played_movie;             // name of the one that is seen; empty: none
    std::string missing_frame;            // name of the one that is not there, where one is wanted

    double viewport_aspect = 0.0;      // width / height; 0: not known
    void* viewport_texture = nullptr;  // the viewport with the frame in its place, bottom row first
    std::optional<Camera>
        viewport_camera;  // what the view looks through, in px of the viewport; none: nothing
    std::array<void*, scope_count> scopes{};  // handles of their pictures, top row first; null: not shown
    std::vector<std::vector<glm::vec2>>
        overlay_lines;  // camera path, frustum; px of the viewport; one point: a tick
};

/// Null: none.
inline const QueuedJob* running_job(const Status& status) {
    for (const QueuedJob& job : status.jobs)
        if (job.state == QueuedJob::State::running) return &job;
    return nullptr;
}

/// The one with a number, else the newest; null: there is none.
inline const QueuedJob* chosen_job(const Status& status, std::uint64_t number) {
    for (const QueuedJob& job : status.jobs)
        if (job.number == number) return &job;
    return status.jobs.empty() ? nullptr : &status.jobs.back();
}

/// The view's reference; null where it has none, or where an edit of this very frame took it away.
inline const ReferenceParams* seen_reference(const Scene& scene, const Status& status) {
    const bool is_there = status.reference && status.reference->index < scene.references.size();
    return is_there ? &scene.references[status.reference->index] : nullptr;
}

}  // namespace astrosplat
