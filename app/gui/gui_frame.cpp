// The few things all parts of the window do.
#include "gui/gui_frame.h"

#include <imgui.h>

#include <array>

#include "core/error.h"
#include "core/log.h"
#include "edit/edit_rules.h"
#include "gui/theme.h"
#include "gui/widgets.h"
#include "scene/frames.h"

namespace astrosplat {

void request(GuiFrame& frame, Command::Kind kind, std::size_t index) {
    frame.requested.push_back({kind, {}, {}, index});
}
void request_path(GuiFrame& frame, Command::Kind kind, const std::filesystem::path& path) {
    frame.requested.push_back({kind, path, {}, 0});
}

void try_edit(const std::function<void()>& edit) {
    try {
        edit();
    } catch (const InputError& error) {
        log_error(error.what());
    } catch (const OutputError& error) {
        log_error(error.what());
    }
}

Gesture new_gesture() {
    static Gesture last = Gesture{1} << 63;
    return ++last;
}

void note_item(GuiFrame& frame, const std::string& name) {
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    note_item(frame, name, {(lo.x + hi.x) * 0.5f, (lo.y + hi.y) * 0.5f});
}
void note_item(GuiFrame& frame, const std::string& name, glm::vec2 middle_px) {
    frame.drawn.push_back({name, middle_px});
}

int noted_segments(GuiFrame& frame, const char* id, const std::string& prefix,
                   std::initializer_list<Segment> segments, int chosen, float height) {
    std::array<ImVec2, 8> middles;
    const int clicked = segmented(id, segments, chosen, px(height), middles.data());
    std::size_t i = 0;
    for (const Segment& segment : segments) {
        note_item(frame, prefix + "/" + segment.label, {middles[i].x, middles[i].y});
        ++i;
    }
    return clicked;
}

FrameRange frame_range(const Scene& scene) {
    try {
        const std::vector<std::int64_t> frames = parse_frames(scene.output.frames, "output.frames");
        if (!frames.empty()) return {static_cast<double>(frames.front()), static_cast<double>(frames.back())};
    } catch (const InputError&) {
        // Said where it is typed; the timeline shows one frame meanwhile.
    }
    return {};
}

FrameRange shown_range(const Scene& scene) {
    FrameRange range = frame_range(scene);
    if (range.first == range.last) range.last += film_frames(scene.output) - 1.0;
    return range;
}

}  // namespace astrosplat
