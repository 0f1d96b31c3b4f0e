#include "viewer/session_state.h"

#include "core/error.h"
#include "core/file.h"
#include "edit/new_from_file.h"
#include "viewer/programs.h"

namespace astrosplat {
namespace {

/// Splats of a layer that a preview will ever draw.
std::int64_t preview_limit(const GlInfo& gl) { return gl.software ? 1'000'000 : 60'000'000; }

/// A scene, or what any other file becomes, untitled. Throws InputError.
Document document_for(const std::filesystem::path& file, std::span<const Assignment> assignments = {}) {
    if (kind_of_file(file) == FileKind::scene) return Document::open(file, assignments);
    const std::filesystem::path place = std::filesystem::absolute(file).replace_extension(".toml");
    return Document::untitled(scene_text_for(file, place), place, assignments);
}

/// A picture is first seen from the front, as it was before it had depth.
void look_first(ViewState& view, const std::filesystem::path& file) {
    if (kind_of_file(file) == FileKind::picture) view.view = ViewKind::top;
}

}  // namespace

SessionState::SessionState(const ViewerOptions& options, const GlInfo& gl_info)
    : gl(gl_info),
      preferences(load_preferences()),
      document(options.input.empty() ? demo_document(options.assignments)
                                     : document_for(options.input, options.assignments)),
      sets(options.cache, preview_limit(gl_info)),
      jobs(options.cache),
      fresh_demo(options.input.empty()) {
    view.hint_open = fresh_demo;
    apply_preferences(view, preferences);
    view.frame = first_frame(document.scene());
    if (!options.input.empty()) look_first(view, options.input);
    find_recoveries(status);
    status.has_ffmpeg = find_program("ffmpeg").has_value();
    status.recent = preferences.recent;
}

void say(Status& status, const std::string& text, bool error) {
    constexpr std::size_t most = 500;
    status.message = {text, error, status.message.number + 1};
    status.log.push_back(status.message);
    if (status.log.size() > most) status.log.erase(status.log.begin());
}

void take_document(SessionState& state, Document next) {
    state.document = std::move(next);
    ViewState& view = state.view;
    view.frame = first_frame(state.document.scene());
    view.layer = 0;
    view.view = ViewKind::camera;
    view.solo.clear();
    view.playing = false;
    view.hint_open = state.fresh_demo = false;
    state.comparison.clear_snapshots();
    state.autosave.remove();
    if (!state.document.file().empty()) add_recent(state.preferences, state.document.file());
    state.status.recent = state.preferences.recent;
}

void open_file(SessionState& state, const std::filesystem::path& file) {
    take_document(state, document_for(file));
    look_first(state.view, file);
}

void find_recoveries(Status& status) {
    status.recoveries.clear();
    for (const Recovery& recovery : recoveries())
        status.recoveries.push_back({recovery.autosave,
                                     recovery.titled ? recovery.original.filename().string() : "Untitled",
                                     recovery.time + " UTC"});
}

Document demo_document(std::span<const Assignment> assignments) {
    const std::filesystem::path file = demo_scene_file();
    if (file.empty())
        throw InputError("the demo scene is not installed; name a scene, picture, mesh or splat file");
    return Document::untitled(read_file(file), file, assignments);
}

}  // namespace astrosplat
