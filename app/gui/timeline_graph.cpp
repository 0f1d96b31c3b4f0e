// The graph of one animated parameter: every component over the frames, as the render will follow it, and its
// keys to be dragged up and down.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "edit/keys.h"
#include "gui/theme.h"
#include "gui/timeline.h"
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

}  // namespace

float Timeline::y_of(double value, const Rect& area) const {
    const double share = (value - graph_.low) / (graph_.high - graph_.low);
    return area.y + area.height - px(margin_y) - static_cast<float>(share) * (area.height - 2 * px(margin_y));
}

void Timeline::sample_graph(const Track& track, const ParameterSpec& spec, std::uint64_t revision) {
    const bool same_scale = graph_.scale.first == scale_.first && graph_.scale.last == scale_.last &&
                            graph_.scale.x0 == scale_.x0 && graph_.scale.x1 == scale_.x1;
    if (graph_.key == track.key && graph_.revision == revision && same_scale) return;
    graph_.key = track.key;
    graph_.revision = revision;
    graph_.scale = scale_;
    graph_.samples.assign(track.keys.front().value.size(), {});
    const int count = std::max(2, static_cast<int>((scale_.x1 - scale_.x0) / px(sample_px)));
    double low = track.keys.front().value.front(), high = low;
    for (int i = 0; i <= count; ++i) {
        const double frame = scale_.first + (scale_.last - scale_.first) * i / count;
        const std::vector<double> numbers = track_at(track, spec, frame);
        for (std::size_t c = 0; c < graph_.samples.size(); ++c) {
            graph_.samples[c].push_back(numbers[c]);
            low = std::min(low, numbers[c]);
            high = std::max(high, numbers[c]);
        }
    }
    if (drag_ == Drag::value) return;  // the axis stands still under the mouse
    const double least = std::max(1e-6, 1e-3 * std::max(std::fabs(low), std::fabs(high)));
    const double pad = std::max(least - (high - low), 0.0) * 0.5;
    graph_.low = low - pad;
    graph_.high = high + pad;
}

void Timeline::drag_value(GuiFrame& frame, const Track& track, const Rect& area) {
    const float share =
        (area.y + area.height - px(margin_y) - ImGui::GetIO().MousePos.y) / (area.height - 2 * px(margin_y));
    const double value = graph_.low + static_cast<double>(share) * (graph_.high - graph_.low);
    const ParameterSpec& spec = specs_.at(track.key);
    try_edit([&] {
        frame.document.edit(
            "Key of " + spec.label,
            [&](Scene& scene) {
                for (const auto& key : track.keys) {
                    if (key.frame != graph_.grabbed_key) continue;
                    std::vector<double> numbers = key.value;
                    numbers[graph_.component] = value;
                    set_key(scene, track.key, key.frame, from_numbers(spec, numbers));
                }
            },
            gesture_);
    });
}

void Timeline::draw_graph_keys(GuiFrame& frame, const Track& track, const Rect& area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool hovered = ImGui::IsItemHovered();
    for (const auto& key : track.keys)
        for (std::size_t c = 0; c < key.value.size(); ++c) {
            const ImVec2 at{scale_.x_of(key.frame), y_of(key.value[c], area)};
            const bool held =
                drag_ == Drag::value && graph_.grabbed_key == key.frame && graph_.component == c;
            const bool near = hovered && std::hypot(at.x - mouse.x, at.y - mouse.y) <= px(point_reach);
            if (near && drag_ == Drag::none && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
                drag_ = Drag::value;
                gesture_ = new_gesture();
                graph_.grabbed_key = key.frame;
                graph_.component = c;
            }
            list->AddCircleFilled(at, px(held || near ? 5.5f : 4.5f), color::line, 16);
            list->AddCircleFilled(at, px(held || near ? 4.5f : 3.5f), color::key, 16);
            note_item(frame, fmt::format("graph {} {:g} {}", track.key, key.frame, c), {at.x, at.y});
            if (near && drag_ == Drag::none)
                tooltip(fmt::format("Frame {:g}: {:.4g}", key.frame, key.value[c]).c_str());
        }
}

void Timeline::draw_graph(GuiFrame& frame, const Rect& area) {
    const Scene& scene = frame.document.scene();
    if (!find_track(scene, frame.view.graph_key)) frame.view.graph_key = scene.animation.front().key;
    const Track track = *find_track(scene, frame.view.graph_key);
    const auto spec = specs_.find(track.key);
    if (spec == specs_.end()) return;
    sample_graph(track, spec->second, frame.document.revision());
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 low{area.x, area.y}, high{area.x + area.width, area.y + area.height};
    list->AddRectFilled(low, high, color::window);
    ImGui::PushFont(small_font());
    for (const double value : {graph_.low, 0.5 * (graph_.low + graph_.high), graph_.high}) {
        const float y = std::floor(y_of(value, area)) + 0.5f;
        const std::string text = axis_text(value, graph_.high - graph_.low);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        list->AddLine({area.x, y}, {high.x, y}, color::with_opacity(color::field, 0.8f));
        list->AddText({area.x - px(8) - size.x, std::floor(y - size.y * 0.5f)}, color::dim, text.c_str());
    }
    ImGui::PopFont();
    ImGui::SetCursorScreenPos(low);
    ImGui::InvisibleButton("graph", {std::max(area.width, 1.0f), std::max(area.height, 1.0f)});
    ImGui::PushClipRect(low, high, true);
    for (std::size_t c = 0; c < graph_.samples.size(); ++c) {
        const std::vector<double>& samples = graph_.samples[c];
        const auto last = static_cast<float>(samples.size() - 1);
        for (std::size_t i = 0; i < samples.size(); ++i)
            list->PathLineTo(
                {scale_.x0 + (scale_.x1 - scale_.x0) * static_cast<float>(i) / last, y_of(samples[i], area)});
        list->PathStroke(component_color(c, graph_.samples.size()), ImDrawFlags_None, px(1.5f));
    }
    draw_graph_keys(frame, track, area);
    ImGui::PopClipRect();
    if (drag_ == Drag::value) drag_value(frame, track, area);
}

}  // namespace astrosplat
