#include "gui/timeline_graph.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "edit/keyframes.h"
#include "gui/theme.h"
#include "gui/widgets.h"
#include "scene/animate.h"

namespace astrosplat {
namespace {

constexpr float point_reach = 7, sample_px = 3, margin_y = 10;

// x, y, z, w or r, g, b: told apart, not shouting.
ImU32 component_color(std::size_t component, std::size_t count) {
    constexpr ImU32 colors[4] = {IM_COL32(0xC9, 0x84, 0x7C, 255), IM_COL32(0x84, 0xB3, 0x8A, 255),
                                 IM_COL32(0x84, 0x9C, 0xC9, 255), IM_COL32(0xB0, 0xA0, 0xBE, 255)};
    return count == 1 ? color::text : colors[component % 4];
}

std::string axis_text(double value, double span) {
    return fmt::format("{:.{}f}", value, span >= 100 ? 0 : span >= 10 ? 1 : span >= 1 ? 2 : 3);
}

float y_of(const TimelineState& t, double value, const Rect& area) {
    const double share = (value - t.graph.low) / (t.graph.high - t.graph.low);
    return area.y + area.height - px(margin_y) - static_cast<float>(share) * (area.height - 2 * px(margin_y));
}

void sample_graph(TimelineState& t, const Track& track, const ParameterSpec& spec, std::uint64_t revision) {
    const bool same_scale = t.graph.scale.first == t.scale.first && t.graph.scale.last == t.scale.last &&
                            t.graph.scale.x0 == t.scale.x0 && t.graph.scale.x1 == t.scale.x1;
    if (t.graph.key == track.key && t.graph.revision == revision && same_scale) return;
    t.graph.key = track.key;
    t.graph.revision = revision;
    t.graph.scale = t.scale;
    t.graph.samples.assign(track.keyframes.front().value.size(), {});
    const int count = std::max(2, static_cast<int>((t.scale.x1 - t.scale.x0) / px(sample_px)));
    double low = track.keyframes.front().value.front(), high = low;
    for (int i = 0; i <= count; ++i) {
        const double frame = t.scale.first + (t.scale.last - t.scale.first) * i / count;
        const std::vector<double> numbers = track_at(track, spec, frame);
        for (std::size_t c = 0; c < t.graph.samples.size(); ++c) {
            t.graph.samples[c].push_back(numbers[c]);
            low = std::min(low, numbers[c]);
            high = std::max(high, numbers[c]);
        }
    }
    if (t.drag == TimelineState::Drag::value) return;  // the axis stands still under the mouse
    const double least = std::max(1e-6, 1e-3 * std::max(std::fabs(low), std::fabs(high)));
    const double pad = std::max(least - (high - low), 0.0) * 0.5;
    t.graph.low = low - pad;
    t.graph.high = high + pad;
}

void drag_value(TimelineState& t, GuiFrame& frame, const Track& track, const Rect& area) {
    const float share =
        (area.y + area.height - px(margin_y) - ImGui::GetIO().MousePos.y) / (area.height - 2 * px(margin_y));
    const double value = t.graph.low + static_cast<double>(share) * (t.graph.high - t.graph.low);
    const ParameterSpec& spec = t.specs.at(track.key);
    try_edit([&] {
        frame.document.edit(
            "Keyframe of " + spec.label,
            [&](Scene& scene) {
                for (const auto& keyframe : track.keyframes) {
                    if (keyframe.frame != t.graph.grabbed_keyframe) continue;
                    std::vector<double> numbers = keyframe.value;
                    numbers[t.graph.component] = value;
                    set_keyframe(scene, track.key, keyframe.frame, from_numbers(spec, numbers));
                }
            },
            t.gesture);
    });
}

void draw_graph_keyframes(TimelineState& t, GuiFrame& frame, const Track& track, const Rect& area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool hovered = ImGui::IsItemHovered();
    for (const auto& keyframe : track.keyframes)
        for (std::size_t c = 0; c < keyframe.value.size(); ++c) {
            const ImVec2 at{t.scale.x_of(keyframe.frame), y_of(t, keyframe.value[c], area)};
            const bool held = t.drag == TimelineState::Drag::value &&
                              t.graph.grabbed_keyframe == keyframe.frame && t.graph.component == c;
            const bool near = hovered && std::hypot(at.x - mouse.x, at.y - mouse.y) <= px(point_reach);
            if (near && t.drag == TimelineState::Drag::none && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
                t.drag = TimelineState::Drag::value;
                t.gesture = new_gesture();
                t.graph.grabbed_keyframe = keyframe.frame;
                t.graph.component = c;
            }
            list->AddCircleFilled(at, px(held || near ? 5.5f : 4.5f), color::line, 16);
            list->AddCircleFilled(at, px(held || near ? 4.5f : 3.5f), color::attention, 16);
            note_item(frame, fmt::format("graph {} {:g} {}", track.key, keyframe.frame, c), {at.x, at.y});
            if (near && t.drag == TimelineState::Drag::none)
                tooltip(fmt::format("Frame {:g}: {:.4g}", keyframe.frame, keyframe.value[c]).c_str());
        }
}

}  // namespace

void draw_graph(TimelineState& t, GuiFrame& frame, const Rect& area) {
    const Scene& scene = frame.document.scene();
    if (!find_track(scene, frame.view.graph_parameter))
        frame.view.graph_parameter = scene.animation.front().key;
    const Track track = *find_track(scene, frame.view.graph_parameter);
    const auto spec = t.specs.find(track.key);
    if (spec == t.specs.end()) return;
    sample_graph(t, track, spec->second, frame.document.revision());
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 low{area.x, area.y}, high{area.x + area.width, area.y + area.height};
    list->AddRectFilled(low, high, color::window);
    ImGui::PushFont(small_font());
    for (const double value : {t.graph.low, 0.5 * (t.graph.low + t.graph.high), t.graph.high}) {
        const float y = std::floor(y_of(t, value, area)) + 0.5f;
        const std::string text = axis_text(value, t.graph.high - t.graph.low);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        list->AddLine({area.x, y}, {high.x, y}, color::with_opacity(color::field, 0.8f));
        list->AddText({area.x - px(8) - size.x, std::floor(y - size.y * 0.5f)}, color::dim, text.c_str());
    }
    ImGui::PopFont();
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton("graph", {std::max(area.width, 1.0f), std::max(area.height, 1.0f)});
    ImGui::PushClipRect(low, high, true);
    for (std::size_t c = 0; c < t.graph.samples.size(); ++c) {
        const std::vector<double>& samples = t.graph.samples[c];
        const auto last = static_cast<float>(samples.size() - 1);
        for (std::size_t i = 0; i < samples.size(); ++i)
            list->PathLineTo({t.scale.x0 + (t.scale.x1 - t.scale.x0) * static_cast<float>(i) / last,
                              y_of(t, samples[i], area)});
        list->PathStroke(component_color(c, t.graph.samples.size()), ImDrawFlags_None, px(1.5f));
    }
    draw_graph_keyframes(t, frame, track, area);
    ImGui::PopClipRect();
    if (t.drag == TimelineState::Drag::value) drag_value(t, frame, track, area);
}

}  // namespace astrosplat
