// What a Session owns; session.cpp brings it forward, session_commands.cpp obeys commands,
// session_compare.cpp keeps snapshots and what A is compared with.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "edit/autosave.h"
#include "edit/preferences.h"
#include "edit/snapshots.h"
#include "edit/watched_files.h"
#include "gl/display.h"
#include "viewer/render_job.h"
#include "viewer/session.h"
#include "viewer/set_loader.h"

namespace astrosplat {

/// A stored look with the picture of it.
struct StoredPicture {
    StoredLook look;
    PictureTexture thumbnail;
    float aspect = 1.0f;
    std::int64_t splats = 0;
    double seconds = 0.0;
};

struct Session::Impl {
    Impl(const ViewerOptions& options, const GlInfo& gl);

    SetCache cache;
    GlInfo gl;
    Preferences preferences;
    Document document;
    ViewState view;
    Status status;
    SetLoader loader;
    std::shared_ptr<PictureFiles> files = make_picture_files();
    ViewPicture a{files}, b{files};
    Display display;
    RenderJob job;
    std::filesystem::path job_target;
    WatchedFiles watched;
    std::uint64_t files_read_again = 0;
    Autosave autosave{autosave_folder(), autosave_interval()};

    std::vector<StoredPicture> snapshots;
    int b_snapshot = -1, snapshots_taken = 0;
    bool comparing = false;  // the last draw() showed more than A
    PictureTexture reference;
    std::filesystem::path reference_file;  // what `reference` holds
    std::uint64_t references_loaded = 0;

    std::uint64_t wanted_revision = 0;  // of the document, given to the loader
    std::vector<SourceParams> wanted_sources;
    double source_edited_at = -1.0;  // below 0: no source waits to be generated anew
    double grows_at = 0.0;           // when a set that is generated may be shown again
    double new_set_draw_s = 0.0;     // of this thread, for a draw() of a new set
    double played_at = -1.0, navigated_at = -1.0, checked_disk_at = 0.0;
    Gesture gesture = 1;     // of the camera
    double fly_speed = 1.0;  // scene sizes a second
    bool quitting = false, fresh_demo = false;
    bool viewport_is_picture = false;
    std::int64_t fixed_splats = 0;  // of the preview; 0: by the frame rate
    std::optional<std::filesystem::path> screenshot;
    std::optional<std::string> clipboard;
    Commands dropped;  // from files, for the next frame of widgets

    // The picture at hand: of the last draw().
    PictureRequest request;
    int viewport_width = 0, viewport_height = 0;
    std::uint64_t drawn_sets = 0;  // revision of the loader
    std::vector<glm::dvec3> path;  // of the scene's camera
    Scene path_of;                 // camera_part() that it was made of, with this box
    Bounds path_box;

    void take_document(Document next);
    void open(const std::filesystem::path& file);
    void look_first(const std::filesystem::path& file);
    void say(const std::string& text, bool error = false);
    void play(double now);
    void load_sets(double now);
    void show_growth(double now);
    void look_at_disk(double now);
    std::vector<std::filesystem::path> files_of(const LayerParams& layer) const;
    void watch_files();
    void read_again(const std::vector<std::filesystem::path>& files);
    void fill_status();
    void fill_layers(const Scene& now);
    void probe(glm::dvec2 mouse_px);
    void poll_job();
    void copy_batch_command();
    void find_recoveries();

    /// Any scene as it stands at the view's frame, with solo.
    Scene evaluated(const Scene& scene) const;
    PictureRequest make_request(Scene now) const;
    void draw_overlay(const Scene& now, const Rect& place);
    Bounds layer_box(std::size_t index) const;

    void navigate(const ViewportInput& input, double elapsed_s);
    void leave_scene_camera(bool turning);
    FreeCamera picture_camera() const;
    FreeCamera viewport_camera() const;
    void keep_free_camera();
    FreeCamera moved(FreeCamera camera, const ViewportInput& input, const glm::dvec2& viewport_px,
                     double elapsed_s);
    void frame_box_in_view(const Bounds& box);

    void obey(const Command& command);
    void render_files(const Command& command);
    void take_snapshot();
    void delete_snapshot(std::size_t index);
    void load_reference();
    void show_comparison(DisplaySettings& shown, const PreviewChoice& choice, bool may_settle, double now);
};

/// The demo as an untitled scene. Throws InputError where it is not installed.
Document demo_document(std::span<const Assignment> assignments = {});
/// A scene, or what any other file becomes, untitled. Throws InputError.
Document document_for(const std::filesystem::path& file, std::span<const Assignment> assignments = {});

/// Processor time of this thread: what work costs the others, however busy the machine is.
double thread_seconds();

/// A texture as the widgets name it.
inline void* to_handle(unsigned texture) {
    return reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture));
}

}  // namespace astrosplat
