// Header, ruler and playhead.
#include "gui/timeline.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "gui/icons.h"
#include "gui/theme.h"
#include "gui/timeline_rows.h"
#include "gui/widgets.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

constexpr float header_height = 36, ruler_height = 22;
constexpr double zoom_step = 1.25;

std::string seconds_text(const Scene& scene, double frame) {
    const double fps = scene.output.fps > 0 ? scene.output.fps : 24.0;
    return fmt::format("{:.2f} s", (frame - frame_range(scene).first) / fps);
}

void frame_entry(GuiFrame& frame) {
    const FrameRange range = frame_range(frame.document.scene());
    auto value = static_cast<float>(frame.view.frame);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), (px(24) - ImGui::GetFontSize()) * 0.5f));
    const bool changed = drag_field("##frame", value, 0.25f, static_cast<float>(range.first),
                                    static_cast<float>(range.last), "%.0f", px(56), color::text);
    ImGui::PopStyleVar();
    note_item(frame, "frame");
    tooltip("Frame. Drag, or double click to type");
    if (changed) frame.view.frame = std::round(static_cast<double>(value));
}

void refresh(TimelineState& t, const Document& document) {
    const FrameRange range = frame_range(document.scene());
    if (!t.zoomed || range.first != t.fitted.first || range.last != t.fitted.last) {
        t.fitted = range;
        t.zoomed = false;
        t.scale.first = range.first;
        t.scale.last = std::max(range.last, range.first + 1.0);
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

void draw_header(GuiFrame& frame, const Rect& area) {
    ViewState& view = frame.view;
    const Scene& scene = frame.document.scene();
    const float control = px(24), y = area.y + px(6);
    ImGui::SetCursorScreenPos({area.x + px(8), y});
    const char* says = view.playing ? "Pause (Space)" : "Play (Space)";
    if (icon_button("play", view.playing ? Icon::pause : Icon::play, {control, control}, px(11), color::text,
                    says))
        view.playing = !view.playing;
    note_item(frame, "play");
    ImGui::SameLine(0, px(8));
    frame_entry(frame);
    for (const std::string& text :
         {fitting(scene.output.frames, px(140)), fmt::format("{:g} fps", scene.output.fps),
          seconds_text(scene, view.frame)}) {
        ImGui::SameLine(0, px(16));
        row_text(text, control, color::dim);
    }
    const float right = area.x + area.width - px(8);
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

void zoom_with_wheel(TimelineState& t, const Rect& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool inside =
        ImGui::IsMouseHoveringRect({area.x, area.y}, {area.x + area.width, area.y + area.height});
    if (!inside || io.MouseWheel == 0.0f) return;
    const double middle = t.scale.frame_at(io.MousePos.x);
    const double factor = io.MouseWheel > 0 ? 1.0 / zoom_step : zoom_step;
    const double least = 4.0, most = 4.0 * std::max(t.fitted.last - t.fitted.first, least);
    const double span = std::clamp((t.scale.last - t.scale.first) * factor, least, most);
    const double ratio = span / (t.scale.last - t.scale.first);
    t.scale.first = middle - (middle - t.scale.first) * ratio;
    t.scale.last = t.scale.first + span;
    t.zoomed = true;
}

void draw_ruler(TimelineState& t, GuiFrame& frame, const Rect& area) {
    ImGui::SetCursorScreenPos({t.scale.x0 - px(timeline_margin), area.y});
    ImGui::InvisibleButton("ruler", {t.scale.x1 - t.scale.x0 + 2 * px(timeline_margin), area.height});
    note_item(frame, "ruler");
    if (ImGui::IsItemActivated()) {
        t.drag = TimelineState::Drag::scrub;
        frame.view.playing = false;
    }
    if (ImGui::IsItemActive() && t.drag == TimelineState::Drag::scrub)
        frame.view.frame = std::clamp(std::round(t.scale.frame_at(ImGui::GetIO().MousePos.x)), t.fitted.first,
                                      t.fitted.last);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) t.zoomed = false;
    zoom_with_wheel(t, {t.scale.x0, area.y, t.scale.x1 - t.scale.x0, area.height});

    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height}, color::window);
    ImGui::PushFont(small_font());
    const double step = ruler_step(t.scale, px(56)), small = ruler_step(t.scale, px(8));
    for (double f = std::ceil(t.scale.first / small) * small; f <= t.scale.last; f += small) {
        const float x = std::floor(t.scale.x_of(f)) + 0.5f;
        list->AddLine({x, area.y + area.height - px(4)}, {x, area.y + area.height}, color::hover);
    }
    for (double f = std::ceil(t.scale.first / step) * step; f <= t.scale.last; f += step) {
        const float x = std::floor(t.scale.x_of(f)) + 0.5f;
        const std::string text = fmt::format("{:.0f}", f);
        list->AddLine({x, area.y + area.height - px(7)}, {x, area.y + area.height}, color::dim);
        list->AddText({x - std::floor(ImGui::CalcTextSize(text.c_str()).x * 0.5f), area.y + px(1)},
                      color::dim, text.c_str());
    }
    ImGui::PopFont();
}

void draw_playhead(const TimelineState& t, const GuiFrame& frame, const Rect& ruler) {
    const float x = std::floor(t.scale.x_of(frame.view.frame)) + 0.5f;
    if (x < t.scale.x0 - px(timeline_margin) || x > t.scale.x1 + px(timeline_margin)) return;
    ImDrawList* list = ImGui::GetWindowDrawList();
    ImGui::PushFont(small_font());
    const std::string text = fmt::format("{:g}", std::round(frame.view.frame * 100.0) / 100.0);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float half = std::floor(size.x * 0.5f + px(6));
    list->AddRectFilled({x - half, ruler.y + px(1)}, {x + half, ruler.y + ruler.height - px(2)},
                        color::accent, px(3));
    list->AddText({std::floor(x - size.x * 0.5f), ruler.y + px(2)}, IM_COL32(0x10, 0x14, 0x1A, 255),
                  text.c_str());
    ImGui::PopFont();
}

void end_drag(TimelineState& t) {
    if (t.drag == TimelineState::Drag::none || ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    t.drag = TimelineState::Drag::none;
    t.before.clear();
}

}  // namespace

double ruler_step(const TimeScale& scale, float least_px) {
    const double px_per_frame = static_cast<double>(scale.x1 - scale.x0) / (scale.last - scale.first);
    double step = 1.0;
    for (int i = 0; step * px_per_frame < static_cast<double>(least_px) && i < 30; ++i)
        step *= i % 3 == 1 ? 2.5 : 2.0;  // 1 2 5 10 20 50 ...
    return step;
}

std::string track_label(const std::string& key, const ParameterSpec& spec) {
    std::string group = ParameterKey(key).layer();
    if (group.empty() && !key.empty()) {
        group = ParameterKey(key).parts().front();
        group[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(group[0])));
    }
    return group + ": " + (spec.label.empty() ? key : spec.label);
}

void Timeline::draw(GuiFrame& frame, const Rect& area) {
    constexpr ImGuiWindowFlags still = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
    if (!begin_part("timeline", area, still)) return;
    refresh(state_, frame.document);
    end_drag(state_);
    draw_header(frame, area);
    const Rect ruler{area.x, area.y + px(header_height), area.width, px(ruler_height)};
    const float bottom = area.y + area.height;
    if (bottom > ruler.y + ruler.height) {
        state_.scale.x0 = area.x + names_width(frame.view) + px(timeline_margin);
        state_.scale.x1 = std::max(area.x + area.width - px(timeline_margin) * 1.5f, state_.scale.x0 + 1.0f);
        draw_ruler(state_, frame, ruler);
        const Rect rows{area.x, ruler.y + ruler.height, area.width, bottom - ruler.y - ruler.height};
        draw_rows(state_, frame, rows);
        draw_playhead(state_, frame, ruler);
    }
    ImGui::EndChild();
}

}  // namespace astrosplat
