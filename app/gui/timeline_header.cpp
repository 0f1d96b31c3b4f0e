// The row above the ruler, from left to right: playing and the frame, the frames and their rate, how they are
// played, the time; at the right end graph and folding.
#include "gui/timeline_header.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <cmath>

#include "gui/icons.h"
#include "gui/key_codes.h"
#include "gui/theme.h"
#include "gui/widgets.h"

namespace astrosplat {
namespace {

constexpr float header_control = 24, entry_gap = 8;

void push_entry_padding() {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        ImVec2(px(8), (px(header_control) - ImGui::GetFontSize()) * 0.5f));
}

std::string seconds_text(const Scene& scene, double frame) {
    const double fps = scene.output.fps > 0 ? scene.output.fps : 24.0;
    return fmt::format("{:.2f} s", (frame - frame_range(scene).first) / fps);
}

void frame_entry(GuiFrame& frame) {
    const FrameRange range = shown_range(frame.document.scene());
    auto value = static_cast<float>(frame.view.frame);
    push_entry_padding();
    const bool changed = drag_field("##frame", value, 0.25f, static_cast<float>(range.first),
                                    static_cast<float>(range.last), "%.0f", px(56), color::text);
    ImGui::PopStyleVar();
    note_item(frame, "frame");
    tooltip("Frame. Drag, or double click to type");
    if (changed) frame.view.frame = std::round(static_cast<double>(value));
}

/// Frames as the scene has them; an entry that cannot be read is told and dropped.
void range_entry(TimelineState& t, GuiFrame& frame) {
    const std::string& frames = frame.document.scene().output.frames;
    std::array<char, 256> text{};
    (t.typing_frames ? t.typed_frames : frames).copy(text.data(), text.size() - 1);
    ImGui::SameLine(0, px(entry_gap));
    ImGui::SetNextItemWidth(px(76));
    push_entry_padding();
    ImGui::InputText("##range", text.data(), text.size());
    ImGui::PopStyleVar();
    note_item(frame, "range");
    tooltip("Frames of the scene: 1-240, 1-240x10 or 1,5,9");
    const bool done = ImGui::IsItemDeactivatedAfterEdit() && !key_pressed(key_code::escape);
    t.typing_frames = ImGui::IsItemActive();
    t.typed_frames = text.data();
    if (done && t.typed_frames != frames)
        try_edit([&] { frame.document.set("output.frames", t.typed_frames, frame.view.frame); });
}

void rate_entry(TimelineState& t, GuiFrame& frame) {
    auto fps = static_cast<float>(frame.document.scene().output.fps);
    ImGui::SameLine(0, px(entry_gap));
    push_entry_padding();
    const double reached = frame.status.played_fps;
    const std::string format = reached > 0.0 ? fmt::format("{:.1f}/%g fps", reached) : "%g fps";
    const bool slow = reached > 0.0 && reached < 0.9 * frame.document.scene().output.fps;
    const bool changed = drag_field("##fps", fps, 0.1f, 1.0f, 240.0f, format.c_str(), px(96),
                                    slow ? color::attention : color::text);
    ImGui::PopStyleVar();
    if (ImGui::IsItemActivated()) t.rate_gesture = new_gesture();
    note_item(frame, "fps");
    tooltip(
        "Frames a second of playing and of movies, while it plays after those that are reached. Drag, or "
        "double click to type");
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
    ImDrawList* const list = ImGui::GetWindowDrawList();
    if (on || ImGui::IsItemHovered())
        list->AddRectFilled(at, {at.x + width, at.y + px(header_control)},
                            on ? color::selection : color::hover, px(3));
    list->AddText({at.x + px(6), at.y + std::floor(0.5f * (px(header_control) - ImGui::GetFontSize()))},
                  on ? color::text : color::dim, word);
    tooltip(says);
    return clicked;
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
    if (word_toggle(frame, "Rendered", view.show_rendered,
                    "Shows the frames that are rendered in the output's folder; the preview where one is "
                    "missing"))
        view.show_rendered = !view.show_rendered;
}

/// Where there is room for it.
void time_text(const GuiFrame& frame, float right) {
    const std::string text = seconds_text(frame.document.scene(), frame.view.frame);
    ImGui::SameLine(0, px(12));
    if (ImGui::GetCursorScreenPos().x + ImGui::CalcTextSize(text.c_str()).x <= right)
        row_text(text, px(header_control), color::dim);
}

}  // namespace

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
    frame_entry(frame);
    const float right = area.x + area.width - px(8);
    range_entry(t, frame);
    rate_entry(t, frame);
    play_choices(frame);
    time_text(frame, right - 2 * control - px(12));
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

}  // namespace astrosplat
