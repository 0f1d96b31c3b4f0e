#include "viewer/session_rendered.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "frame/output_pattern.h"
#include "scene/frames.h"

namespace astrosplat {
namespace {

namespace fs = std::filesystem;

constexpr double read_ahead = 24.0;  // frames

/// The file of a frame; empty where the output has one file for all frames, or a pattern that is wrong.
fs::path file_of_frame(const Session& session, double frame) {
    const Scene& scene = session.document.scene();
    try {
        const OutputPattern pattern = output_pattern(scene.file.parent_path(), scene.output.path);
        if (!pattern.is_numbered()) return {};
        return pattern.resolve(std::llround(frame), eyes_of(pattern, scene.camera).front());
    } catch (const InputError&) {
        return {};
    }
}

/// From the frame that is looked at on, as they are played.
std::vector<fs::path> files_ahead(const Session& session) {
    const std::vector<std::int64_t> frames =
        parse_frames(session.document.scene().output.frames, "output.frames");
    const double first = session.view.play_first.value_or(static_cast<double>(frames.front())),
                 last = session.view.play_last.value_or(static_cast<double>(frames.back()));
    std::vector<fs::path> files = {file_of_frame(session, session.view.frame)};
    double frame = std::floor(session.view.frame);
    for (double i = 1.0; i < std::min(read_ahead, last - first + 1.0); ++i) {
        frame = frame + 1.0 > last ? first : frame + 1.0;
        files.push_back(file_of_frame(session, frame));
    }
    std::erase(files, fs::path());
    return files;
}

bool wants_rendered(const Session& session) {
    const ViewState& view = session.view;
    return view.show_rendered && view.view == ViewKind::camera && view.compare == CompareMode::a &&
           !session.viewport_is_frame;
}

}  // namespace

bool show_rendered_frame(Session& session, const Rect& place, DisplaySettings& shown) {
    Status& status = session.status;
    status.rendered_frame.clear();
    status.missing_frame.clear();
    if (!wants_rendered(session)) {
        session.rendered.want({});
        session.rendered_shown = nullptr;
        return false;
    }
    const fs::path file = file_of_frame(session, session.view.frame);
    session.rendered.want(files_ahead(session));
    std::error_code ignored;
    if (file.empty() || !fs::exists(file, ignored)) {
        status.missing_frame = file.empty() ? "frame" : file.filename().string();
        session.rendered_shown = nullptr;
        return false;
    }
    const std::shared_ptr<const FrameOnDisk> found = session.rendered.found(file);
    if (found && !found->error.empty()) {
        status.missing_frame = file.filename().string();
        return false;
    }
    if (found && found != session.rendered_shown) {
        session.rendered_texture.upload_smooth(to_image(*found));
        session.rendered_shown = found;
        ++session.rendered_uploads;
    }
    if (!session.rendered_shown) return false;  // the first one is being read
    status.rendered_frame = file.filename().string();
    const auto width = static_cast<float>(session.rendered_shown->width),
               height = static_cast<float>(session.rendered_shown->height);
    const float scale = std::min(place.width / width, place.height / height);
    shown.b = session.rendered_texture.handle();
    shown.b_is_display = !session.rendered_shown->is_light();
    shown.mode = DisplaySettings::Mode::b;
    shown.width = scale * width;
    shown.height = scale * height;
    shown.x = place.x + 0.5f * (place.width - shown.width);
    shown.y = place.y + 0.5f * (place.height - shown.height);
    return true;
}

}  // namespace astrosplat
