// The timeline as a whole: its first row, ruler and playhead.
#include "gui/timeline.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <glm/geometric.hpp>

#include "core/memory.h"
#include "edit/placement.h"
#include "edit/view_camera.h"
#include "gui/widgets.h"
#include "scene/animate.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

using Drag = TimelineState::Drag;

// First row: playing, the frames and their rate, the graph.

constexpr float header_control = 24, entry_gap = 8;

std::string seconds_text(const Scene& scene, double frame) {
    const double fps = scene.output.fps > 0 ? scene.output.fps : 24.0;
    return fmt::format("{:.2f} s", (frame - frame_range(scene.output).first) / fps);
}

void frame_entry(GuiFrame& frame) {
    const FrameRange range = shown_range(frame.document.scene());
    auto value = static_cast<float>(frame.view.frame);
    if (drag_field(frame, value,
                   {"frame", 0.25f, static_cast<float>(range.first), static_cast<float>(range.last), "%.0f",
                    56, color::text, "Frame. Drag, or double click to type"}))
        frame.view.frame = std::round(static_cast<double>(value));
}

/// Frames as the scene has them; an entry that cannot be read is reported and dropped.
void range_entry(TimelineState& t, GuiFrame& frame) {
    const std::string& frames = frame.document.scene().output.frames;
    std::string text = t.typing_frames ? t.typed_frames : frames;
    ImGui::SameLine(0, px(entry_gap));
    ImGui::SetNextItemWidth(px(76));
    ImGui::InputText("##range", &text);
    note_item(frame, "range");
    tooltip("Frames of the scene: 1-240, 1-240x10 or 1,5,9");
    const bool done = ImGui::IsItemDeactivatedAfterEdit() && !key_pressed(key_code::escape);
    t.typing_frames = ImGui::IsItemActive();
    t.typed_frames = text;
    if (done && t.typed_frames != frames)
        try_edit([&] { frame.document.set("output.frames", t.typed_frames, frame.view.frame); });
}

void rate_entry(TimelineState& t, GuiFrame& frame) {
    auto fps = static_cast<float>(frame.document.scene().output.fps);
    ImGui::SameLine(0, px(entry_gap));
    const double reached = frame.status.played_fps;
    const std::string format = reached > 0.0 ? fmt::format("{:.1f}/%g fps", reached) : "%g fps";
    const bool slow = reached > 0.0 && reached < 0.9 * frame.document.scene().output.fps;
    const bool changed = drag_field(
        frame, fps,
        {"fps", 0.1f, 1.0f, 240.0f, format.c_str(), 96, slow ? color::attention : color::text,
         "Frames a second of playing and of movies, while it plays after those that are reached. Drag, or "
         "double click to type"});
    if (ImGui::IsItemActivated()) t.rate_gesture = new_gesture();
    if (changed)
        try_edit([&] {
            frame.document.set("output.fps", std::round(static_cast<double>(fps) * 1000.0) / 1000.0,
                               frame.view.frame, t.rate_gesture);
        });
}

/// A word that is lit while it is on. True when clicked.
bool word_toggle(GuiFrame& frame, const char* word, bool on, const char* says) {
    const float width = ImGui::CalcTextSize(word).x + px(12);
    ImGui::SameLine(0, px(4));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton(word, {width, px(header_control)});
    note_item(frame, std::string("playing/") + word);
    if (on || ImGui::IsItemHovered())
        fill_rect(at, {at.x + width, at.y + px(header_control)}, on ? color::selection : color::hover, px(3));
    draw_text({at.x + px(6), at.y + std::floor(0.5f * (px(header_control) - ImGui::GetFontSize()))},
              on ? color::text : color::dim, word);
    tooltip(says);
    return clicked;
}

std::string final_tip(const Status& status) {
    std::string text =
        "Playing waits for every frame to be final; those that were are in memory (the line over the "
        "numbers) and play at the scene's speed";
    if (!status.final_frames.empty())
        text += fmt::format(". {} frames here, {} in all", status.final_frames.size(),
                            human_bytes(static_cast<double>(status.final_frames_bytes)));
    if (status.final_frames_full) text += ". There is no room for more: Settings > Final frames";
    return text;
}

void play_choices(GuiFrame& frame) {
    ViewState& view = frame.view;
    constexpr std::array<const char*, 3> modes{"Loop", "Ping-pong", "Once"};  // by PlayMode
    const auto mode = static_cast<std::size_t>(view.play_mode);
    if (word_toggle(frame, modes[mode], view.play_mode != PlayMode::once,
                    "What comes after the last frame: click for Loop, Ping-pong, Once. "
                    "I and O set where playing begins and ends"))
        view.play_mode = static_cast<PlayMode>((mode + 1) % modes.size());
    if (word_toggle(frame, "Every frame", view.every_frame,
                    "Leaves no frame out, however long one takes; else the speed is kept"))
        view.every_frame = !view.every_frame;
    if (word_toggle(frame, "Final", view.play_final, final_tip(frame.status).c_str()))
        view.play_final = !view.play_final;
    if (word_toggle(frame, "Rendered", view.show_rendered,
                    "Shows the frames that are rendered in the output's folder; the preview where one is "
                    "missing"))
        view.show_rendered = !view.show_rendered;
}

/// Each where there is room for it.
void read_outs(const GuiFrame& frame, float right) {
    const Scene& scene = frame.document.scene();
    const double at = frame.view.frame;
    for (const std::string& text : {seconds_text(scene, at), distance_text(scene, at, frame.status.box)}) {
        ImGui::SameLine(0, px(12));
        if (ImGui::GetCursorScreenPos().x + ImGui::CalcTextSize(text.c_str()).x <= right)
            row_text(text, px(header_control), color::dim);
    }
}

void draw_timeline_header(TimelineState& t, GuiFrame& frame, const Rect& area) {
    ViewState& view = frame.view;
    const float control = px(header_control), y = area.y + px(6);
    ImGui::SetCursorScreenPos({area.x + px(8), y});
    const char* says = view.playing ? "Pause (Space)" : "Play (Space)";
    if (icon_button("play", view.playing ? Icon::pause : Icon::play, {control, control}, px(11), color::text,
                    says))
        view.playing = !view.playing;
    note_item(frame, "play");
    ImGui::SameLine(0, px(8));
    push_field_height(control);
    frame_entry(frame);
    const float right = area.end().x - px(8);
    range_entry(t, frame);
    rate_entry(t, frame);
    ImGui::PopStyleVar();
    play_choices(frame);
    read_outs(frame, right - 2 * control - px(12));
    ImGui::SetCursorScreenPos({right - 2 * control - px(4), y});
    if (icon_button("graph", Icon::curve, {control, control}, px(13),
                    view.graph_open ? color::accent : color::dim, "Graph of the selected parameter")) {
        view.graph_open = !view.graph_open;
        if (view.graph_open) view.timeline_open = true;
    }
    note_item(frame, "graph");
    ImGui::SetCursorScreenPos({right - control, y});
    if (icon_button("fold timeline", view.timeline_open ? Icon::chevron_down : Icon::chevron_right,
                    {control, control}, px(10), color::dim, view.timeline_open ? "Close" : "Open"))
        view.timeline_open = !view.timeline_open;
    note_item(frame, "fold timeline");
}

constexpr float header_height = 36, ruler_height = 22;
constexpr float point_half = 3, point_reach = 5;  // tabs of in and out points

/// Where the range has changed, the playhead comes along: undo may have taken its frame away.
void refresh(TimelineState& t, const Document& document, ViewState& view) {
    const FrameRange range = shown_range(document.scene());
    if (!t.zoomed || range.first != t.fitted.first || range.last != t.fitted.last) {
        t.fitted = range;
        t.zoomed = false;
        t.scale.first = range.first;
        t.scale.last = std::max(range.last, range.first + 1.0);
        view.frame = std::clamp(view.frame, range.first, range.last);
    }
    if (document.revision() == t.revision && !t.specs.empty()) return;
    t.revision = document.revision();
    t.specs.clear();
    if (document.scene().animation.empty()) return;
    Scene scene = document.scene();
    const Description description = describe(scene);
    for (const Track& track : scene.animation)
        if (const Parameter* parameter = find_parameter(description, track.key))
            t.specs[track.key] = parameter->spec;
}

void zoom_with_wheel(TimelineState& t, const Rect& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool inside = ImGui::IsMouseHoveringRect(area.corner(), area.end());
    if (!inside || io.MouseWheel == 0.0f) return;
    zoom_frames(t, t.scale.frame_at(io.MousePos.x), zoom_of(io.MouseWheel));
}

double first_played(const TimelineState& t, const ViewState& view) {
    return view.play_first.value_or(t.fitted.first);
}
double last_played(const TimelineState& t, const ViewState& view) {
    return view.play_last.value_or(t.fitted.last);
}

/// A press on the tab of an in or out point takes that, any other the playhead.
Drag drag_from_ruler(const TimelineState& t, const ViewState& view) {
    const float x = ImGui::GetIO().MousePos.x, reach = px(point_reach);
    if (view.play_first && std::fabs(t.scale.x_of(*view.play_first) - px(point_half) - x) <= reach)
        return Drag::in_point;
    if (view.play_last && std::fabs(t.scale.x_of(*view.play_last) + px(point_half) - x) <= reach)
        return Drag::out_point;
    return Drag::scrub;
}

void drag_on_ruler(const TimelineState& t, ViewState& view) {
    const double at =
        std::clamp(std::round(t.scale.frame_at(ImGui::GetIO().MousePos.x)), t.fitted.first, t.fitted.last);
    if (t.drag == Drag::scrub) view.frame = at;
    if (t.drag == Drag::in_point) view.play_first = std::min(at, last_played(t, view));
    if (t.drag == Drag::out_point) view.play_last = std::max(at, first_played(t, view));
}

/// Frames that are not played are dimmed; a tab at either end that was set.
void draw_in_and_out(const TimelineState& t, GuiFrame& frame, const Rect& area) {
    const ViewState& view = frame.view;
    if (!view.play_first && !view.play_last) return;
    const float bottom = area.end().y;
    const float first = t.scale.x_of(first_played(t, view)), last = t.scale.x_of(last_played(t, view));
    fill_rect({first, bottom - px(3)}, {last, bottom}, color::with_opacity(color::good, 0.8f));
    const auto tab = [&](const char* name, float x, float side) {
        fill_rect({std::min(x, x + side), area.y + px(3)}, {std::max(x, x + side), bottom}, color::good,
                  px(2));
        note_item(frame, name, {x + 0.5f * side, area.y + 0.5f * area.height});
    };
    if (view.play_first) tab("in point", first, -px(2 * point_half));
    if (view.play_last) tab("out point", last, px(2 * point_half));
}

/// Distance of ruler numbers in frames (1, 2, 5, 10, ...) that leaves them at least `least_px` apart.
double ruler_step(const TimeScale& scale, float least_px) {
    const double px_per_frame = static_cast<double>(scale.x1 - scale.x0) / (scale.last - scale.first);
    double step = 1.0;
    for (int i = 0; step * px_per_frame < static_cast<double>(least_px) && i < 30; ++i)
        step *= i % 3 == 1 ? 2.5 : 2.0;  // 1 2 5 10 20 50 ...
    return step;
}

/// A line over the frames that are there at once.
void draw_final_frames(const TimelineState& t, const std::vector<double>& frames, const Rect& area) {
    const float half = std::max(0.5f * (t.scale.x_of(1.0) - t.scale.x_of(0.0)), 0.5f);
    for (const double frame : frames) {
        const float x = t.scale.x_of(frame);
        fill_rect({x - half, area.y}, {x + half, area.y + px(2)}, color::accent);
    }
}

void draw_ruler(TimelineState& t, GuiFrame& frame, const Rect& area) {
    ImGui::SetCursorScreenPos({t.scale.x0 - px(timeline_margin), area.y});
    ImGui::InvisibleButton("ruler", {t.scale.x1 - t.scale.x0 + 2 * px(timeline_margin), area.height});
    note_item(frame, "ruler");
    if (ImGui::IsItemActivated()) {
        t.drag = drag_from_ruler(t, frame.view);
        if (t.drag == Drag::scrub) frame.view.playing = false;
    }
    if (ImGui::IsItemActive()) drag_on_ruler(t, frame.view);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) t.zoomed = false;
    zoom_with_wheel(t, {t.scale.x0, area.y, t.scale.x1 - t.scale.x0, area.height});

    fill_rect(area, color::window);
    ImGui::PushFont(small_font());
    const double step = ruler_step(t.scale, px(56)), small = ruler_step(t.scale, px(8));
    for (double f = std::ceil(t.scale.first / small) * small; f <= t.scale.last; f += small) {
        line_down(t.scale.x_of(f), area.end().y - px(4), area.end().y, color::hover);
    }
    for (double f = std::ceil(t.scale.first / step) * step; f <= t.scale.last; f += step) {
        const float x = std::floor(t.scale.x_of(f));
        const std::string text = fmt::format("{:.0f}", f);
        line_down(x, area.end().y - px(7), area.end().y, color::dim);
        draw_text({x - std::floor(ImGui::CalcTextSize(text.c_str()).x * 0.5f), area.y + px(1)}, color::dim,
                  text);
    }
    ImGui::PopFont();
    draw_in_and_out(t, frame, area);
    draw_final_frames(t, frame.status.final_frames, area);
}

void draw_playhead(const TimelineState& t, const GuiFrame& frame, const Rect& ruler) {
    const float x = std::floor(t.scale.x_of(frame.view.frame));
    if (x < t.scale.x0 - px(timeline_margin) || x > t.scale.x1 + px(timeline_margin)) return;
    ImGui::PushFont(small_font());
    const std::string text = fmt::format("{:g}", std::round(frame.view.frame * 100.0) / 100.0);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float half = std::floor(size.x * 0.5f + px(6));
    fill_rect({x - half, ruler.y + px(1)}, {x + half + 1.0f, ruler.end().y - px(2)}, color::accent, px(3));
    draw_text({std::floor(x + 0.5f - size.x * 0.5f), ruler.y + px(2)}, IM_COL32(0x10, 0x14, 0x1A, 255), text);
    ImGui::PopFont();
}

void end_drag(TimelineState& t) {
    if (t.drag == Drag::none || ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    if (t.drag == Drag::pan) return;  // by another button
    t.drag = Drag::none;
}

}  // namespace

bool is_selected(const TimelineState& t, const KeyframePlace& place) {
    return std::find(t.selected.begin(), t.selected.end(), place) != t.selected.end();
}

void select_keyframe(TimelineState& t, const KeyframePlace& place) {
    if (!ImGui::GetIO().KeyShift) {
        if (!is_selected(t, place)) t.selected = {place};
    } else if (std::erase(t.selected, place) == 0) {
        t.selected.push_back(place);
    }
}

std::string distance_text(const Scene& scene, double frame, const Bounds& box) {
    constexpr double step = 0.25;  // frames
    if (scene.light_years_per_unit == 0.0) return "";
    const auto camera_at = [&](double at) {
        return try_free_camera(scene_at(scene, at).camera, box, aspect_of(scene.output));
    };
    const auto before = camera_at(frame - step), camera = camera_at(frame), after = camera_at(frame + step);
    if (!camera) return "";
    const double distance = glm::distance(camera->position, camera->pivot);
    std::string text = "target at " + length_text(distance, scene.light_years_per_unit);
    double way = 0.0;  // the longer one: at a path's ends the camera stands still on one side
    for (const auto& other : {before, after})
        if (other) way = std::max(way, glm::distance(camera->position, other->position));
    if (way == 0.0) return text;
    const double speed = way / step * scene.output.fps * scene.light_years_per_unit;
    return text + "; " + light_years_text(speed) + "/s";
}

double zoom_of(float wheel) { return wheel > 0 ? 1.0 / 1.25 : 1.25; }

void zoom_frames(TimelineState& t, double middle, double factor) {
    const double least = 4.0, most = 4.0 * std::max(t.fitted.last - t.fitted.first, least);
    const double span = std::clamp((t.scale.last - t.scale.first) * factor, least, most);
    const double ratio = span / (t.scale.last - t.scale.first);
    t.scale.first = middle - (middle - t.scale.first) * ratio;
    t.scale.last = t.scale.first + span;
    t.zoomed = true;
}

void draw_timeline(TimelineState& t, GuiFrame& frame, const Rect& area) {
    constexpr ImGuiWindowFlags still = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    const float head = std::min(px(header_height), area.height);
    if (!begin_part("timeline", {area.x, area.y, area.width, head}, still)) return;
    refresh(t, frame.document, frame.view);
    end_drag(t);
    draw_timeline_header(t, frame, area);
    ImGui::EndChild();
    const Rect ruler{area.x, area.y + head, area.width, px(ruler_height)};
    const float bottom = area.end().y;
    if (bottom <= ruler.end().y) return;
    const Rect below{area.x, ruler.y, area.width, bottom - ruler.y};
    if (!begin_part("keyframes", below, still | ImGuiWindowFlags_NoNav)) return;
    t.scale.x0 = area.x + names_width(frame.view) + px(timeline_margin);
    t.scale.x1 = std::max(area.end().x - px(timeline_margin) * 1.5f, t.scale.x0 + 1.0f);
    draw_ruler(t, frame, ruler);
    const Rect rows{area.x, ruler.end().y, area.width, bottom - ruler.y - ruler.height};
    draw_rows(t, frame, rows);
    draw_playhead(t, frame, ruler);
    ImGui::EndChild();
}

}  // namespace astrosplat
